// Both sequencers and the tick gate between them, as one top for their lockstep: queue words and feed ticks in, what
// begins and ends out.
`default_nettype none

module sequencers #(
    parameter int Axes = 4
) (
    input  wire logic            clk_i,
    input  wire logic            rst_i,
    input  wire logic            cut_i,
    input  wire logic [    40:0] setting_i,
    input  wire logic [    21:0] arrive_i,
    // queues
    input  wire logic            geometry_empty_i,
    input  wire logic [    15:0] geometry_word_i,
    output logic                 geometry_read_o,
    input  wire logic            feed_empty_i,
    input  wire logic [    15:0] feed_word_i,
    output logic                 feed_read_o,
    // direct move
    input  wire logic [    21:0] direct_load_i,
    input  wire logic            direct_go_i,
    input  wire logic [Axes-1:0] direct_mask_i,
    output logic                 direct_o,
    // ticks
    input  wire logic            enable_i,
    input  wire logic            feed_tick_i,
    input  wire logic            wait_i,
    output logic                 streaming_o,
    output logic                 missing_o,
    output logic      [    32:0] stale_o,
    output logic                 spent_o,
    output logic                 feed_enable_o,
    output logic                 feed_clear_o,
    output logic                 tick_o,
    // path engines and axes
    input  wire logic            engine_ready_i,
    input  wire logic            payload_ready_i,
    input  wire logic            shadows_free_i,
    input  wire logic            engine_done_i,
    input  wire logic            elsewhere_i,
    input  wire logic            axes_live_i,
    // commands that are neither paths nor barriers
    output logic      [     1:0] instant_o,
    output logic                 over_o,
    // probe
    input  wire logic [     2:0] probe_says_i,
    input  wire logic [     1:0] drop_i,
    output logic      [     2:0] probe_at_o,
    // what begins
    output logic                 swap_o,
    output logic      [Axes-1:0] active_o,
    output logic      [     4:0] engine_o,
    output logic                 engine_taken_o,
    output logic                 feed_swap_o,
    output logic      [    21:0] load_o,
    output logic      [    19:0] feed_load_o,
    output logic                 mismatch_o,
    output logic                 incomplete_o,
    // status
    output logic                 path_active_o,
    output logic                 feed_active_o,
    output logic                 moving_o,
    output logic      [     1:0] class_o,
    output logic                 ended_o,
    output logic                 idle_o,
    output logic      [    31:0] geometry_begun_o,
    output logic      [    31:0] feed_begun_o,
    input  wire logic [     1:0] snapshot_i,
    input  wire logic [    31:0] chain_i,
    output logic      [    31:0] chain_o
);
  logic        take;
  logic        taking;
  logic [ 2:0] barrier;
  logic        feed_at;
  logic        feed_runs;
  logic        feed_decoder_idle;
  logic        geometry_idle;
  logic [31:0] chain;

  geometry_sequencer #(
      .Axes(Axes)
  ) geometry (
      .clk_i,
      .rst_i,
      .cut_i,
      .empty_i    (geometry_empty_i),
      .word_i     (geometry_word_i),
      .read_o     (geometry_read_o),
      .direct_load_i,
      .direct_go_i,
      .direct_mask_i,
      .direct_o,
      .load_o,
      .take_i     (take),
      .taking_o   (taking),
      .swap_o,
      .active_o,
      .engine_o,
      .engine_taken_o,
      .setting_i,
      .arrive_i,
      .rest_i     (idle_o),
      .streaming_o,
      .missing_o,
      .stale_o,
      .payload_ready_i,
      .shadows_free_i,
      .done_i     (engine_done_i),
      .elsewhere_i,
      .axes_live_i,
      .instant_o,
      .over_o,
      .probe_says_i,
      .drop_i,
      .probe_at_o,
      .feed_at_i  (feed_at),
      .feed_runs_i(feed_runs),
      .barrier_o  (barrier),
      .mismatch_o,
      .incomplete_o,
      .path_active_o,
      .ended_o,
      .idle_o     (geometry_idle),
      .snapshot_i,
      .chain_i    (chain),
      .chain_o,
      .begun_o    (geometry_begun_o)
  );

  feed_sequencer feed (
      .clk_i,
      .rst_i,
      .cut_i,
      .empty_i     (feed_empty_i),
      .word_i      (feed_word_i),
      .read_o      (feed_read_o),
      .take_i      (take),
      .direct_i    (direct_o),
      .barrier_i   (barrier),
      .at_barrier_o(feed_at),
      .runs_o      (feed_runs),
      .wait_i,
      .streaming_i (streaming_o),
      .taking_i    (taking),
      .spent_o,
      .drop_i,
      .active_o    (feed_active_o),
      .decoded_o   (),
      .moving_o,
      .class_o,
      .idle_o      (feed_decoder_idle),
      .swap_o      (feed_swap_o),
      .load_o      (feed_load_o),
      .snapshot_i,
      .chain_i,
      .chain_o     (chain),
      .begun_o     (feed_begun_o)
  );

  tick_gate gate (
      .clk_i,
      .rst_i,
      .cut_i,
      .enable_i,
      .feed_tick_i,
      .feed_active_i(feed_active_o),
      .direct_i     (direct_o),
      .taking_i     (taking),
      .ready_i      (engine_ready_i),
      .take_o       (take),
      .tick_o,
      .feed_enable_o,
      .feed_clear_o
  );

  always_ff @(posedge clk_i) idle_o <= (geometry_idle && feed_decoder_idle && feed_empty_i && !feed_active_o) || rst_i;
endmodule

`default_nettype wire
