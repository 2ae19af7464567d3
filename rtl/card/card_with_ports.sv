// The card with the host ports that its parameters select; with AXI4-Lite alone it equals trammel_card.
`default_nettype none
module card_with_ports #(
    parameter int          Axes              = 4,     // 1 to 8
    parameter int          GeometryDepth     = 4096,  // halfwords, 2 to 32,768
    parameter int          FeedDepth         = 2560,
    parameter int          Accumulator       = 1,     // 0: without arcs and conics
    parameter int          EightDirections   = 0,     // 1: the accumulator's step rule for 8 directions
    parameter int          ArcGenerator      = 0,     // 1: arcs as chords
    parameter int          DirectMode        = 1,     // 0: without direct mode
    parameter int          UnderrunHold      = 1,     // 0: without under-run hold
    parameter int          Classes           = 1,     // 0: one ratio for all pieces
    parameter int          Watermarks        = 1,     // 0: without watermarks
    parameter int          PathCommands      = 0,     // 1: OUTPUT, MARK, WAIT_INPUT, PROBE; inputs and outputs
    parameter int          PositionStreaming = 0,     // 1: for a host that sends one line per period
    parameter int          MachineInputs     = 0,     // 1: filters and roles of inputs; limits, drive faults, feed hold
    parameter int          Captures          = 0,     // 0 to 4 units; with any, the probe's first touch is captured
    parameter int          CaptureFifo       = 0,     // 1: a queue of 16 captures
    parameter int          SoftLimits        = 0,     // 1: each axis's position is compared with its range
    parameter int          EmergencyStop     = 0,     // 1: a pin for the emergency stop
    parameter int          Enables           = 0,     // 1: outputs for drive enable, brake, charge pump, card healthy
    parameter int          Pwm               = 0,     // 1: PWM on two channels of outputs
    parameter int          Inputs            = 4,     // 1 to 32; used with path commands
    parameter int          Outputs           = 4,
    parameter logic [31:0] BuildId           = 0,
    parameter int          BuildDirty        = 0,
    parameter logic [31:0] BoardId           = 0,
    // host ports
    parameter int          AxiLite           = 1,     // 0: without this port
    parameter int          Wishbone          = 0,     // 0: without this port, 1: classic, 2: pipelined
    parameter int          Uart              = 0,     // 0: without this port
    parameter int          Spi               = 0,     // 0: without this port
    parameter int          BreakBits         = 20     // a break on the UART lasts 2^BreakBits clocks, 8 to 24
) (
    input wire logic clk_i,
    input wire logic rst_i,
    // straps
    input wire logic [31:0] clock_hz_i,
    input wire logic [2*Axes-1:0] idle_level_i,  // level before and in reset: {second pins, first pins}
    input wire logic [Outputs-1:0] output_idle_i,  // levels in reset
    input wire logic emergency_stop_level_i,  // level of the pin that means stop
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
    // pins
    input wire logic [Inputs-1:0] input_i,
    input wire logic emergency_stop_i,
    output logic [Outputs-1:0] output_o,
    output logic [Axes-1:0] step_o,
    output logic [Axes-1:0] dir_o,
    output logic irq_o,
    // for lockstep; a board leaves it open
    output logic [observe_pkg::WIDTH+axis_observe_pkg::WIDTH*Axes-1:0] observe_o
);
  // One register delays the reset for all blocks, so it takes effect one clock later. The ports also take the pin
  // itself: AXI and Wishbone require no answer in the first clock after a reset, even if the reset lasts one clock.
  logic rst_q;
  logic port_rst;
  always_ff @(posedge clk_i) rst_q <= rst_i;
  assign port_rst = rst_i || rst_q;

  localparam int PORTS = (AxiLite != 0 ? 1 : 0) + (Wishbone != 0 ? 1 : 0) + (Uart != 0 ? 1 : 0) + (Spi != 0 ? 1 : 0);

  logic [register_access_pkg::WIDTH-1:0] access;
  logic [register_answer_pkg::WIDTH-1:0] answer;

  host_ports #(
      .AxiLite(AxiLite),
      .Wishbone(Wishbone),
      .Uart(Uart),
      .Spi(Spi),
      .BreakBits(BreakBits)
  ) hosts (
      .clk_i,
      .rst_i(port_rst),
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
      .wishbone_i,
      .wishbone_o,
      .rx_i,
      .tx_o,
      .sck_i,
      .cs_n_i,
      .mosi_i,
      .miso_o,
      .miso_enable_o,
      .access_o(access),
      .answer_i(answer)
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
      .MachineInputs(MachineInputs),
      .Captures(Captures),
      .CaptureFifo(CaptureFifo),
      .SoftLimits(SoftLimits),
      .EmergencyStop(EmergencyStop),
      .Enables(Enables),
      .Pwm(Pwm),
      .Inputs(Inputs),
      .Outputs(Outputs),
      .Ports(PORTS),
      .BuildId(BuildId),
      .BuildDirty(BuildDirty),
      .BoardId(BoardId)
  ) core (
      .clk_i,
      .rst_i(rst_q),
      .access_i(access),
      .answer_o(answer),
      .clock_hz_i,
      .idle_level_i,
      .output_idle_i,
      .emergency_stop_level_i,
      .input_i,
      .emergency_stop_i,
      .output_o,
      .step_o,
      .dir_o,
      .irq_o,
      .observe_o
  );
endmodule
`default_nettype wire
