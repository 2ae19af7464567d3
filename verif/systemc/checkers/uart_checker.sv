// Rules of the card's serial line at the pins, sampled with the card's clock.
`default_nettype none
module uart_checker #(
    parameter int BreakBits = 20
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [19:0] period_i,  // clocks per 8 bits, as the host sends them; 0: unknown
    input wire logic rx_i,
    input wire logic tx_i
);
  import "DPI-C" function void port_rule_broken(input string rule);

  logic rx_short, rx_no_stop, rx_short_break;
  logic tx_short, tx_no_stop, tx_short_break;
  serial_line_watch #(
      .BreakBits(BreakBits)
  ) rx (
      .clk_i,
      .rst_i,
      .line_i(rx_i),
      .period_i,
      .short_o(rx_short),
      .no_stop_o(rx_no_stop),
      .short_break_o(rx_short_break)
  );
  serial_line_watch #(
      .BreakBits(BreakBits)
  ) tx (
      .clk_i,
      .rst_i,
      .line_i(tx_i),
      .period_i,
      .short_o(tx_short),
      .no_stop_o(tx_no_stop),
      .short_break_o(tx_short_break)
  );

  // After a reset the card is silent until a break has ended. low_q: clocks for which the input line has been low.
  logic [24:0] low_q;
  logic spoken_to_q;
  always_ff @(posedge clk_i) begin
    low_q <= rx_i ? 25'd0 : low_q + {24'd0, !low_q[24]};
    if (rx_i && low_q >= 25'(1 << BreakBits)) spoken_to_q <= 1'b1;
    if (rst_i) begin
      low_q <= 25'd0;
      spoken_to_q <= 1'b0;
    end
  end

  // The host
  assert property (@(posedge clk_i) disable iff (rst_i) !rx_short)
  else port_rule_broken("UART: a bit from the host is too short");
  assert property (@(posedge clk_i) disable iff (rst_i) !rx_no_stop)
  else port_rule_broken("UART: a byte from the host has no stop bit");
  assert property (@(posedge clk_i) disable iff (rst_i) !rx_short_break)
  else port_rule_broken("UART: a break is too short");

  // The card
  assert property (@(posedge clk_i) disable iff (rst_i) tx_i || spoken_to_q)
  else port_rule_broken("UART: the card speaks before a break");
  assert property (@(posedge clk_i) disable iff (rst_i) !tx_short)
  else port_rule_broken("UART: a bit from the card is too short");
  assert property (@(posedge clk_i) disable iff (rst_i) !tx_no_stop && !tx_short_break)
  else port_rule_broken("UART: a byte from the card has no stop bit");
endmodule
`default_nettype wire
