// The serial port with its frame engine: pins to inner port.
`default_nettype none
module uart_frames #(
    parameter int BreakBits = 20
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic rx_i,
    output logic tx_o,
    output logic [47:0] access_o,
    input wire logic ack_i,
    input wire logic error_i,
    input wire logic [31:0] data_i
);
  logic       restart;
  logic [8:0] received;
  logic       valid;
  logic [7:0] sent;
  logic       ready;

  uart_port #(
      .BreakBits(BreakBits)
  ) port (
      .clk_i,
      .rst_i,
      .rx_i,
      .tx_o,
      .restart_o(restart),
      .byte_o(received),
      .valid_i(valid),
      .byte_i(sent),
      .ready_o(ready)
  );

  frame_engine engine (
      .clk_i,
      .rst_i,
      .restart_i(restart),
      .byte_i(received),
      .valid_o(valid),
      .byte_o(sent),
      .ready_i(ready),
      .access_o,
      .ack_i,
      .error_i,
      .data_i
  );
endmodule
`default_nettype wire
