// Stays busy until nothing has run for 11 clocks: a tick takes at most 10 clocks to set its axis's own busy flag.
`default_nettype none

module busy_timer (
    input  wire logic clk_i,
    input  wire logic rst_i,
    input  wire logic running_i,
    output logic      busy_o
);
  logic [3:0] left_q;

  always_ff @(posedge clk_i) begin
    if (running_i) left_q <= 4'd10;
    else if (left_q != 4'd0) left_q <= left_q - 4'd1;
    busy_o <= running_i || left_q != 4'd0;
    if (rst_i) begin
      left_q <= 4'd0;
      busy_o <= 1'b0;
    end
  end
endmodule

`default_nettype wire
