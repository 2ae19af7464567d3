// Owes the ticks of the feed generator until the path can take them.
//
// The generator is stalled while two or more ticks are owed. At most five more arrive then (the gate's register, the
// generator's three clocks, this counter), so that four bits never overflow.
`default_nettype none

module tick_gate (
    input  wire logic clk_i,
    input  wire logic rst_i,
    input  wire logic clear_i,
    input  wire logic tick_i,   // one more tick is owed
    input  wire logic take_i,   // one is taken; only while owed_o
    output logic      owed_o,   // at least one tick is owed
    output logic      stall_o   // two or more are owed
);
  logic [3:0] count_q;

  always_ff @(posedge clk_i) begin : p_count
    logic [3:0] count_d;

    if (clear_i | rst_i) begin
      count_q <= 4'd0;
      owed_o  <= 1'b0;
      stall_o <= 1'b0;
    end else if (tick_i ^ take_i) begin
      count_d = tick_i ? count_q + 4'd1 : count_q - 4'd1;
      count_q <= count_d;
      owed_o  <= count_d != 4'd0;
      stall_o <= count_d > 4'd1;
    end
  end
endmodule

`default_nettype wire
