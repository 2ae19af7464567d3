// The checkers of a card's host ports: pins of card_with_ports in, broken rules out by port_rule_broken().
`default_nettype none
module port_checkers #(
    parameter int BreakBits = 20
) (
    input wire logic clk_i,
    input wire logic rst_i,
    // straps: Wishbone is pipelined; clocks per 8 bits of the serial line, 0: unknown
    input wire logic pipelined_i,
    input wire logic [19:0] period_i,
    // AXI4-Lite
    input wire logic awvalid_i,
    input wire logic awready_i,
    input wire logic [11:0] awaddr_i,
    input wire logic wvalid_i,
    input wire logic wready_i,
    input wire logic [31:0] wdata_i,
    input wire logic [3:0] wstrb_i,
    input wire logic bvalid_i,
    input wire logic bready_i,
    input wire logic [1:0] bresp_i,
    input wire logic arvalid_i,
    input wire logic arready_i,
    input wire logic [11:0] araddr_i,
    input wire logic rvalid_i,
    input wire logic rready_i,
    input wire logic [31:0] rdata_i,
    input wire logic [1:0] rresp_i,
    // Wishbone {CYC, STB, WE, SEL, ADR, DAT}, {ACK, ERR, STALL}; serial line; SPI {MOSI, CS, SCK}, {MISO's enable, MISO}
    input wire logic [50:0] wishbone_master_i,
    input wire logic [2:0] wishbone_card_i,
    input wire logic rx_i,
    input wire logic tx_i,
    input wire logic [2:0] spi_master_i,
    input wire logic [1:0] spi_card_i
);
  axi4_lite_checker axi4_lite (.*);
  wishbone_checker wishbone (
      .clk_i,
      .rst_i,
      .pipelined_i,
      .master_i(wishbone_master_i),
      .card_i  (wishbone_card_i)
  );
  uart_checker #(.BreakBits(BreakBits)) uart (.*);
  spi_checker spi (
      .clk_i,
      .rst_i,
      .master_i(spi_master_i),
      .card_i  (spi_card_i)
  );
endmodule
`default_nettype wire
