// Clocks since reset, as a snapshot writes them down: two clocks late, the high word three.
`default_nettype none
module time_counter (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    output logic      [63:0] time_o
);

  logic carry_q;

  always_ff @(posedge clk_i) begin
    if (carry_q) time_o[63:32] <= time_o[63:32] + 32'd1;
    {carry_q, time_o[31:0]} <= {1'b0, time_o[31:0]} + 33'd1;
    if (rst_i) begin
      carry_q <= 1'b0;
      time_o  <= -64'd2;
    end
  end

endmodule
`default_nettype wire
