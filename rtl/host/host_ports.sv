// The host ports that a card is built with, any of the four, joined to its inner port. The inputs of a port that is not
// built are ignored; its outputs are constant.
`default_nettype none
module host_ports #(
    parameter int AxiLite   = 1,  // 0: without this port
    parameter int Wishbone  = 0,  // 0: without this port, 1: classic, 2: pipelined
    parameter int Uart      = 0,  // 0: without this port
    parameter int Spi       = 0,  // 0: without this port
    parameter int BreakBits = 20  // a break on the UART lasts 2^BreakBits clocks, 8 to 24
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
    // Wishbone B4
    input wire logic [wishbone_request_pkg::WIDTH-1:0] wishbone_i,
    output logic [wishbone_answer_pkg::WIDTH-1:0] wishbone_o,
    // UART
    input wire logic rx_i,
    output logic tx_o,
    // SPI
    input wire logic sck_i,
    input wire logic cs_n_i,
    input wire logic mosi_i,
    output logic miso_o,
    output logic miso_enable_o,  // low: another device may drive MISO
    // to the inner port
    output logic [register_access_pkg::WIDTH-1:0] access_o,
    input wire logic [register_answer_pkg::WIDTH-1:0] answer_i
);
  // Ports are numbered in the order above: the number of a port is the number of ports before it.
  localparam int WISHBONE = AxiLite != 0 ? 1 : 0;
  localparam int UART = WISHBONE + (Wishbone != 0 ? 1 : 0);
  localparam int SPI = UART + (Uart != 0 ? 1 : 0);
  localparam int PORTS = SPI + (Spi != 0 ? 1 : 0);

  if (AxiLite < 0 || AxiLite > 1 || Uart < 0 || Uart > 1 || Spi < 0 || Spi > 1) begin : gen_wrong_port
    ERROR_AxiLite_Uart_and_Spi_must_be_0_or_1 error ();
  end
  if (Wishbone < 0 || Wishbone > 2) begin : gen_wrong_wishbone
    ERROR_Wishbone_must_be_0_to_2 error ();
  end
  if (PORTS == 0) begin : gen_no_port
    ERROR_a_card_needs_a_host_port error ();
  end

  localparam int ACCESS = register_access_pkg::WIDTH;
  localparam int ANSWER = register_answer_pkg::WIDTH;

  logic [ACCESS*PORTS-1:0] access;
  logic [ANSWER*PORTS-1:0] answer;

  port_arbiter #(
      .Ports(PORTS)
  ) arbiter (
      .clk_i,
      .rst_i,
      .access_i(access),
      .answer_o(answer),
      .access_o,
      .answer_i
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
        .access_o(access[0+:ACCESS]),
        .answer_i(answer[0+:ANSWER])
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
        .cyc_i(wishbone_i[wishbone_request_pkg::CYC]),
        .stb_i(wishbone_i[wishbone_request_pkg::STB]),
        .we_i(wishbone_i[wishbone_request_pkg::WE]),
        .adr_i(wishbone_request_pkg::adr(wishbone_i)),
        .sel_i(wishbone_request_pkg::sel(wishbone_i)),
        .dat_i(wishbone_request_pkg::dat(wishbone_i)),
        .dat_o(wishbone_o[wishbone_answer_pkg::DAT+:32]),
        .ack_o(wishbone_o[wishbone_answer_pkg::ACK]),
        .err_o(wishbone_o[wishbone_answer_pkg::ERR]),
        .stall_o(wishbone_o[wishbone_answer_pkg::STALL]),
        .access_o(access[ACCESS*WISHBONE+:ACCESS]),
        .answer_i(answer[ANSWER*WISHBONE+:ANSWER])
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
        .access_o(access[ACCESS*UART+:ACCESS]),
        .answer_i(answer[ANSWER*UART+:ANSWER])
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
        .sck_i,
        .cs_n_i,
        .mosi_i,
        .miso_o,
        .miso_enable_o,
        .access_o(access[ACCESS*SPI+:ACCESS]),
        .answer_i(answer[ANSWER*SPI+:ANSWER])
    );
  end else begin : gen_no_spi
    logic unused;
    assign unused = &{1'b0, sck_i, cs_n_i, mosi_i};
    assign {miso_o, miso_enable_o} = '0;
  end
endmodule
`default_nettype wire
