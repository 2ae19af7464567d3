// The geometry side of the card: decodes one command ahead, runs paths, meets the feed at barriers.
`default_nettype none

module geometry_sequencer #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1  // what is built in, as the register ENGINES shows it
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    // queue
    input wire logic empty_i,
    input wire logic [15:0] word_i,
    output logic read_o,
    // direct move
    input wire logic [load_bus_pkg::WIDTH-1:0] direct_load_i,
    input wire logic direct_go_i,
    input wire logic [Axes-1:0] direct_mask_i,
    // feed, engines and axes
    input wire logic [feed_pkg::WIDTH-1:0] feed_i,
    input wire logic [engines_pkg::WIDTH-1:0] engines_i,
    output logic [load_bus_pkg::WIDTH-1:0] load_o,
    output logic [move_pkg::WIDTH-1:0] move_o,
    output logic taking_o,  // a path takes ticks
    // position streaming
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [arrival_pkg::WIDTH-1:0] arrival_i,
    input wire logic rest_i,  // nothing is queued or runs
    output logic streaming_o,  // the mode
    output logic missing_o,  // event
    output logic stale_o,  // a line goes on beyond its end
    output logic [31:0] stale_ticks_o,
    // commands that are neither paths nor barriers
    output logic take_output_o,  // OUTPUT is taken now (combinational)
    output logic take_mark_o,  // MARK is taken now (combinational)
    output logic over_o,  // event: a path has ended
    // probe and WAIT_INPUT, all combinational
    output logic probe_waits_o,  // a PROBE is decoded and no path runs
    output logic probe_ends_o,  // PROBE_END has begun
    output logic waits_for_input_o,  // WAIT_INPUT has begun
    input wire logic met_i,  // the condition decoded last is met
    input wire logic probe_taken_i,
    input wire logic probe_stays_i,  // PROBE_END must wait
    input wire logic drop_i,  // commands up to PROBE_END are not carried out
    input wire logic halt_i,  // event: what runs ends here
    // barriers
    output logic barrier_begins_o,  // event
    output logic barrier_counts_o,
    output logic barrier_done_o,  // event
    // faults and status
    output logic mismatch_o,
    output logic incomplete_o,
    output logic path_active_o,
    output logic ended_o,
    output logic idle_o,
    // what began
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o,
    output logic [31:0] begun_o
);
  // the decoded command
  logic [Axes-1:0] mask;
  logic [4:0] engine;
  logic is_barrier;  // or one of the next three
  logic is_output;
  logic is_mark;
  logic is_probe;
  logic is_end;
  logic is_wait;
  logic is_probe_end;
  logic instant;  // neither path nor barrier
  logic valid;
  logic dropped;
  logic pop;
  logic decoder_idle;
  // the path
  logic begins;
  logic runs;
  logic zero;
  logic last;
  logic [39:0] count;
  logic period_ends;
  logic goes_on;
  logic lost;
  logic at_barrier;
  logic [Axes-1:0] active;

  assign instant = is_output || is_mark || is_probe;
  assign runs = taking_o || (valid && !is_barrier);
  assign dropped = valid && drop_i && !is_probe_end;
  assign take_output_o = valid && is_output && !drop_i;
  assign take_mark_o = valid && is_mark && !drop_i;
  assign probe_waits_o = valid && is_probe && !path_active_o;
  assign probe_ends_o = barrier_counts_o && is_probe_end;
  assign waits_for_input_o = barrier_counts_o && is_wait;
  assign move_o[move_pkg::AXES+:8] = 8'(active);

  geometry_decoder #(
      .Axes   (Axes),
      .Engines(Engines)
  ) decoder (
      .clk_i,
      .rst_i,
      .cut_i,
      .pop_i(pop || take_output_o || take_mark_o || probe_taken_i || dropped),
      .payload_ready_i(engines_i[engines_pkg::PAYLOAD_READY] && !move_o[move_pkg::TAKING]),
      .shadows_free_i(engines_i[engines_pkg::SHADOWS_FREE]),
      .empty_i,
      .word_i,
      .read_o,
      .direct_load_i,
      .load_o,
      .mask_o(mask),
      .engine_o(engine),
      .barrier_o(is_barrier),
      .output_o(is_output),
      .mark_o(is_mark),
      .probe_o(is_probe),
      .end_o(is_end),
      .wait_o(is_wait),
      .probe_end_o(is_probe_end),
      .idle_o(decoder_idle),
      .valid_o(valid)
  );

  tick_counter ticks (
      .clk_i,
      .rst_i,
      .next_i (load_bus_pkg::to(load_o, load_target_pkg::TICKS)),
      .word_i (load_bus_pkg::word(load_o)),
      .count_o(count),
      .zero_o (zero),
      .load_i (begins || barrier_begins_o),
      .take_i ((feed_i[feed_pkg::TAKE] && !stale_o) || barrier_counts_o),
      .last_o (last)
  );

  path_sequencer #(
      .Axes(Axes)
  ) paths (
      .clk_i,
      .rst_i,
      .cut_i,
      .halt_i,
      .valid_i(valid && !dropped && !instant),
      .engine_i(engine),
      .barrier_i(is_barrier),
      .mask_i(mask),
      .pop_o(pop),
      .direct_go_i,
      .direct_mask_i,
      .streaming_i(streaming_o),
      .lost_i(lost),
      .period_ends_o(period_ends),
      .goes_on_o(goes_on),
      .stale_o,
      .take_i(feed_i[feed_pkg::TAKE]),
      .last_i(last),
      .taking_o,
      .swap_o(move_o[move_pkg::SWAP]),
      .begin_o(begins),
      .active_o(active),
      .engine_o(move_o[move_pkg::ENGINE+:5]),
      .direct_o(move_o[move_pkg::DIRECT]),
      .axes_live_i(engines_i[engines_pkg::LIVE]),
      .done_i(engines_i[engines_pkg::DONE]),
      .missed_end_i(engines_i[engines_pkg::MISSED_END]),
      .engine_taken_o(move_o[move_pkg::TAKING]),
      .incomplete_o,
      .over_o,
      .barrier_done_i(barrier_done_o),
      .at_barrier_o(at_barrier),
      .path_active_o
  );

  if (Engines[card_map_pkg::ENGINE_STREAMING]) begin : gen_streaming
    position_streaming periods (
        .clk_i,
        .rst_i,
        .cut_i,
        .setting_i,
        .arrival_i,
        .rest_i,
        .begin_i(begins),
        .count_i(count),
        .period_ends_i(period_ends),
        .goes_on_i(goes_on),
        .stale_i(stale_o),
        .take_i(feed_i[feed_pkg::TAKE]),
        .streaming_o,
        .missing_o,
        .lost_o(lost),
        .ticks_o(stale_ticks_o)
    );
  end else begin : gen_no_streaming
    assign {streaming_o, missing_o, lost, stale_ticks_o} = '0;

    logic unused;
    assign unused = &{1'b0, setting_i, arrival_i, rest_i, count, period_ends, goes_on};
  end

  // A barrier that has begun is over where the others are dropped.
  barrier both_queues (
      .clk_i,
      .rst_i,
      .cut_i(cut_i || (halt_i && !(valid && is_probe_end))),
      .geometry_at_i(at_barrier),
      .geometry_runs_i(runs),
      .feed_at_i(feed_i[feed_pkg::AT_BARRIER]),
      .feed_runs_i(feed_i[feed_pkg::RUNS]),
      .zero_i(zero),
      .end_i(is_end),
      .wait_i(is_wait),
      .met_i,
      .stays_i(is_probe_end && probe_stays_i),
      .drop_i,
      .last_i(last),
      .begin_i(move_o[move_pkg::SWAP]),
      .mismatch_o,
      .load_o(barrier_begins_o),
      .counting_o(barrier_counts_o),
      .done_o(barrier_done_o),
      .ended_o
  );

  // A direct move does not count, nor what is neither path nor barrier. A barrier that had begun has counted.
  logic drop_counts;
  assign drop_counts = dropped && !instant && !barrier_counts_o && !barrier_done_o;

  begun_counter begun (
      .clk_i,
      .rst_i,
      .cut_i,
      .begin_i((move_o[move_pkg::SWAP] && !move_o[move_pkg::DIRECT]) || barrier_begins_o || drop_counts),
      .snapshot_i,
      .snapshot_o,
      .begun_o
  );

  // A barrier is over before its command is.
  always_ff @(posedge clk_i) idle_o <= (decoder_idle && empty_i && !path_active_o) || rst_i;

  logic unused_feed;  // what concerns the path commands
  assign unused_feed = &{1'b0, feed_i, engines_i};
endmodule

`default_nettype wire
