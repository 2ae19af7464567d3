// The serial port with its frame engine: pins to inner port.
`default_nettype none
module uart_frames #(
    parameter int BreakBits = 20
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic rx_i,
    output logic tx_o,
    output logic [register_access_pkg::WIDTH-1:0] access_o,
    input wire logic [register_answer_pkg::WIDTH-1:0] answer_i
);
  logic       restart;
  logic       received;
  logic [7:0] byte_in;
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
      .received_o(received),
      .byte_o(byte_in),
      .valid_i(valid),
      .byte_i(sent),
      .ready_o(ready)
  );

  frame_engine engine (
      .clk_i,
      .rst_i,
      .restart_i(restart),
      .received_i(received),
      .byte_i(byte_in),
      .valid_o(valid),
      .byte_o(sent),
      .ready_i(ready),
      .access_o,
      .answer_i
  );
endmodule
`default_nettype wire
