// The card's sequencer: takes ticks, runs geometry and feed side by side, joins them at barriers, stops at faults.
//
// `take` is the tick of the whole card. It is decided from registers only and leaves as `tick_o` one clock later, in
// step with the swaps that it causes.
`default_nettype none

module sequencer #(
    parameter int Axes = 4
) (
    input  wire logic            clk_i,
    input  wire logic            rst_i,
    input  wire logic            abort_i,
    // queues
    input  wire logic            geometry_empty_i,
    input  wire logic [    15:0] geometry_word_i,
    output logic                 geometry_read_o,
    input  wire logic            feed_empty_i,
    input  wire logic [    15:0] feed_word_i,
    output logic                 feed_read_o,
    // direct move
    input  wire logic [    15:0] direct_word_i,
    input  wire logic [     2:0] direct_axis_i,
    input  wire logic            direct_increment_i,
    input  wire logic            direct_steps_i,
    input  wire logic            direct_length_i,
    input  wire logic            direct_go_i,
    input  wire logic [Axes-1:0] direct_mask_i,
    output logic                 direct_o,
    // time
    input  wire logic            enable_i,            // time base
    input  wire logic            feed_tick_i,
    output logic                 feed_enable_o,
    output logic                 feed_clear_o,
    output logic                 feed_swap_o,
    output logic      [     3:0] feed_load_o,
    output logic      [    15:0] feed_word_o,
    // load bus and axes
    output logic      [    15:0] load_word_o,
    output logic      [Axes-1:0] load_increment_o,
    output logic      [Axes-1:0] load_steps_o,
    output logic                 load_prescale_o,
    output logic      [     8:0] load_deviation_o,
    output logic                 tick_o,
    output logic                 swap_o,
    output logic      [Axes-1:0] active_o,
    input  wire logic            axes_live_i,
    // arcs
    output logic                 prescaler_o,
    output logic                 arc_start_o,
    input  wire logic            prescaler_step_i,
    input  wire logic            engine_ready_i,
    input  wire logic            engine_at_end_i,
    output logic                 path_tick_o,
    // status
    input  wire logic            faulted_i,           // a step fault, or a bit of FAULT
    output logic                 go_o,                // ticks may be taken
    output logic      [     1:0] fault_o,             // {PATH_INCOMPLETE, TICK_MISMATCH}, at the moment
    output logic                 path_active_o,
    output logic                 feed_active_o,
    output logic                 ended_o,
    output logic                 idle_o,              // nothing runs, is decoded or queued
    output logic      [     7:0] geometry_number_o,
    output logic      [     7:0] feed_number_o
);
  logic take;
  logic taking;
  logic owed;
  logic stall;
  logic engine_free;
  logic engine_empty;
  logic incomplete;
  logic mismatch_q;
  logic path_waits;
  logic piece_waits;
  logic geometry_at;
  logic feed_at;
  logic barrier_done;
  logic geometry_idle;
  logic feed_idle;
  logic source_tick_q;

  assign take = owed & taking & engine_free & go_o & (feed_active_o | direct_o);

  tick_gate gate (
      .clk_i,
      .rst_i,
      .clear_i(abort_i | ~(feed_active_o | direct_o)),
      .tick_i (source_tick_q),
      .take_i (take),
      .owed_o (owed),
      .stall_o(stall)
  );

  path_tick_gate path_ticks (
      .clk_i,
      .rst_i,
      .clear_i(abort_i),
      .step_i (prescaler_step_i),
      .engine_ready_i,
      .tick_o (path_tick_o),
      .ready_o(engine_free),
      .empty_o(engine_empty)
  );

  geometry_sequencer #(
      .Axes(Axes)
  ) geometry (
      .clk_i,
      .rst_i,
      .clear_i          (abort_i),
      .go_i             (go_o),
      .empty_i          (geometry_empty_i),
      .word_i           (geometry_word_i),
      .read_o           (geometry_read_o),
      .direct_word_i,
      .direct_axis_i,
      .direct_increment_i,
      .direct_steps_i,
      .direct_length_i,
      .direct_go_i,
      .direct_mask_i,
      .direct_o,
      .load_word_o,
      .load_increment_o,
      .load_steps_o,
      .load_prescale_o,
      .load_deviation_o,
      .take_i           (take),
      .taking_o         (taking),
      .swap_o,
      .active_o,
      .prescaler_o,
      .arc_start_o,
      .axes_live_i,
      .engine_empty_i   (engine_empty),
      .engine_at_end_i,
      .feed_at_barrier_i(feed_at),
      .at_barrier_o     (geometry_at),
      .barrier_done_o   (barrier_done),
      .incomplete_o     (incomplete),
      .path_waits_o     (path_waits),
      .path_active_o,
      .ended_o,
      .idle_o           (geometry_idle),
      .number_o         (geometry_number_o)
  );

  feed_sequencer feed (
      .clk_i,
      .rst_i,
      .clear_i       (abort_i),
      .go_i          (go_o),
      .empty_i       (feed_empty_i),
      .word_i        (feed_word_i),
      .read_o        (feed_read_o),
      .take_i        (take),
      .barrier_done_i(barrier_done),
      .at_barrier_o  (feed_at),
      .piece_waits_o (piece_waits),
      .active_o      (feed_active_o),
      .idle_o        (feed_idle),
      .number_o      (feed_number_o),
      .swap_o        (feed_swap_o),
      .load_o        (feed_load_o),
      .load_word_o   (feed_word_o)
  );

  fault_stop faults (
      .clk_i,
      .rst_i,
      .abort_i,
      .event_i  (fault_o[0] | fault_o[1]),
      .latched_i(faulted_i),
      .go_o     (go_o)
  );

  assign fault_o = {incomplete, mismatch_q};

  always_ff @(posedge clk_i) begin
    tick_o <= take & ~abort_i & ~rst_i;
    // The generator rests while no path can take its ticks, so that a path does not begin with a burst.
    feed_enable_o <= enable_i & feed_active_o & taking & ~stall & go_o & ~abort_i & ~rst_i;
    // Without a piece nothing is owed: ticks made beyond the last one's end never count.
    feed_clear_o <= ~feed_active_o | abort_i | rst_i;
    source_tick_q <= (direct_o ? enable_i & taking : feed_tick_i & feed_active_o) & ~abort_i & ~rst_i;
    mismatch_q    <= ((geometry_at & (feed_active_o | piece_waits)) | (feed_at & ((taking & ~direct_o) | path_waits))) &
        go_o & ~barrier_done & ~abort_i & ~rst_i;
    idle_o <= geometry_idle & feed_idle & feed_empty_i & ~feed_active_o;
  end
endmodule

`default_nettype wire
