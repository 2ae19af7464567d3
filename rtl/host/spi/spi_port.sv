// An SPI slave, modes 0 and 3, highest bit first: bytes to and from the frame engine. The card's clock samples all
// inputs; a period of SCK has at least four of its clocks.
//
// In both modes bits are taken at SCK's rising edge. MISO's next bit is launched at the same edge, as soon as it is
// seen: 2 to 3 clocks later. Waiting for the falling edge, as a slave clocked by SCK would, leaves a fast master no
// time.
`default_nettype none
module spi_port (
    input wire logic clk_i,
    input wire logic rst_i,
    // pins
    input wire logic sck_i,
    input wire logic cs_n_i,
    input wire logic mosi_i,
    output logic miso_o,
    output logic miso_enable_o,  // low: another device may drive MISO
    // to the frame engine
    output logic received_o,  // event
    output logic [7:0] byte_o,  // with received_o
    input wire logic valid_i,
    input wire logic [7:0] byte_i,
    output logic ready_o  // event; combinational from registers
);
  // The byte that is sent while there is no reply.
  localparam logic [7:0] END = 8'hC0;

  // {MOSI, CS, SCK}. The attribute makes tools place the two side by side, and ignore the timing of the first one's
  // data.
  (* async_reg = "true" *) logic [2:0] first_q;
  (* async_reg = "true" *) logic [2:0] second_q;
  logic sck_before_q;

  always_ff @(posedge clk_i) begin
    first_q <= {mosi_i, cs_n_i, sck_i};
    second_q <= first_q;
    sck_before_q <= second_q[0];
    if (rst_i) begin
      // Not selected, so that nothing is taken until the levels of the pins have come through.
      first_q  <= '1;
      second_q <= '1;
    end
  end

  logic [2:0] bit_q;  // bit of the byte under way
  logic [6:0] in_q;
  logic [7:0] out_q;
  logic       rise;
  logic       whole;

  assign rise = second_q[0] && !sck_before_q && !second_q[1];
  assign whole = rise && bit_q == 3'd7;
  assign ready_o = whole;
  assign miso_o = out_q[7];

  always_ff @(posedge clk_i) begin
    received_o <= whole;
    byte_o <= {in_q, second_q[2]};
    miso_enable_o <= !second_q[1];
    if (rise) begin
      bit_q <= bit_q + 3'd1;
      in_q  <= {in_q[5:0], second_q[2]};
      out_q <= whole ? (valid_i ? byte_i : END) : {out_q[6:0], 1'b0};
    end
    // Bytes begin with the selection. A byte that was loaded when the selection ended is sent in the next one.
    if (second_q[1]) bit_q <= 3'd0;
    if (rst_i) begin
      out_q <= END;
      received_o <= 1'b0;
      miso_enable_o <= 1'b0;
    end
  end
endmodule
`default_nettype wire
