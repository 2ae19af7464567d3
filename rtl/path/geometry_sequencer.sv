// The geometry side of the card: decodes one command ahead, runs paths, meets the feed at barriers.
`default_nettype none

module geometry_sequencer #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1  // what is built in, as the register ENGINES shows it
) (
    input  wire logic            clk_i,
    input  wire logic            rst_i,
    input  wire logic            cut_i,
    // queue
    input  wire logic            empty_i,
    input  wire logic [    15:0] word_i,
    output logic                 read_o,
    // direct move
    input  wire logic [    21:0] direct_load_i,
    input  wire logic            direct_go_i,
    input  wire logic [Axes-1:0] direct_mask_i,
    output logic                 direct_o,
    // ticks
    output logic      [    21:0] load_o,
    input  wire logic            take_i,
    output logic                 taking_o,
    output logic                 swap_o,
    output logic      [Axes-1:0] active_o,
    output logic      [     4:0] engine_o,
    output logic                 engine_taken_o,   // by a path that still takes ticks (combinational)
    // position streaming
    input  wire logic [    40:0] setting_i,
    input  wire logic [    21:0] arrive_i,         // as tick_source has it
    input  wire logic            rest_i,           // nothing is queued or runs
    output logic                 streaming_o,      // the mode
    output logic                 missing_o,        // event
    output logic      [    32:0] stale_o,          // {a line goes on beyond its end, ticks}
    // ends
    input  wire logic            payload_ready_i,
    input  wire logic            shadows_free_i,
    input  wire logic            done_i,
    input  wire logic            elsewhere_i,
    input  wire logic            axes_live_i,
    // commands that are neither paths nor barriers
    output logic      [     1:0] instant_o,        // {MARK, OUTPUT} is taken now (combinational)
    output logic                 over_o,           // event: a path has ended
    // probe
    output logic      [     2:0] probe_at_o,       // as path_commands has them
    input  wire logic [     2:0] probe_says_i,
    input  wire logic [     1:0] drop_i,
    // barriers
    input  wire logic            feed_at_i,
    input  wire logic            feed_runs_i,
    output logic      [     2:0] barrier_o,        // {done, counts, begins}
    // faults and status
    output logic                 mismatch_o,
    output logic                 incomplete_o,
    output logic                 path_active_o,
    output logic                 ended_o,
    output logic                 idle_o,
    // what began
    input  wire logic [     1:0] snapshot_i,
    input  wire logic [    31:0] chain_i,
    output logic      [    31:0] chain_o,
    output logic      [    31:0] begun_o
);
  logic [Axes-1:0] mask;
  logic [     4:0] engine;
  logic            is_barrier;
  logic [     2:0] instant;
  logic            is_end;
  logic            is_wait;
  logic            probe_end;
  logic            dropped;
  logic            valid;
  logic            pop;
  logic            decoder_idle;
  logic            begins;
  logic            runs;
  logic            zero;
  logic            last;
  logic [    39:0] count;
  logic [     2:0] period;  // {the line goes on, has gone on, a period's last tick is taken}
  logic            lost;  // the next one is missing
  logic            at_barrier;

  assign runs = taking_o || (valid && !is_barrier && instant == 3'd0);
  assign dropped = valid && drop_i[1] && !probe_end;
  assign instant_o = {2{valid && !drop_i[1]}} & instant[1:0];
  assign probe_at_o = {barrier_o[1] && is_wait, barrier_o[1] && probe_end, valid && instant[2] && !path_active_o};

  geometry_decoder #(
      .Axes   (Axes),
      .Engines(Engines)
  ) decoder (
      .clk_i,
      .rst_i,
      .cut_i,
      .pop_i(pop || instant_o != 2'd0 || probe_says_i[1] || dropped),
      .payload_ready_i(payload_ready_i && !engine_taken_o),
      .shadows_free_i,
      .empty_i,
      .word_i,
      .read_o,
      .direct_load_i,
      .load_o,
      .mask_o(mask),
      .engine_o(engine),
      .barrier_o(is_barrier),
      .instant_o(instant),
      .end_o(is_end),
      .wait_o(is_wait),
      .probe_end_o(probe_end),
      .idle_o(decoder_idle),
      .valid_o(valid)
  );

  tick_counter ticks (
      .clk_i,
      .rst_i,
      .next_i ({load_o[21] && load_o[20:16] == load_target_pkg::TICKS, load_o[15:0]}),
      .count_o(count),
      .zero_o (zero),
      .load_i (begins || barrier_o[0]),
      .take_i ((take_i && !stale_o[32]) || barrier_o[1]),
      .last_o (last)
  );

  path_sequencer #(
      .Axes(Axes)
  ) paths (
      .clk_i,
      .rst_i,
      .cut_i,
      .halt_i(drop_i[0]),
      .valid_i(valid && !dropped && instant == 3'd0),
      .engine_i(engine),
      .barrier_i(is_barrier),
      .mask_i(mask),
      .pop_o(pop),
      .direct_go_i,
      .direct_mask_i,
      .streaming_i({lost, streaming_o}),
      .period_o(period),
      .take_i,
      .last_i(last),
      .taking_o,
      .swap_o,
      .begin_o(begins),
      .active_o,
      .engine_o,
      .direct_o,
      .axes_live_i,
      .done_i,
      .elsewhere_i,
      .engine_taken_o,
      .incomplete_o,
      .over_o,
      .barrier_done_i(barrier_o[2]),
      .at_barrier_o(at_barrier),
      .path_active_o
  );

  assign stale_o[32] = period[1];

  if (Engines[card_map_pkg::ENGINE_STREAMING]) begin : gen_streaming
    position_streaming periods (
        .clk_i,
        .rst_i,
        .cut_i,
        .setting_i,
        .arrive_i,
        .rest_i,
        .begin_i (begins),
        .count_i (count),
        .period_i(period),
        .take_i,
        .streaming_o,
        .missing_o,
        .lost_o  (lost),
        .ticks_o (stale_o[31:0])
    );
  end else begin : gen_no_streaming
    assign {streaming_o, missing_o, lost, stale_o[31:0]} = '0;

    logic unused;
    assign unused = &{1'b0, setting_i, arrive_i, rest_i, count, period};
  end


  // A barrier that has begun is over where the others are dropped.
  barrier both_queues (
      .clk_i,
      .rst_i,
      .cut_i(cut_i || (drop_i[0] && !(valid && probe_end))),
      .geometry_at_i(at_barrier),
      .geometry_runs_i(runs),
      .feed_at_i,
      .feed_runs_i,
      .zero_i(zero),
      .end_i(is_end),
      .wait_i(is_wait),
      .met_i(probe_says_i[0]),
      .stays_i(probe_end && probe_says_i[2]),
      .drop_i(drop_i[1]),
      .last_i(last),
      .begin_i(swap_o),
      .mismatch_o,
      .load_o(barrier_o[0]),
      .counting_o(barrier_o[1]),
      .done_o(barrier_o[2]),
      .ended_o
  );

  // A direct move does not count, nor what is neither path nor barrier. A barrier that had begun has counted.
  logic drop_counts;
  assign drop_counts = dropped && instant == 3'd0 && barrier_o[2:1] == 2'd0;

  begun_counter begun (
      .clk_i,
      .rst_i,
      .cut_i,
      .begin_i((swap_o && !direct_o) || barrier_o[0] || drop_counts),
      .snapshot_i,
      .chain_i,
      .chain_o,
      .begun_o
  );

  // A barrier is over before its command is.
  always_ff @(posedge clk_i) idle_o <= (decoder_idle && empty_i && !path_active_o) || rst_i;
endmodule

`default_nettype wire
