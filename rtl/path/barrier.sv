// DWELL, END, WAIT_INPUT and PROBE_END: waits until both queues are at the barrier, counts clocks or waits for the end
// condition, then lets both continue. If one queue is at a barrier and the other still has ticks to give or take, the
// program is wrong.
//
// The path's tick counter is free at a barrier and counts the clocks. A dwell of n clocks counts as max(1, n).
`default_nettype none

module barrier (
    input  wire logic clk_i,
    input  wire logic rst_i,
    input  wire logic cut_i,
    input  wire logic geometry_at_i,
    input  wire logic geometry_runs_i,
    input  wire logic feed_at_i,
    input  wire logic feed_runs_i,
    input  wire logic zero_i,           // the count is 0
    input  wire logic end_i,            // the barrier is an END
    input  wire logic wait_i,           // the barrier is a WAIT_INPUT: the count is a time-out, 0 none
    input  wire logic met_i,            // the condition of the WAIT_INPUT is met
    input  wire logic stays_i,          // the barrier is a PROBE_END that must wait
    input  wire logic drop_i,           // commands are dropped: a queue alone at a barrier is no mismatch
    input  wire logic last_i,           // last_o of the tick counter
    input  wire logic begin_i,          // a path or a direct move began in the clock before
    output logic      mismatch_o,       // event
    output logic      load_o,           // event: the barrier begins; loads the tick counter
    output logic      counting_o,       // the tick counter counts once per clock
    output logic      done_o,           // event: both queues continue
    output logic      ended_o           // the last command was an END (combinational)
);
  // SETTLE waits for the last tick to pass the path domain. LEAVE gives the two fetches the clock in which they take
  // back geometry_at_i and feed_at_i.
  typedef enum logic [2:0] {
    IDLE,
    SETTLE,
    LOAD,
    COUNT,
    LEAVE
  } state_e;

  state_e       state_q;
  logic   [1:0] step_q;
  logic         together;
  logic         alone;
  logic         over;

  assign together = geometry_at_i && feed_at_i;
  assign alone = (geometry_at_i && feed_runs_i) || (feed_at_i && geometry_runs_i);
  assign over = state_q == COUNT && !stays_i && (wait_i ? met_i || (last_i && !zero_i) : zero_i || last_i);

  always_ff @(posedge clk_i) begin : p_barrier
    state_e state_d;

    // Both queues stay at a barrier until it is done or cut. Between barriers the state does not change.
    if (together || rst_i) begin
      state_d = state_q;
      case (state_q)
        IDLE: state_d = SETTLE;
        SETTLE: if (step_q == 2'd2) state_d = LOAD;
        LOAD: state_d = COUNT;
        COUNT: if (over) state_d = LEAVE;
        default: state_d = IDLE;
      endcase
      if (cut_i || rst_i) state_d = IDLE;

      done_o     <= over && !cut_i && !rst_i;
      load_o     <= state_d == LOAD;
      counting_o <= state_d == COUNT;
      step_q     <= state_q == SETTLE ? step_q + 2'd1 : 2'd0;
      state_q    <= state_d;
    end
  end

  // The begin of a motion is reported one clock late, so ended_o also excludes the clock of begin_i.
  logic ended_q;
  assign ended_o = ended_q && !begin_i;

  always_ff @(posedge clk_i) begin
    mismatch_o <= alone && !drop_i && !cut_i && !rst_i;
    if (rst_i || cut_i || load_o) ended_q <= 1'b0;
    else if (over && end_i) ended_q <= 1'b1;
    else if (begin_i) ended_q <= 1'b0;
  end
endmodule

`default_nettype wire
