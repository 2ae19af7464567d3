// Both sequencers and the tick gate between them, as one top for their lockstep: queue words and
// feed ticks in, the start and end of paths and pieces out.
`default_nettype none

module sequencers #(
    parameter int Axes = 4
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [arrival_pkg::WIDTH-1:0] arrival_i,
    // queues
    input wire logic geometry_empty_i,
    input wire logic [15:0] geometry_word_i,
    output logic geometry_read_o,
    input wire logic feed_empty_i,
    input wire logic [15:0] feed_word_i,
    output logic feed_read_o,
    // direct move
    input wire logic [load_bus_pkg::WIDTH-1:0] direct_load_i,
    input wire logic direct_go_i,
    input wire logic [Axes-1:0] direct_mask_i,
    // ticks
    input wire logic enable_i,
    input wire logic feed_tick_i,
    input wire logic wait_i,
    input wire logic shut_i,
    input wire logic closing_i,
    output logic spent_o,
    output logic feed_enable_o,
    output logic feed_clear_o,
    output logic tick_o,
    // path engines and axes
    input wire logic [engines_pkg::WIDTH-1:0] engines_i,
    output logic [load_bus_pkg::WIDTH-1:0] load_o,
    output logic [move_pkg::WIDTH-1:0] move_o,
    output logic [path_pkg::WIDTH-1:0] path_o,
    // commands that are neither paths nor barriers, and the probe
    output logic [commands_pkg::WIDTH-1:0] commands_o,
    input wire logic [probe_pkg::WIDTH-1:0] probe_i,
    input wire logic drop_i,
    input wire logic halt_i,
    // pieces that begin
    output logic feed_swap_o,
    output logic [feed_load_pkg::WIDTH-1:0] feed_load_o,
    // status
    output logic [geometry_state_pkg::WIDTH-1:0] geometry_state_o,
    output logic feed_active_o,
    output logic moving_o,
    output logic [1:0] class_o,
    output logic [1:0] slew_shift_o,
    output logic silent_o,
    output logic idle_o,
    output logic [31:0] feed_begun_o,
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o
);
  logic [feed_pkg::WIDTH-1:0] feed;
  logic [snapshot_pkg::WIDTH-1:0] behind_feed;
  logic take;
  logic feed_decoder_idle;
  logic geometry_idle;

  assign feed[feed_pkg::AT_REST]  = 1'b0;
  assign feed[feed_pkg::STOPPING] = 1'b0;
  assign feed[feed_pkg::SILENT]   = silent_o;
  assign feed[feed_pkg::CLOSING]  = closing_i;

  geometry_sequencer #(
      .Axes(Axes)
  ) geometry (
      .clk_i,
      .rst_i,
      .cut_i,
      .empty_i(geometry_empty_i),
      .word_i(geometry_word_i),
      .read_o(geometry_read_o),
      .direct_load_i,
      .direct_go_i,
      .direct_mask_i,
      .feed_i(feed),
      .take_i(take),
      .engines_i,
      .load_o,
      .move_o,
      .path_o,
      .setting_i,
      .arrival_i,
      .rest_i(idle_o),
      .commands_o,
      .probe_i,
      .drop_i,
      .halt_i,
      .idle_o(geometry_idle),
      .geometry_state_o,
      .snapshot_i(behind_feed),
      .snapshot_o
  );

  feed_sequencer pieces (
      .clk_i,
      .rst_i,
      .cut_i,
      .empty_i(feed_empty_i),
      .word_i(feed_word_i),
      .read_o(feed_read_o),
      .take_i(take),
      .wait_i,
      .finished_i(engines_i[engines_pkg::DONE]),
      .path_i(path_o),
      .at_barrier_o(feed[feed_pkg::AT_BARRIER]),
      .runs_o(feed[feed_pkg::RUNS]),
      .active_o(feed_active_o),
      .decoded_o(),
      .spent_o,
      .moving_o,
      .class_o,
      .slew_shift_o,
      .silent_o,
      .idle_o(feed_decoder_idle),
      .swap_o(feed_swap_o),
      .load_o(feed_load_o),
      .snapshot_i,
      .snapshot_o(behind_feed),
      .begun_o(feed_begun_o)
  );

  tick_gate gate (
      .clk_i,
      .rst_i,
      .cut_i,
      .enable_i,
      .feed_tick_i,
      .feed_active_i(feed_active_o),
      .silent_i(silent_o),
      .direct_i(path_o[path_pkg::DIRECT]),
      .taking_i(path_o[path_pkg::TAKING]),
      .ready_i(engines_i[engines_pkg::READY]),
      .shut_i,
      .wait_i(1'b0),
      .take_o(take),
      .tick_o,
      .feed_enable_o,
      .feed_clear_o
  );

  always_ff @(posedge clk_i) idle_o <= (geometry_idle && feed_decoder_idle && feed_empty_i && !feed_active_o) || rst_i;
endmodule

`default_nettype wire
