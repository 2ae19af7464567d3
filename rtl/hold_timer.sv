// One clock in `limit_i`: the beat by which the shapers judge how long a step has waited.
`default_nettype none

module hold_timer (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic [15:0] limit_i,  // clocks, at least 1
    output logic             tick_o
);
  logic [15:0] count_q;

  always_ff @(posedge clk_i) begin
    // A limit lowered in mid count takes effect at once; >= costs no more than the equality.
    tick_o  <= count_q >= limit_i - 16'd1;
    count_q <= (count_q >= limit_i - 16'd1) ? 16'd0 : count_q + 16'd1;
    if (rst_i) begin
      tick_o  <= 1'b0;
      count_q <= 16'd0;
    end
  end
endmodule

`default_nettype wire
