// Busy until nothing has run for 11 clocks: the longest way of a tick to an axis's own busy flag is 10.
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
