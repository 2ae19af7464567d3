// ULX3S 25F: the card at 70 MHz behind the board's UART.
// Written by scripts/boards from boards/ulx3s/board.toml; edit that.
`default_nettype none

module top_ulx3s #(
    parameter logic [31:0] BuildId = 0,
    parameter int BuildDirty = 0
) (
    input wire logic clk_i,
    input wire logic rx_i,
    output logic tx_o,
    input wire logic [15:0] input_i,
    input wire logic emergency_stop_i,
    output logic [7:0] output_o,
    output logic [3:0] step_o,
    output logic [3:0] dir_o,
    output logic wifi_gpio0_o
);
  logic clk;
  logic locked;

  board_pll #(
      .FeedbackDiv(28),
      .ClockDiv(10)
  ) pll (
      .crystal_i(clk_i),
      .clk_o(clk),
      .locked_o(locked)
  );

  board_card #(
      .BuildId(BuildId),
      .BuildDirty(BuildDirty),
      .BoardId(32'd2),
      .ClockHz(32'd70000000),
      .ResetBits(11),
      .Axes(4),
      .GeometryDepth(16384),
      .FeedDepth(10240),
      .EightDirections(1),
      .ArcGenerator(1),
      .PathCommands(1),
      .PositionStreaming(1),
      .MachineInputs(1),
      .Captures(4),
      .CaptureFifo(1),
      .SoftLimits(1),
      .EmergencyStop(1),
      .Enables(1),
      .Pwm(1),
      .Inputs(16),
      .Outputs(8)
  ) card (
      .clk_i(clk),
      .locked_i(locked),
      .rx_i,
      .tx_o,
      .input_i,
      .emergency_stop_i,
      .output_o,
      .step_o,
      .dir_o
  );

  assign wifi_gpio0_o = 1'b1;
endmodule

`default_nettype wire
