// A card on a board: its reset from the PLL's lock, its UART as only host port, STEP and DIR from flip-flops that lie in the pins.
// The emergency stop's pin reaches its latch, and the latch the outputs, without a clock: no flip-flop of the board's stands there.
`default_nettype none

module board_card #(
    parameter int          Axes              = 4,
    parameter int          GeometryDepth     = 4096,
    parameter int          FeedDepth         = 2560,
    parameter int          Accumulator       = 1,
    parameter int          EightDirections   = 0,
    parameter int          ArcGenerator      = 0,
    parameter int          DirectMode        = 1,
    parameter int          UnderrunHold      = 1,
    parameter int          Classes           = 1,
    parameter int          Watermarks        = 1,
    parameter int          PathCommands      = 0,
    parameter int          PositionStreaming = 0,
    parameter int          MachineInputs     = 0,
    parameter int          Captures          = 0,
    parameter int          CaptureFifo       = 0,
    parameter int          SoftLimits        = 0,
    parameter int          EmergencyStop     = 0,
    parameter int          Enables           = 0,
    parameter int          Pwm               = 0,
    parameter int          Inputs            = 4,
    parameter int          Outputs           = 4,
    parameter logic [31:0] BuildId           = 0,
    parameter int          BuildDirty        = 0,
    parameter logic [31:0] BoardId           = 0,
    parameter logic [31:0] ClockHz           = 0,
    parameter int          ResetBits         = 11,    // 2^ResetBits clocks from lock to the reset's end
    // levels while nothing happens, a bit a pin
    parameter int          StepIdle          = 0,
    parameter int          DirIdle           = 0,
    parameter int          OutputIdle        = 0
) (
    input  wire logic               clk_i,
    input  wire logic               locked_i,
    input  wire logic               rx_i,
    output logic                    tx_o,
    input  wire logic [ Inputs-1:0] input_i,
    input  wire logic               emergency_stop_i,  // high is stop: an open wire with a pull-up
    output logic      [Outputs-1:0] output_o,
    output logic      [   Axes-1:0] step_o,
    output logic      [   Axes-1:0] dir_o
);
  logic rst;
  reset_synchroniser #(
      .Bits(ResetBits)
  ) reset (
      .clk_i,
      .locked_i,
      .rst_o(rst)
  );

  logic [Axes-1:0] step;
  logic [Axes-1:0] dir;
  logic [Outputs-1:0] level;

  card_with_ports #(
      .Axes(Axes),
      .GeometryDepth(GeometryDepth),
      .FeedDepth(FeedDepth),
      .Accumulator(Accumulator),
      .EightDirections(EightDirections),
      .ArcGenerator(ArcGenerator),
      .DirectMode(DirectMode),
      .UnderrunHold(UnderrunHold),
      .Classes(Classes),
      .Watermarks(Watermarks),
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
      .BuildId(BuildId),
      .BuildDirty(BuildDirty),
      .BoardId(BoardId),
      .AxiLite(0),
      .Uart(1)
  ) card (
      .clk_i,
      .rst_i(rst),
      .clock_hz_i(ClockHz),
      .idle_level_i({DirIdle[Axes-1:0], StepIdle[Axes-1:0]}),
      .output_idle_i(OutputIdle[Outputs-1:0]),
      .emergency_stop_level_i(1'b1),
      .awvalid_i(1'b0),
      .awready_o(),
      .awaddr_i(12'd0),
      .wvalid_i(1'b0),
      .wready_o(),
      .wdata_i(32'd0),
      .wstrb_i(4'd0),
      .bvalid_o(),
      .bready_i(1'b0),
      .bresp_o(),
      .arvalid_i(1'b0),
      .arready_o(),
      .araddr_i(12'd0),
      .rvalid_o(),
      .rready_i(1'b0),
      .rdata_o(),
      .rresp_o(),
      .wishbone_i('0),
      .wishbone_o(),
      .rx_i,
      .tx_o,
      .sck_i(1'b0),
      .cs_n_i(1'b1),
      .mosi_i(1'b0),
      .miso_o(),
      .miso_enable_o(),
      .input_i,
      .emergency_stop_i,
      .output_o(level),
      .step_o(step),
      .dir_o(dir),
      .irq_o(),
      .observe_o()
  );

  for (genvar i = 0; i < Axes; i++) begin : gen_axis
    output_pin #(
        .Idle(StepIdle[i])
    ) step_pin (
        .clk_i,
        .rst_i  (rst),
        .level_i(step[i]),
        .pin_o  (step_o[i])
    );
    output_pin #(
        .Idle(DirIdle[i])
    ) dir_pin (
        .clk_i,
        .rst_i  (rst),
        .level_i(dir[i]),
        .pin_o  (dir_o[i])
    );
  end
  assign output_o = rst ? OutputIdle[Outputs-1:0] : level;
endmodule

`default_nettype wire
