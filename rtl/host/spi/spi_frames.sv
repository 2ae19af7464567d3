// The SPI port with its frame engine: pins to inner port.
`default_nettype none
module spi_frames (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic sck_i,
    input wire logic cs_n_i,
    input wire logic mosi_i,
    output logic miso_o,
    output logic miso_enable_o,
    output logic [register_access_pkg::WIDTH-1:0] access_o,
    input wire logic [register_answer_pkg::WIDTH-1:0] answer_i
);
  logic       received;
  logic [7:0] byte_in;
  logic       valid;
  logic [7:0] sent;
  logic       ready;

  spi_port port (
      .clk_i,
      .rst_i,
      .sck_i,
      .cs_n_i,
      .mosi_i,
      .miso_o,
      .miso_enable_o,
      .received_o(received),
      .byte_o(byte_in),
      .valid_i(valid),
      .byte_i(sent),
      .ready_o(ready)
  );

  frame_engine engine (
      .clk_i,
      .rst_i,
      .restart_i(1'b0),
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
