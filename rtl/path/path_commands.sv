// The card's inputs and outputs, and what commands do with them at their place on the path. Without the engine the inputs
// are not looked at, and the outputs stand as the strap says.
`default_nettype none

module path_commands #(
    parameter logic [31:0] Engines = '1,  // what is built in, as the register ENGINES shows it
    parameter int          Inputs  = 4,   // 1 to 16
    parameter int          Outputs = 4    // 1 to 16
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    // pins
    input wire logic [Inputs-1:0] input_i,
    input wire logic [Outputs-1:0] output_idle_i,  // strap
    output logic [Outputs-1:0] output_o,
    // commands
    input wire logic [load_bus_pkg::WIDTH-1:0] load_i,
    input wire logic take_output_i,  // OUTPUT is taken now; its last halfword is on load_i
    input wire logic take_mark_i,  // MARK is taken now
    input wire logic over_i,  // event: a path's last tick was taken, or it has ended on its engine
    input wire logic runs_i,  // a path is under way
    output logic mark_o,  // event: a snapshot is wanted
    // probe
    input wire logic at_rest_i,  // the ratio is 0
    input wire logic stopping_i,  // a fault's ramp
    input wire logic probe_clear_i,  // event
    input wire logic probe_waits_i,  // a PROBE is decoded and no path runs
    input wire logic probe_ends_i,  // PROBE_END has begun
    output logic met_o,  // the condition decoded last is met (combinational)
    output logic probe_taken_o,  // the PROBE is taken now (combinational)
    output logic probe_stays_o,  // PROBE_END must wait (combinational)
    output logic probe_o,  // event: a snapshot is wanted (combinational)
    output logic probe_hold_o,
    output logic drop_o,  // commands up to PROBE_END are not carried out
    output logic halt_o,  // event: what runs ends here
    output logic probing_o,
    // registers
    output logic [15:0] inputs_o,
    output logic [15:0] outputs_o,
    output logic [31:0] marks_o,
    output logic probed_o,
    output logic probe_missed_o
);
  if (Engines[card_map_pkg::ENGINE_PATH_COMMANDS]) begin : gen_built
    logic               change;
    logic [Outputs-1:0] set;
    logic [Outputs-1:0] clear;

    input_pins #(
        .Inputs(Inputs)
    ) inputs (
        .clk_i,
        .rst_i,
        .setting_i,
        .pin_i  (input_i),
        .level_o(inputs_o)
    );

    instant_commands #(
        .Outputs(Outputs)
    ) instants (
        .clk_i,
        .rst_i,
        .cut_i(cut_i || halt_o),
        .load_i,
        .take_output_i,
        .take_mark_i,
        .over_i,
        .runs_i,
        .mark_o,
        .marks_o,
        .change_o(change),
        .set_o(set),
        .clear_o(clear)
    );

    output_pins #(
        .Outputs(Outputs)
    ) outputs (
        .clk_i,
        .rst_i,
        .cut_i,
        .setting_i,
        .idle_i(output_idle_i),
        .change_i(change),
        .set_i(set),
        .clear_i(clear),
        .pin_o(output_o)
    );

    probe edges (
        .clk_i,
        .rst_i,
        .cut_i,
        .level_i (inputs_o),
        .load_i,
        .waits_i (probe_waits_i),
        .ends_i  (probe_ends_i),
        .at_rest_i,
        .stopping_i,
        .clear_i (probe_clear_i),
        .met_o,
        .taken_o (probe_taken_o),
        .stays_o (probe_stays_o),
        .trip_o  (probe_o),
        .hold_o  (probe_hold_o),
        .halt_o,
        .drop_o,
        .busy_o  (probing_o),
        .probed_o,
        .missed_o(probe_missed_o)
    );

    assign outputs_o = 16'(output_o);
  end else begin : gen_without
    assign output_o = output_idle_i;
    assign {mark_o, met_o, probe_taken_o, probe_stays_o, probe_o, probe_hold_o, drop_o, halt_o, probing_o} = '0;
    assign {inputs_o, outputs_o, marks_o, probed_o, probe_missed_o} = '0;

    logic unused;
    assign unused = &{1'b0, clk_i, rst_i, cut_i, setting_i, input_i, load_i, take_output_i, take_mark_i, over_i, runs_i,
                       at_rest_i, stopping_i, probe_clear_i, probe_waits_i, probe_ends_i};
  end
endmodule

`default_nettype wire
