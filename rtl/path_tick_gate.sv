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
  logic [3:0] count_d;
  logic       give;
  logic       waiting_q;

  // The accumulator answers a tick with ready low in the next clock: none is given in that clock.
  assign give = waiting_q & engine_ready_i & ~tick_o;

  always_comb begin
    count_d = count_q;
    if (step_i & ~give) count_d = count_q + 4'd1;
    if (give & ~step_i) count_d = count_q - 4'd1;
    if (clear_i | rst_i) count_d = 4'd0;
  end

  always_ff @(posedge clk_i) begin
    count_q   <= count_d;
    waiting_q <= count_d != 4'd0;
    ready_o   <= count_d < 4'd2;
    tick_o    <= give & ~clear_i & ~rst_i;
    empty_o   <= (count_d == 4'd0) & ~give & ~tick_o & engine_ready_i;
  end
endmodule

`default_nettype wire
