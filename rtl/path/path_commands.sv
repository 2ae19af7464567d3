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
    // registers
    output logic [63:0] io_o  // {marks, outputs, inputs}
);
  if (Engines[card_map_pkg::ENGINE_PATH_COMMANDS]) begin : gen_built
    logic [       15:0] levels;
    logic [       31:0] marks;
    logic               change;
    logic [Outputs-1:0] set;
    logic [Outputs-1:0] clear;

    input_pins #(
        .Inputs(Inputs)
    ) inputs (
        .*,
        .pin_i  (input_i),
        .level_o(levels)
    );

    instant_commands #(
        .Outputs(Outputs)
    ) instants (
        .*,
        .marks_o (marks),
        .change_o(change),
        .set_o   (set),
        .clear_o (clear)
    );

    output_pins #(
        .Outputs(Outputs)
    ) outputs (
        .*,
        .idle_i  (output_idle_i),
        .change_i(change),
        .set_i   (set),
        .clear_i (clear),
        .pin_o   (output_o)
    );

    assign io_o = {marks, 16'(output_o), levels};
  end else begin : gen_without
    assign output_o = output_idle_i;
    assign {mark_o, io_o} = '0;

    logic unused;
    assign unused = &{1'b0, clk_i, rst_i, cut_i, setting_i, input_i, load_i, taken_i, over_i, runs_i};
  end
endmodule

`default_nettype wire
