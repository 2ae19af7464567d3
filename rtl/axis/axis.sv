// One axis: merges the steps of its pulse generator with those of the path engines, shapes them and counts them. It
// also has the axis's settings and its word of the snapshot.
`default_nettype none

module axis #(
    parameter int Axis    = 0,
    parameter bit Counted = 1   // direct mode: lines may end at a count of steps
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic [1:0] idle_level_i,  // level before and in reset: {second pin, first pin}
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [load_bus_pkg::WIDTH-1:0] load_i,
    // path domain
    input wire logic tick_i,
    input wire logic swap_i,
    input wire logic active_i,  // sampled with swap_i: the generator makes steps
    input wire logic direct_i,  // sampled with swap_i: the line is counted, and mirrored if it runs backwards
    // The next chord of an arc: its increment in three halfwords, and the swap that keeps the phase. Never in the same
    // clock as a halfword of the load bus for this axis.
    input wire logic [15:0] chord_word_i,
    input wire logic chord_load_i,
    input wire logic chord_swap_i,
    input wire logic silent_i,  // steps are dropped
    input wire logic engine_step_i,  // never together with a step of the generator, since a path runs on one engine
    input wire logic engine_dir_i,
    input wire logic wait_tick_i,
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o,
    output logic live_o,
    output logic busy_o,
    output logic fault_o,  // event
    output logic [axis_observe_pkg::WIDTH-1:0] observe_o,
    output logic step_o,
    output logic dir_o
);
  localparam logic [8:0] INCREMENT = load_target_pkg::of_axis(3'(Axis), load_target_pkg::INCREMENT);
  localparam logic [8:0] COUNT = load_target_pkg::of_axis(3'(Axis), load_target_pkg::COUNT);

  logic        generator_step;
  logic        generator_dir;
  logic        any_step;
  logic        path_step_q;
  logic        path_dir_q;
  logic [31:0] position;
  logic [15:0] step_length;
  logic [15:0] step_space;
  logic [15:0] dir_setup;
  logic [15:0] dir_hold;
  logic [ 3:0] mode;

  axis_settings #(
      .Axis(Axis)
  ) settings (
      .clk_i,
      .rst_i,
      .setting_i,
      .idle_level_i,
      .step_length_o(step_length),
      .step_space_o(step_space),
      .dir_setup_o(dir_setup),
      .dir_hold_o(dir_hold),
      .mode_o(mode)
  );

  // Loads are registered, so that no comparison precedes the count's adder. There is time: path swaps arrive three
  // clocks late.
  logic        load_increment_q;
  logic        load_count_q;
  logic [15:0] word_q;
  always_ff @(posedge clk_i) begin
    load_increment_q <= load_bus_pkg::to(load_i, INCREMENT) || chord_load_i;
    load_count_q <= load_bus_pkg::to(load_i, COUNT);
    word_q <= chord_load_i ? chord_word_i : load_bus_pkg::word(load_i);
  end

  pulse_generator #(
      .Counted(Counted)
  ) generator (
      .clk_i,
      .rst_i,
      .clear_i(cut_i),
      .tick_i,
      .swap_i,
      .chord_i(chord_swap_i),
      .active_i,
      .counted_i(direct_i),
      .mirror_i(direct_i),
      .load_increment_i(load_increment_q),
      .load_count_i(load_count_q),
      .word_i(word_q),
      .step_o(generator_step),
      .dir_o(generator_dir),
      .live_o
  );

  // A cut does not drop the step in this register: a step on its way to the shaper is still made.
  assign any_step = (generator_step || engine_step_i) && !silent_i;
  always_ff @(posedge clk_i) begin
    path_step_q <= any_step;
    if (any_step) path_dir_q <= engine_step_i ? engine_dir_i : generator_dir;
    if (rst_i) begin
      path_step_q <= 1'b0;
      path_dir_q  <= 1'b0;
    end
  end

  step_shaper shaper (
      .clk_i,
      .rst_i,
      .step_i(path_step_q),
      .dir_i(path_dir_q),
      .step_length_i(step_length),
      .step_space_i(step_space),
      .dir_setup_i(dir_setup),
      .dir_hold_i(dir_hold),
      .mode_i(mode),
      .idle_level_i,
      .wait_tick_i,
      .step_o,
      .dir_o,
      .position_o(position),
      .begun_o(observe_o[axis_observe_pkg::COUNTS]),
      .back_o(observe_o[axis_observe_pkg::COUNTS_BACK]),
      .busy_o,
      .fault_o
  );

  snapshot_slice position_word (
      .clk_i,
      .snapshot_i,
      .value_i(position),
      .snapshot_o
  );
  assign observe_o[axis_observe_pkg::STEP] = path_step_q;
  assign observe_o[axis_observe_pkg::DIR] = path_dir_q;
  assign observe_o[axis_observe_pkg::POSITION+:32] = position;
endmodule

`default_nettype wire
