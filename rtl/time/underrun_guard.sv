// Under-run hold: the card slows down along its path early enough to be at rest before the queued commands end, and
// continues by itself. A piece that would begin from rest waits until enough is queued.
//
// Every 32 clocks the guard decides whether the queues are short: queued ticks <= stop distance * ratio^2 + Reserve.
// They are not short if the last piece ends at rest and its paths are queued, or if a barrier comes last. The guard
// begins to hold when they are short in motion. It ends the hold when twice as much is queued, for the ratio at which
// the hold began, so that it does not chatter. For the same reason a piece that would begin from rest waits for twice
// as much, unless a queue is full and no more can come. If the card is also at rest, anything beyond the reserve is
// enough, and the card goes on as fast as that allows.
//
// A probe drops commands from the queues uncounted. From then on the rule is suspended, until nothing is queued once.
`default_nettype none

module underrun_guard #(
    parameter logic Probing = 1'b1  // 0: nothing is ever dropped
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,  // a cut, or position streaming, which has no rule: nothing is counted
    input wire logic lost_i,  // event: the queued commands will be dropped
    input wire logic idle_i,  // nothing runs, is decoded or queued; delayed by up to four clocks
    input wire logic gone_i,  // the session that wrote the queued commands was replaced: nothing begins or continues
    input wire logic [arrival_pkg::WIDTH-1:0] arrival_i,
    input wire logic [feed_load_pkg::WIDTH-1:0] load_i,
    input wire logic take_i,  // a feed tick is taken
    input wire logic swap_i,  // a piece began in the clock before
    input wire logic active_i,  // a piece gives ticks
    input wire logic decoded_i,  // a decoded piece waits
    input wire logic [16:0] ratio_i,
    output logic wait_o,  // a decoded piece must not begin (combinational)
    output logic hold_o,
    output logic shown_o,  // the guard holds, or keeps a piece waiting
    output logic [31:0] underruns_o  // number of under-run holds so far
);
  localparam int Reserve = card_map_pkg::UNDERRUN_RESERVE_TICKS;
  localparam logic [4:0] LOOK = 5'd11;  // the stop distance that is taken in this step is judged
  localparam logic [4:0] DECIDE = 5'd29;

  logic [4:0] step_q;
  always_ff @(posedge clk_i) step_q <= rst_i ? 5'd0 : step_q + 5'd1;

  logic [13:0] inverted_limit;
  logic geometry_short, feed_short, covered, at_rest, at_barrier;
  logic next_zero, ruled;
  logic standing;
  logic full;
  logic ends_q;  // the piece in force ends at rest
  logic covered_q;  // all its ticks have their paths queued
  logic from_rest, from_rest_q;
  logic follow;
  logic judges;  // this round judges the next piece; sampled at LOOK
  logic twice_q;  // the round demands twice the stop's ticks, so it begins no hold
  assign full = arrival_i[arrival_pkg::FULL];
  assign standing = ratio_i == 17'd0;
  assign from_rest = !active_i || ends_q;
  assign follow = !active_i || (ends_q && covered_q);

  logic lost;
  logic unknown;  // the counts are lost, or were lost during the comparison that is decided next

  if (Probing) begin : gen_probing
    logic lost_q;
    logic unknown_q;
    logic inside_q;  // inside a command on its way in
    logic [2:0] since_q;  // clocks since the last command arrived; 7: 7 or more

    always_ff @(posedge clk_i) begin
      if (arrival_pkg::writes(arrival_i)) inside_q <= 1'b1;
      if (arrival_pkg::ends(arrival_i)) begin
        inside_q <= 1'b0;
        since_q  <= 3'd0;
      end else if (since_q != 3'd7) since_q <= since_q + 3'd1;
      lost_q <= lost_i || (lost_q && !(idle_i && !inside_q && since_q == 3'd7));
      unknown_q <= lost_q || (unknown_q && step_q != DECIDE);
      if (cut_i || rst_i) begin
        inside_q <= 1'b0;
        lost_q   <= 1'b0;
      end
      if (rst_i) unknown_q <= 1'b0;
    end
    assign lost = lost_q;
    assign unknown = lost_q || unknown_q;
  end else begin : gen_no_probing
    assign lost = 1'b0;
    assign unknown = 1'b0;

    logic unused;
    assign unused = &{1'b0, lost_i, idle_i};
  end

  queued_ticks #(
      .Reserve(Reserve)
  ) queued (
      .clk_i,
      .rst_i,
      .cut_i,
      .forget_i(lost),
      .arrival_i,
      .take_i,
      .word_i(step_q[1:0]),
      .inverted_limit_i(inverted_limit),
      .geometry_short_o(geometry_short),
      .feed_short_o(feed_short),
      .covered_o(covered),
      .at_rest_o(at_rest),
      .at_barrier_o(at_barrier)
  );

  stop_ticks stop (
      .clk_i,
      .rst_i,
      .cut_i,
      .step_i(step_q),
      .ratio_i,
      .keep_i(hold_o),
      .twice_i(hold_o || (judges && !full)),
      .none_i(standing && full),
      .load_i,
      .swap_i,
      .from_rest_i(from_rest_q),
      .follow_i(follow),
      .next_zero_o(next_zero),
      .ruled_o(ruled),
      .inverted_o(inverted_limit)
  );

  logic decoded_q;
  logic judged_q;
  logic holds;
  logic enough_q;  // enough is queued for the next piece
  logic waits_q;
  logic short;
  logic waits;
  assign judges = decoded_q && follow;
  assign holds  = (short && (hold_o || (!twice_q && (!follow || (judged_q && full))))) || (hold_o && gone_i);
  assign waits  = short || (gone_i && ruled);
  assign short  = ruled && !at_barrier && !unknown && ((geometry_short && !covered) || (feed_short && !at_rest));

  always_ff @(posedge clk_i) begin
    from_rest_q <= from_rest;
    decoded_q   <= decoded_i;
    if (step_q == LOOK) begin
      judged_q <= judges;
      twice_q  <= judges && !full;
    end
    if (step_q == DECIDE) begin
      hold_o <= holds;
      if (holds && !hold_o) underruns_o <= underruns_o + 32'd1;
      enough_q <= judged_q && !waits;
      waits_q  <= judged_q && !active_i && waits;
      if (covered && !unknown) covered_q <= 1'b1;
    end
    if (swap_i) begin
      ends_q <= next_zero;
      covered_q <= 1'b0;
    end
    if (swap_i || cut_i || rst_i) begin
      judged_q <= 1'b0;
      enough_q <= 1'b0;
      waits_q  <= 1'b0;
    end
    if (cut_i || rst_i) begin
      hold_o <= 1'b0;
      ends_q <= 1'b0;
    end
    if (rst_i) underruns_o <= 32'd0;
  end

  assign wait_o  = from_rest && !next_zero && !enough_q && !lost;
  assign shown_o = hold_o || waits_q;
endmodule

`default_nettype wire
