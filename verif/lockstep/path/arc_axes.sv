// The arc generator with the axes that make its steps. Path ticks reach the axes one clock after
// the generator.
`default_nettype none

module arc_axes #(
    parameter int Axes = 3
) (
    input  wire logic                           clk_i,
    input  wire logic                           rst_i,
    input  wire logic                           clear_i,
    input  wire logic [load_bus_pkg::WIDTH-1:0] load_i,
    input  wire logic                           start_i,
    input  wire logic                           tick_i,
    input  wire logic                           swap_i,        // swap of the axes
    input  wire logic                           line_tick_i,   // tick for the axes only
    input  wire logic [               Axes-1:0] active_i,
    output logic      [                   15:0] chord_word_o,
    output logic      [               Axes-1:0] chord_load_o,
    output logic      [               Axes-1:0] chord_swap_o,
    output logic                                ready_o,
    output logic                                loadable_o,
    output logic      [               Axes-1:0] path_step_o,
    output logic      [               Axes-1:0] path_dir_o
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

  logic [move_pkg::WIDTH-1:0] move;
  logic [axis_drive_pkg::WIDTH-1:0] drive;
  logic [axis_observe_pkg::WIDTH*Axes-1:0] observe;

  always_comb begin
    move = '0;
    move[move_pkg::AXES+:Axes] = active_i;
    drive = '0;
    drive[axis_drive_pkg::TICK] = tick_q || line_tick_i;
    drive[axis_drive_pkg::SWAP] = swap_i;
    drive[axis_drive_pkg::CHORD_WORD+:16] = chord_word_o;
    drive[axis_drive_pkg::CHORD_LOAD+:Axes] = chord_load_o;
    drive[axis_drive_pkg::CHORD_SWAP+:Axes] = chord_swap_o;
  end

  for (genvar n = 0; n < Axes; n++) begin : gen_axis
    assign path_step_o[n] = observe[axis_observe_pkg::WIDTH*n+axis_observe_pkg::STEP];
    assign path_dir_o[n]  = observe[axis_observe_pkg::WIDTH*n+axis_observe_pkg::DIR];
  end

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
      .move_i(move),
      .drive_i(drive),
      .silent_i(1'b0),
      .snapshot_i('0),
      .snapshot_o(),
      .live_o(),
      .busy_o(),
      .fault_o(),
      .observe_o(observe),
      .step_o(),
      .dir_o()
  );

  logic unused;
  assign unused = &{1'b0, observe};
endmodule

`default_nettype wire
