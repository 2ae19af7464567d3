// Ends of bits: after start_i, or half a bit later with half_i, the k-th bit ends at the whole part of k/8 periods. The
// fraction is carried along, so that errors do not add up over ten bits.
`default_nettype none
module uart_timer (
    input wire logic clk_i,
    input wire logic [19:0] period_i,  // clocks per 8 bits
    input wire logic start_i,
    input wire logic half_i,  // with start_i: half a bit first
    output logic end_o  // end of a bit: a bit's length after start_i or the end before; meaningless at rest
);
  logic [16:0] count_q;
  logic [ 2:0] fraction_q;
  logic        extra_q;  // this bit has one clock more

  assign end_o = count_q == 17'd0 || (count_q == 17'd1 && !extra_q);

  always_ff @(posedge clk_i) begin
    count_q <= count_q - 17'd1;
    if (end_o || start_i) begin
      count_q <= period_i[19:3];
      {extra_q, fraction_q} <= {1'b0, start_i ? 3'd0 : fraction_q} + {1'b0, period_i[2:0]};
    end
    if (start_i && half_i) begin
      count_q <= {1'b0, period_i[19:4]};
      {extra_q, fraction_q} <= '0;
    end
  end
endmodule
`default_nettype wire
