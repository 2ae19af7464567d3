// Path ticks of an arc: counts what the prescaler has made and gives them to the accumulator one at a time.
//
// `ready_o` falls while two or more wait. The take reaches the prescaler one clock later and its step this counter three
// after that, so that at most seven wait: three bits would do, four leave room for a step at the same time.
`default_nettype none

module path_tick_gate (
    input  wire logic clk_i,
    input  wire logic rst_i,
    input  wire logic clear_i,
    input  wire logic step_i,          // from the prescaler
    input  wire logic engine_ready_i,
    output logic      tick_o,          // to the accumulator
    output logic      ready_o,         // feed ticks may be taken
    output logic      empty_o          // nothing waits and the accumulator has worked off the last one
);
  logic [3:0] count_q;
  logic       give;
  logic       waiting_q;

  // The accumulator answers a tick with ready low in the next clock: none is given in that clock.
  assign give = waiting_q & engine_ready_i & ~tick_o;

  always_ff @(posedge clk_i) begin : p_count
    logic [3:0] count_d;

    if (clear_i | rst_i) begin
      count_q   <= 4'd0;
      waiting_q <= 1'b0;
      ready_o   <= 1'b1;
    end else if (step_i ^ give) begin
      count_d = step_i ? count_q + 4'd1 : count_q - 4'd1;
      count_q   <= count_d;
      waiting_q <= count_d != 4'd0;
      ready_o   <= count_d < 4'd2;
    end
    tick_o  <= give & ~clear_i & ~rst_i;
    // A step that arrives makes it wait; a tick on its way is not worked off.
    empty_o <= ((~waiting_q & ~step_i) | clear_i | rst_i) & ~give & ~tick_o & engine_ready_i;
  end
endmodule

`default_nettype wire
