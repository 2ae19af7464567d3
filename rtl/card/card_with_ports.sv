// The card behind the host ports that it is built with; with AXI4-Lite alone it is trammel_card.
`default_nettype none
module card_with_ports #(
    parameter int          Axes              = 4,     // 1 to 8
    parameter int          GeometryDepth     = 4096,  // halfwords, 2 to 32,768
    parameter int          FeedDepth         = 2560,
    parameter int          Accumulator       = 1,     // 0: without arcs and conics
    parameter int          EightDirections   = 0,     // 1: the accumulator's second step rule
    parameter int          ArcGenerator      = 0,     // 1: arcs in chords
    parameter int          DirectMode        = 1,     // 0: without
    parameter int          UnderrunHold      = 1,     // 0: without
    parameter int          Classes           = 1,     // 0: one ratio for all pieces
    parameter int          Watermarks        = 1,     // 0: without
    parameter int          PathCommands      = 0,     // 1: OUTPUT, MARK, WAIT_INPUT, PROBE; inputs and outputs
    parameter int          PositionStreaming = 0,     // 1: for a host that sends a line each period
    parameter int          Inputs            = 4,     // 1 to 16, of a card with path commands
    parameter int          Outputs           = 4,
    parameter logic [31:0] BuildId           = 0,
    parameter int          BuildDirty        = 0,
    parameter logic [31:0] BoardId           = 0,
    // host ports
    parameter int          AxiLite           = 1,     // 1: with
    parameter int          Wishbone          = 0,     // 1: classic, 2: pipelined
    parameter int          Uart              = 0,     // 1: with
    parameter int          Spi               = 0,     // 1: with
    parameter int          BreakBits         = 20     // of the UART: a break is 2^BreakBits clocks, 8 to 24
) (
    input wire logic clk_i,
    input wire logic rst_i,
    // straps
    input wire logic [31:0] clock_hz_i,
    input wire logic [2*Axes-1:0] idle_level_i,  // {second pins, first pins}
    input wire logic [Outputs-1:0] output_idle_i,  // levels in reset
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
    // pins
    input wire logic [Inputs-1:0] input_i,
    output logic [Outputs-1:0] output_o,
    output logic [Axes-1:0] step_o,
    output logic [Axes-1:0] dir_o,
    output logic irq_o,
    // for lockstep; a board leaves it open
    output logic [34*Axes+212:0] observe_o
);
  // The reset is registered once for all blocks: it takes effect a clock later. The ports take the pin as
  // well: AXI and Wishbone want no answer in the first clock after a reset, even of one clock.
  logic rst_q;
  logic port_rst;
  always_ff @(posedge clk_i) rst_q <= rst_i;
  assign port_rst = rst_i || rst_q;

  localparam int PORTS = (AxiLite != 0 ? 1 : 0) + (Wishbone != 0 ? 1 : 0) + (Uart != 0 ? 1 : 0) + (Spi != 0 ? 1 : 0);

  logic        request;
  logic [47:0] access;  // {port, write, partial, address, data}
  logic        ack;
  logic        error;
  logic [31:0] data;

  host_ports #(
      .AxiLite(AxiLite),
      .Wishbone(Wishbone),
      .Uart(Uart),
      .Spi(Spi),
      .BreakBits(BreakBits)
  ) hosts (
      .*,
      .rst_i    (port_rst),
      .request_o(request),
      .access_o (access),
      .ack_i    (ack),
      .error_i  (error),
      .data_i   (data)
  );

  card_core #(
      .Axes(Axes),
      .GeometryDepth(GeometryDepth),
      .FeedDepth(FeedDepth),
      .Accumulator(Accumulator),
      .EightDirections(EightDirections),
      .ArcGenerator(ArcGenerator),
      .Classes(Classes),
      .Watermarks(Watermarks),
      .DirectMode(DirectMode),
      .UnderrunHold(UnderrunHold),
      .PathCommands(PathCommands),
      .PositionStreaming(PositionStreaming),
      .Inputs(Inputs),
      .Outputs(Outputs),
      .Ports(PORTS),
      .BuildId(BuildId),
      .BuildDirty(BuildDirty),
      .BoardId(BoardId)
  ) core (
      .*,
      .rst_i    (rst_q),
      .request_i(request),
      .port_i   (access[47:46]),
      .write_i  (access[45]),
      .partial_i(access[44]),
      .address_i(access[43:32]),
      .data_i   (access[31:0]),
      .ack_o    (ack),
      .error_o  (error),
      .data_o   (data)
  );
endmodule
`default_nettype wire
