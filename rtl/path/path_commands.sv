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
    input wire logic [40:0] setting_i,  // {set, address[9:2], data}
    // pins
    input wire logic [Inputs-1:0] input_i,
    input wire logic [Outputs-1:0] output_idle_i,  // strap
    output logic [Outputs-1:0] output_o,
    // commands
    input wire logic [21:0] load_i,
    input wire logic [1:0] taken_i,  // {MARK, OUTPUT} is taken now; its last halfword is on load_i
    input wire logic over_i,  // event: a path's last tick was taken, or it has ended on its engine
    input wire logic runs_i,  // a path is under way
    output logic mark_o,  // event: a snapshot is wanted
    // probe
    input wire logic at_rest_i,  // the ratio is 0
    input wire logic stopping_i,  // a fault's ramp
    input wire logic probe_clear_i,  // event
    input wire logic [2:0] probe_at_i,  // {WAIT_INPUT has begun, so has PROBE_END, a PROBE is decoded and no path runs}
    // combinational: {PROBE_END must wait, the PROBE is taken, the condition decoded last is met}
    output logic [2:0] probe_says_o,
    output logic probe_o,  // event: a snapshot is wanted (combinational)
    output logic probe_hold_o,
    output logic [1:0] drop_o,  // {commands up to PROBE_END are not carried out, event: what runs ends here}
    output logic probing_o,
    // registers
    output logic [66:0] io_o  // {waiting, probe missed, probed, marks, outputs, inputs}
);
  if (Engines[card_map_pkg::ENGINE_PATH_COMMANDS]) begin : gen_built
    logic [       15:0] levels;
    logic [       31:0] marks;
    logic               change;
    logic [Outputs-1:0] set;
    logic [Outputs-1:0] clear;
    logic [        1:0] probe_status;

    input_pins #(
        .Inputs(Inputs)
    ) inputs (
        .clk_i,
        .rst_i,
        .setting_i,
        .pin_i  (input_i),
        .level_o(levels)
    );

    instant_commands #(
        .Outputs(Outputs)
    ) instants (
        .clk_i,
        .rst_i,
        .cut_i(cut_i || drop_o[0]),
        .load_i,
        .taken_i,
        .over_i,
        .runs_i,
        .mark_o,
        .marks_o(marks),
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
        .level_i(levels),
        .load_i,
        .waits_i(probe_at_i[0]),
        .ends_i(probe_at_i[1]),
        .at_rest_i,
        .stopping_i,
        .clear_i(probe_clear_i),
        .met_o(probe_says_o[0]),
        .taken_o(probe_says_o[1]),
        .stays_o(probe_says_o[2]),
        .trip_o(probe_o),
        .hold_o(probe_hold_o),
        .halt_o(drop_o[0]),
        .drop_o(drop_o[1]),
        .busy_o(probing_o),
        .status_o(probe_status)
    );

    assign io_o = {probe_at_i[2], probe_status, marks, 16'(output_o), levels};
  end else begin : gen_without
    assign output_o = output_idle_i;
    assign {mark_o, io_o, probe_says_o, probe_o, probe_hold_o, drop_o, probing_o} = '0;

    logic unused;
    assign unused = &{1'b0, clk_i, rst_i, cut_i, setting_i, input_i, load_i, taken_i, over_i, runs_i, at_rest_i,
                       stopping_i, probe_clear_i, probe_at_i};
  end
endmodule

`default_nettype wire
