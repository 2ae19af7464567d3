// A serial line: bytes to and from the frame engine. Until a break and the byte after it have given the baud rate, no
// byte is received and the output line is high.
`default_nettype none
module uart_port #(
    parameter int BreakBits = 20  // a break is 2^BreakBits clocks long: 8 to 24
) (
    input wire logic clk_i,
    input wire logic rst_i,
    // pins
    input wire logic rx_i,
    output logic tx_o,
    // to the frame engine
    output logic restart_o,  // event: a break
    output logic received_o,  // event
    output logic [7:0] byte_o,  // with received_o
    input wire logic valid_i,
    input wire logic [7:0] byte_i,
    output logic ready_o  // combinational from registers
);
  if (BreakBits < 8 || BreakBits > 24) begin : gen_wrong_break
    ERROR_BreakBits_must_be_8_to_24 error ();
  end

  // The attribute makes tools place the two side by side, and ignore the timing of the first one's data.
  (* async_reg = "true" *)logic rx_first_q;
  (* async_reg = "true" *)logic rx_second_q;
  logic before_q;
  logic fall;

  always_ff @(posedge clk_i) begin
    rx_first_q <= rx_i;
    rx_second_q <= rx_first_q;
    before_q <= rx_second_q;
    if (rst_i) begin
      rx_first_q  <= 1'b1;
      rx_second_q <= 1'b1;
    end
  end

  assign fall = before_q && !rx_second_q;

  logic        known;
  logic [19:0] period;

  uart_baud #(
      .BreakBits(BreakBits)
  ) baud (
      .clk_i,
      .rst_i,
      .level_i (rx_second_q),
      .fall_i  (fall),
      .restart_o,
      .known_o (known),
      .period_o(period)
  );

  uart_receiver receiver (
      .clk_i,
      .rst_i,
      .level_i (rx_second_q),
      .fall_i  (fall),
      .known_i (known),
      .period_i(period),
      .received_o,
      .byte_o
  );

  uart_transmitter transmitter (
      .clk_i,
      .rst_i,
      .known_i (known),
      .period_i(period),
      .valid_i,
      .byte_i,
      .ready_o,
      .tx_o
  );
endmodule
`default_nettype wire
