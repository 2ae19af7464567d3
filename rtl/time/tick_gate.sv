// Decides the tick of the whole card: ticks of the feed generator (in direct mode: enabled clocks) are owed until the
// path can take them. `take_o` is decided from registers only and leaves as `tick_o` one clock later.
//
// The generator is stalled while two or more ticks are owed. At most five more arrive then (this gate's registers, the
// generator's three clocks), so four bits never overflow. Ticks that a shut gate owes to a direct move may overflow:
// only a cut opens the gate again.
//
// A silent piece runs in every clock, regardless of the time base: nothing moves, so that a held card can be brought to
// a place inside a path. Its ticks never become those of a piece that makes steps: such a piece begins at least 16
// clocks later (feed_sequencer), when the generator has been cleared.
`default_nettype none

module tick_gate (
    input  wire logic clk_i,
    input  wire logic rst_i,
    input  wire logic cut_i,
    input  wire logic enable_i,       // enable of the time base
    input  wire logic feed_tick_i,
    input  wire logic feed_active_i,  // a piece gives ticks
    input  wire logic silent_i,       // the ticks of that piece make no steps
    input  wire logic direct_i,       // a direct move is under way
    input  wire logic taking_i,       // a path takes ticks
    input  wire logic ready_i,        // the path's engine accepts ticks
    input  wire logic shut_i,         // no tick may be taken
    input  wire logic wait_i,         // no tick may be taken or made: the drives are not enabled
    output logic      take_o,         // combinational
    output logic      tick_o,
    output logic      feed_enable_o,
    output logic      feed_clear_o
);
  logic [3:0] count_q;
  logic       owed_q;
  logic       stall_q;
  logic       source_q;
  logic       source_active;

  assign source_active = feed_active_i || direct_i;
  // After a cut or a reset neither a piece nor a direct move is left, so nothing is owed one clock later.
  assign take_o = owed_q && taking_i && ready_i && source_active && !shut_i && !wait_i;

  always_ff @(posedge clk_i) begin : p_count
    logic [3:0] count_d;

    if (!source_active) begin
      count_q <= 4'd0;
      owed_q  <= 1'b0;
      stall_q <= 1'b0;
    end else if (source_q ^ take_o) begin
      count_d = source_q ? count_q + 4'd1 : count_q - 4'd1;
      count_q <= count_d;
      owed_q  <= count_d != 4'd0;
      stall_q <= count_d > 4'd1;
    end
  end

  always_ff @(posedge clk_i) begin
    source_q <= direct_i ? enable_i && !wait_i : feed_tick_i && feed_active_i;
    tick_o <= take_o && !cut_i && !rst_i;
    // The generator rests while no path can take its ticks, so that a path does not begin with a burst.
    feed_enable_o <= (enable_i || silent_i) && feed_active_i && taking_i && !stall_q && !wait_i && !cut_i && !rst_i;
    // Without a piece nothing is owed: ticks made beyond the last one's end never count.
    feed_clear_o <= !feed_active_i || cut_i || rst_i;
  end
endmodule

`default_nettype wire
