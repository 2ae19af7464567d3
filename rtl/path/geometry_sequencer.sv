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
    output logic                 engine_taken_o,    // by a path that still takes ticks (combinational)
    // ends
    input  wire logic            payload_ready_i,
    input  wire logic            shadows_free_i,
    input  wire logic            done_i,
    input  wire logic            elsewhere_i,
    input  wire logic            axes_live_i,
    // commands that are neither paths nor barriers
    output logic      [     1:0] instant_o,         // {MARK, OUTPUT} is taken now (combinational)
    output logic                 over_o,            // event: a path has ended
    // probe
    input  wire logic            met_i,             // the condition decoded last is met
    input  wire logic            probe_taken_i,
    input  wire logic            probe_stays_i,     // PROBE_END must wait
    input  wire logic            halt_i,            // event: the path ends here
    input  wire logic            drop_i,            // commands up to PROBE_END are not carried out
    output logic                 probe_waits_o,     // a PROBE is decoded and no path runs (combinational)
    output logic                 probe_ends_o,      // PROBE_END has begun (combinational)
    output logic                 waiting_o,         // WAIT_INPUT has begun (combinational)
    // barriers
    input  wire logic            feed_at_i,
    input  wire logic            feed_runs_i,
    output logic                 barrier_begin_o,
    output logic                 barrier_done_o,
    output logic                 barrier_counts_o,
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
  logic            is_probe_end;
  logic            dropped;
  logic            valid;
  logic            path_pop;
  logic            decoder_idle;
  logic            path_begin;
  logic            runs;
  logic            zero;
  logic            last;
  logic            at_barrier;

  assign runs = taking_o || (valid && !is_barrier && instant == 3'd0);
  assign dropped = valid && drop_i && !is_probe_end;
  assign instant_o = {2{valid && !drop_i}} & instant[1:0];
  assign probe_waits_o = valid && instant[2] && !path_active_o;
  assign probe_ends_o = barrier_counts_o && is_probe_end;
  assign waiting_o = barrier_counts_o && is_wait;

  geometry_decoder #(
      .Axes   (Axes),
      .Engines(Engines)
  ) decoder (
      .*,
      .pop_i          (path_pop || instant_o != 2'd0 || probe_taken_i || dropped),
      .payload_ready_i(payload_ready_i && !engine_taken_o),
      .mask_o         (mask),
      .engine_o       (engine),
      .barrier_o      (is_barrier),
      .instant_o      (instant),
      .end_o          (is_end),
      .wait_o         (is_wait),
      .probe_end_o    (is_probe_end),
      .idle_o         (decoder_idle),
      .valid_o        (valid)
  );

  tick_counter ticks (
      .*,
      .next_i({load_o[21] && load_o[20:16] == load_target_pkg::TICKS, load_o[15:0]}),
      .zero_o(zero),
      .load_i(path_begin || barrier_begin_o),
      .take_i(take_i || barrier_counts_o),
      .last_o(last)
  );

  path_sequencer #(
      .Axes(Axes)
  ) paths (
      .*,
      .valid_i       (valid && !dropped && instant == 3'd0),
      .engine_i      (engine),
      .barrier_i     (is_barrier),
      .mask_i        (mask),
      .pop_o         (path_pop),
      .last_i        (last),
      .begin_o       (path_begin),
      .barrier_done_i(barrier_done_o),
      .at_barrier_o  (at_barrier)
  );

  // A barrier that has begun is over where the others are dropped.
  barrier both_queues (
      .*,
      .cut_i          (cut_i || (halt_i && !(valid && is_probe_end))),
      .geometry_at_i  (at_barrier),
      .geometry_runs_i(runs),
      .zero_i         (zero),
      .end_i          (is_end),
      .wait_i         (is_wait),
      .stays_i        (is_probe_end && probe_stays_i),
      .last_i         (last),
      .begin_i        (path_begin),
      .load_o         (barrier_begin_o),
      .counting_o     (barrier_counts_o),
      .done_o         (barrier_done_o)
  );

  // A direct move does not count, nor what is neither path nor barrier. A barrier that had begun has counted.
  logic drop_counts;
  assign drop_counts = dropped && instant == 3'd0 && !barrier_counts_o && !barrier_done_o;

  begun_counter begun (
      .*,
      .begin_i((swap_o && !direct_o) || barrier_begin_o || drop_counts)
  );

  // A barrier is over before its command is.
  always_ff @(posedge clk_i) idle_o <= (decoder_idle && empty_i && !path_active_o) || rst_i;
endmodule

`default_nettype wire
