// One direction of a serial line, sampled with the card's clock: checks edges against the bit length, stop bits,
// breaks.
`default_nettype none
module serial_line_watch #(
    parameter int BreakBits = 20
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic line_i,
    input wire logic [19:0] period_i,  // clocks per 8 bits; 0: unknown
    output logic short_o,  // event: an edge is two clocks or more too early after the previous one
    output logic no_stop_o,  // event: a byte without a stop bit that does not begin a break
    output logic short_break_o  // event: low for longer than any byte, but not a break
);
  // Time since the last edge, and since the start bit's edge, in eighths of a clock: a bit is period_i of them.
  logic [24:0] edge_q;
  logic [27:0] byte_q;
  logic line_q, inside_q, seen_high_q;
  logic edge_now, stop_now;
  assign edge_now = line_i != line_q;
  assign stop_now = inside_q && byte_q[27:1] >= 27'(period_i) * 9 / 2 + 27'(period_i) / 4;  // 9.5 bits
  assign short_o = edge_now && inside_q && period_i != 20'd0 && edge_q + 25'd16 <= 25'(period_i);
  assign no_stop_o = stop_now && !line_i && seen_high_q;
  assign short_break_o = edge_now && line_i && !seen_high_q && stop_now && edge_q[24:3] + 22'd1 < 22'(1 << BreakBits);

  always_ff @(posedge clk_i) begin
    line_q <= line_i;
    edge_q <= edge_now ? 25'd8 : edge_q + (&edge_q[24:3] ? 25'd0 : 25'd8);
    byte_q <= byte_q + 28'd8;
    if (line_i) seen_high_q <= 1'b1;
    if (!inside_q && edge_now && !line_i && period_i != 20'd0) begin
      inside_q <= 1'b1;
      byte_q <= 28'd8;
      seen_high_q <= 1'b0;
    end else if (stop_now && (line_i || seen_high_q)) begin
      inside_q <= 1'b0;
    end
    if (rst_i) begin
      line_q   <= 1'b1;
      inside_q <= 1'b0;
      edge_q   <= '1;
    end
  end
endmodule
`default_nettype wire
