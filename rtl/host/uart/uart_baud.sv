// The baud rate, measured only after a break. A break is a line that is low for 2^BreakBits clocks. In the byte 55
// (hexadecimal) that follows, the first and the fifth falling edge are 8 bits apart.
`default_nettype none
module uart_baud #(
    parameter int BreakBits = 20  // 8 to 24
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic level_i,  // the line, synchronised
    input wire logic fall_i,  // it is low, and was high a clock ago
    output logic restart_o,  // event: a break
    output logic known_o,  // the rate is known, and the line has been high since
    output logic [19:0] period_o  // clocks per 8 bits, 64 or more
);
  logic                 wait_q;  // waits for the first edge after a break
  logic                 count_q;
  logic [BreakBits-1:0] low_q;
  logic                 full_q;  // the line has been low for 2^BreakBits clocks
  logic [          2:0] edges_q;  // falling edges, 4 at the fifth
  logic                 ends;
  logic                 fails;

  assign ends  = edges_q[2];
  // The counter cannot count 2^20 clocks; with fewer than 64 clocks a byte cannot be received.
  assign fails = &period_o || (ends && period_o[19:6] == 14'd0);

  // In the clock after a reset the line reads as high, which restarts low_q and full_q.
  always_ff @(posedge clk_i) begin
    low_q <= level_i ? '0 : low_q + 1'b1;
    full_q <= !level_i && (full_q || &low_q);
    restart_o <= !level_i && !full_q && &low_q && !rst_i;
  end

  // The stop bit ends the measurement: from then on a falling edge belongs to a byte.
  always_ff @(posedge clk_i) begin
    wait_q  <= restart_o || (wait_q && !fall_i);
    count_q <= (wait_q && fall_i) || (count_q && !fails && !(ends && level_i));
    if (wait_q) {edges_q, period_o} <= '0;
    if (count_q && !ends) begin
      period_o <= period_o + 20'd1;
      edges_q  <= edges_q + 3'(fall_i);
    end
    if (count_q && ends && level_i && !fails) known_o <= 1'b1;
    if (restart_o) begin
      count_q <= 1'b0;
      known_o <= 1'b0;
    end
    if (rst_i) begin
      wait_q  <= 1'b0;
      count_q <= 1'b0;
      known_o <= 1'b0;
    end
  end
endmodule
`default_nettype wire
