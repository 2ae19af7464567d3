// The arc generator with the axes that make its steps: path ticks reach them a clock after the generator.
`default_nettype none

module arc_axes #(
    parameter int Axes = 3
) (
    input  wire logic            clk_i,
    input  wire logic            rst_i,
    input  wire logic            clear_i,
    input  wire logic [    21:0] load_i,
    input  wire logic            start_i,
    input  wire logic            tick_i,
    input  wire logic            swap_i,        // of the axes
    input  wire logic            line_tick_i,   // theirs alone
    input  wire logic [Axes-1:0] active_i,
    output logic      [    15:0] chord_word_o,
    output logic      [Axes-1:0] chord_load_o,
    output logic      [Axes-1:0] chord_swap_o,
    output logic                 ready_o,
    output logic                 loadable_o,
    output logic      [Axes-1:0] path_step_o,
    output logic      [Axes-1:0] path_dir_o
);
  logic tick_q;
  always_ff @(posedge clk_i) tick_q <= tick_i && !clear_i && !rst_i;

  arc_generator #(
      .Axes(Axes)
  ) generator (
      .clk_i,
      .rst_i,
      .clear_i,
      .load_i,
      .start_i,
      .tick_i,
      .chord_word_o,
      .chord_load_o,
      .chord_swap_o,
      .ready_o,
      .loadable_o
  );

  logic [34*Axes-1:0] observe;
  assign {path_dir_o, path_step_o} = observe[2*Axes-1:0];

  axes #(
      .Axes   (Axes),
      .Counted(0)
  ) motors (
      .clk_i,
      .rst_i,
      .cut_i(clear_i),
      .idle_level_i('0),
      .setting_i('0),
      .load_i,
      .tick_i(tick_q || line_tick_i),
      .swap_i,
      .active_i,
      .direct_i(1'b0),
      .chord_word_i(chord_word_o),
      .chord_load_i(chord_load_o),
      .chord_swap_i(chord_swap_o),
      .engine_step_i('0),
      .engine_dir_i('0),
      .snapshot_i('0),
      .chain_i('0),
      .chain_o(),
      .live_o(),
      .busy_o(),
      .fault_o(),
      .observe_o(observe),
      .step_o(),
      .dir_o()
  );

  logic unused;
  assign unused = &{1'b0, observe[34*Axes-1:2*Axes]};
endmodule

`default_nettype wire
