// The geometry side of the card: decodes one command ahead, runs paths, and meets the feed at barriers.
`default_nettype none

module geometry_sequencer #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1  // built-in engines: bits card_map_pkg::ENGINE_*
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
    input wire logic take_i,  // a tick is taken in this clock (combinational)
    input wire logic [engines_pkg::WIDTH-1:0] engines_i,
    output logic [load_bus_pkg::WIDTH-1:0] load_o,
    output logic [move_pkg::WIDTH-1:0] move_o,
    output logic [path_pkg::WIDTH-1:0] path_o,
    // position streaming
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [arrival_pkg::WIDTH-1:0] arrival_i,
    input wire logic rest_i,  // nothing is queued or runs
    // commands that are neither paths nor barriers, and the probe
    output logic [commands_pkg::WIDTH-1:0] commands_o,
    input wire logic [probe_pkg::WIDTH-1:0] probe_i,
    input wire logic drop_i,  // commands up to PROBE_END are dropped
    input wire logic halt_i,  // event: the path under way ends here
    // status
    output logic idle_o,
    output logic [geometry_state_pkg::WIDTH-1:0] geometry_state_o,
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o
);
  // the decoded command
  logic [Axes-1:0] mask;
  logic [4:0] engine;
  logic is_barrier;  // the command is not a path: a barrier, or one of the next four
  logic is_output;
  logic is_mark;
  logic is_pwm;
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
  logic taking;
  logic path_active;
  logic over;
  logic barrier_begins;
  logic barrier_counts;
  logic barrier_done;
  logic streaming;
  logic period_ends;
  logic goes_on;
  logic stale;
  logic lost;
  logic at_barrier;
  logic [Axes-1:0] active;
  logic take_output;
  logic take_mark;
  logic take_pwm;

  assign instant = is_output || is_mark || is_pwm || is_probe;
  assign runs = taking || (valid && !is_barrier);
  assign dropped = valid && drop_i && !is_probe_end;
  assign take_output = valid && is_output && !drop_i;
  assign take_mark = valid && is_mark && !drop_i;
  assign take_pwm = valid && is_pwm && !drop_i;

  assign commands_o[commands_pkg::TAKE_OUTPUT] = take_output;
  assign commands_o[commands_pkg::TAKE_MARK] = take_mark;
  assign commands_o[commands_pkg::TAKE_PWM] = take_pwm;
  assign commands_o[commands_pkg::OVER] = over;
  assign commands_o[commands_pkg::RUNS] = path_active;
  assign commands_o[commands_pkg::PROBE_WAITS] = valid && is_probe && !path_active;
  assign commands_o[commands_pkg::PROBE_ENDS] = barrier_counts && is_probe_end;

  assign path_o[path_pkg::TAKING] = taking;
  assign path_o[path_pkg::DIRECT] = move_o[move_pkg::DIRECT];
  assign path_o[path_pkg::STREAMING] = streaming;
  assign path_o[path_pkg::BARRIER_BEGINS] = barrier_begins;
  assign path_o[path_pkg::BARRIER_COUNTS] = barrier_counts;
  assign path_o[path_pkg::BARRIER_DONE] = barrier_done;
  assign path_o[path_pkg::DROP] = drop_i;
  assign path_o[path_pkg::HALT] = halt_i;
  assign path_o[path_pkg::HOLD] = probe_i[probe_pkg::HOLD];
  assign path_o[path_pkg::PROBING] = probe_i[probe_pkg::BUSY];

  assign geometry_state_o[geometry_state_pkg::PATH_SWAP] = move_o[move_pkg::SWAP];
  assign geometry_state_o[geometry_state_pkg::DIRECT] = move_o[move_pkg::DIRECT];
  assign geometry_state_o[geometry_state_pkg::PATH_ACTIVE] = path_active;
  assign geometry_state_o[geometry_state_pkg::STALE] = stale;
  assign geometry_state_o[geometry_state_pkg::WAITING] = barrier_counts && is_wait;

  assign move_o[move_pkg::AXES+:8] = 8'(active);

  geometry_decoder #(
      .Axes   (Axes),
      .Engines(Engines)
  ) decoder (
      .clk_i,
      .rst_i,
      .cut_i,
      .pop_i(pop || take_output || take_mark || take_pwm || probe_i[probe_pkg::TAKEN] || dropped),
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
      .pwm_o(is_pwm),
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
      .load_i (begins || barrier_begins),
      .take_i ((take_i && !stale) || barrier_counts),
      .left_o (path_o[path_pkg::LEFT+:40]),
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
      .streaming_i(streaming),
      .lost_i(lost || feed_i[feed_pkg::CLOSING]),
      .period_ends_o(period_ends),
      .goes_on_o(goes_on),
      .stale_o(stale),
      .take_i,
      .last_i(last),
      .taking_o(taking),
      .swap_o(move_o[move_pkg::SWAP]),
      .begin_o(begins),
      .active_o(active),
      .engine_o(move_o[move_pkg::ENGINE+:5]),
      .direct_o(move_o[move_pkg::DIRECT]),
      .axes_live_i(engines_i[engines_pkg::LIVE]),
      .done_i(engines_i[engines_pkg::DONE]),
      .missed_end_i(engines_i[engines_pkg::MISSED_END]),
      .engine_taken_o(move_o[move_pkg::TAKING]),
      .incomplete_o(path_o[path_pkg::INCOMPLETE]),
      .over_o(over),
      .barrier_done_i(barrier_done),
      .at_barrier_o(at_barrier),
      .path_active_o(path_active),
      .unfinished_o(path_o[path_pkg::UNFINISHED])
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
        .stale_i(stale),
        .take_i,
        .streaming_o(streaming),
        .missing_o(path_o[path_pkg::MISSING]),
        .lost_o(lost),
        .ticks_o(geometry_state_o[geometry_state_pkg::STALE_TICKS+:32])
    );
  end else begin : gen_no_streaming
    assign {streaming, lost} = '0;
    assign path_o[path_pkg::MISSING] = 1'b0;
    assign geometry_state_o[geometry_state_pkg::STALE_TICKS+:32] = '0;

    logic unused;
    assign unused = &{1'b0, setting_i, arrival_i, rest_i, count, period_ends, goes_on};
  end

  // A halt ends a barrier that has begun, because it drops the commands; PROBE_END stays.
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
      .met_i(probe_i[probe_pkg::MET]),
      .stays_i(is_probe_end && probe_i[probe_pkg::STAYS]),
      .drop_i,
      .last_i(last),
      .begin_i(move_o[move_pkg::SWAP]),
      .mismatch_o(path_o[path_pkg::MISMATCH]),
      .load_o(barrier_begins),
      .counting_o(barrier_counts),
      .done_o(barrier_done),
      .ended_o(geometry_state_o[geometry_state_pkg::ENDED])
  );

  // A direct move does not count, nor does a command that is neither path nor barrier. A barrier that has begun is
  // counted.
  logic drop_counts;
  assign drop_counts = dropped && !instant && !barrier_counts && !barrier_done;

  begun_counter begun (
      .clk_i,
      .rst_i,
      .cut_i,
      .begin_i((move_o[move_pkg::SWAP] && !move_o[move_pkg::DIRECT]) || barrier_begins || drop_counts),
      .snapshot_i,
      .snapshot_o,
      .begun_o(geometry_state_o[geometry_state_pkg::GEOMETRY_BEGUN+:32])
  );

  // A barrier ends before its command does, so decoder_idle covers it.
  always_ff @(posedge clk_i) idle_o <= (decoder_idle && empty_i && !path_active) || rst_i;

  logic unused_bundles;  // fields for other blocks
  assign unused_bundles = &{1'b0, feed_i, engines_i, probe_i};
endmodule

`default_nettype wire
