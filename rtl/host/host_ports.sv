// The host ports that a card is built with, any of four side by side, joined to its inner port. One that is not built is not
// looked at, and its outputs stand still.
`default_nettype none
module host_ports #(
    parameter int AxiLite   = 1,  // 0: without
    parameter int Wishbone  = 0,  // 1: classic, 2: pipelined
    parameter int Uart      = 0,  // 1: with
    parameter int Spi       = 0,  // 1: with
    parameter int BreakBits = 20  // of the UART: a break is 2^BreakBits clocks, 8 to 24
) (
    input wire logic clk_i,
    input wire logic rst_i,
    // AXI4-Lite
    input wire logic awvalid_i,
    output logic awready_o,
    input wire logic [11:0] awaddr_i,
    input wire logic wvalid_i,
    output logic wready_o,
    input wire logic [31:0] wdata_i,
    input wire logic [3:0] wstrb_i,
    output logic bvalid_o,
    input wire logic bready_i,
    output logic [1:0] bresp_o,
    input wire logic arvalid_i,
    output logic arready_o,
    input wire logic [11:0] araddr_i,
    output logic rvalid_o,
    input wire logic rready_i,
    output logic [31:0] rdata_o,
    output logic [1:0] rresp_o,
    // Wishbone B4: {CYC, STB, WE, SEL, ADR, DAT}, {ACK, ERR, STALL, DAT}
    input wire logic [50:0] wishbone_i,
    output logic [34:0] wishbone_o,
    // UART
    input wire logic rx_i,
    output logic tx_o,
    // SPI: {MOSI, CS low active, SCK}, {enable, MISO}
    input wire logic [2:0] spi_i,
    output logic [1:0] spi_o,
    // to the inner port
    output logic request_o,
    output logic [47:0] access_o,  // {port, write, partial, address, data}
    input wire logic ack_i,
    input wire logic error_i,
    input wire logic [31:0] data_i
);
  // Ports in the order in which they stand above: the number of each is how many are before it.
  localparam int WISHBONE = AxiLite != 0 ? 1 : 0;
  localparam int UART = WISHBONE + (Wishbone != 0 ? 1 : 0);
  localparam int SPI = UART + (Uart != 0 ? 1 : 0);
  localparam int PORTS = SPI + (Spi != 0 ? 1 : 0);

  if (PORTS == 0) begin : gen_no_port
    ERROR_a_card_needs_a_host_port error ();
  end

  logic [48*PORTS-1:0] access;
  logic [   PORTS-1:0] ack;
  logic                error;
  logic [        31:0] data;

  port_arbiter #(
      .Ports(PORTS)
  ) arbiter (
      .clk_i,
      .rst_i,
      .access_i(access),
      .ack_o(ack),
      .error_o(error),
      .data_o(data),
      .request_o,
      .access_o,
      .ack_i,
      .error_i,
      .data_i
  );

  if (AxiLite != 0) begin : gen_axi
    axi4_lite_port port (
        .clk_i,
        .rst_i,
        .awvalid_i,
        .awready_o,
        .awaddr_i,
        .wvalid_i,
        .wready_o,
        .wdata_i,
        .wstrb_i,
        .bvalid_o,
        .bready_i,
        .bresp_o,
        .arvalid_i,
        .arready_o,
        .araddr_i,
        .rvalid_o,
        .rready_i,
        .rdata_o,
        .rresp_o,
        .access_o(access[0+:48]),
        .ack_i(ack[0]),
        .error_i(error),
        .data_i(data)
    );
  end else begin : gen_no_axi
    logic unused;
    assign unused = &{1'b0, awvalid_i, awaddr_i, wvalid_i, wdata_i, wstrb_i, bready_i, arvalid_i, araddr_i, rready_i};
    assign {awready_o, wready_o, bvalid_o, bresp_o, arready_o, rvalid_o, rdata_o, rresp_o} = '0;
  end

  if (Wishbone != 0) begin : gen_wishbone
    wishbone_port #(
        .Pipelined(Wishbone == 2 ? 1 : 0)
    ) port (
        .clk_i,
        .rst_i,
        .cyc_i(wishbone_i[50]),
        .stb_i(wishbone_i[49]),
        .we_i(wishbone_i[48]),
        .sel_i(wishbone_i[47:44]),
        .adr_i(wishbone_i[43:32]),
        .dat_i(wishbone_i[31:0]),
        .ack_o(wishbone_o[34]),
        .err_o(wishbone_o[33]),
        .stall_o(wishbone_o[32]),
        .dat_o(wishbone_o[31:0]),
        .access_o(access[48*WISHBONE+:48]),
        .ack_i(ack[WISHBONE]),
        .error_i(error),
        .data_i(data)
    );
  end else begin : gen_no_wishbone
    logic unused;
    assign unused = &{1'b0, wishbone_i};
    assign wishbone_o = '0;
  end

  if (Uart != 0) begin : gen_uart
    uart_frames #(
        .BreakBits(BreakBits)
    ) port (
        .clk_i,
        .rst_i,
        .rx_i,
        .tx_o,
        .access_o(access[48*UART+:48]),
        .ack_i(ack[UART]),
        .error_i(error),
        .data_i(data)
    );
  end else begin : gen_no_uart
    logic unused;
    assign unused = &{1'b0, rx_i};
    assign tx_o   = 1'b1;
  end

  if (Spi != 0) begin : gen_spi
    spi_frames port (
        .clk_i,
        .rst_i,
        .mosi_i(spi_i[2]),
        .cs_n_i(spi_i[1]),
        .sck_i(spi_i[0]),
        .miso_enable_o(spi_o[1]),
        .miso_o(spi_o[0]),
        .access_o(access[48*SPI+:48]),
        .ack_i(ack[SPI]),
        .error_i(error),
        .data_i(data)
    );
  end else begin : gen_no_spi
    logic unused;
    assign unused = &{1'b0, spi_i};
    assign spi_o  = 2'b00;
  end
endmodule
`default_nettype wire
