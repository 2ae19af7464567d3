// iCE40HX8K-B-EVN: the card at 60 MHz behind the board's UART.
// Written by scripts/boards from boards/hx8k/board.toml; edit that.
`default_nettype none

module top_hx8k #(
    parameter logic [31:0] BuildId = 0,
    parameter int BuildDirty = 0
) (
    input wire logic clk_i,
    input wire logic rx_i,
    output logic tx_o,
    input wire logic [7:0] input_i,
    input wire logic emergency_stop_i,
    output logic [3:0] output_o,
    output logic [2:0] step_o,
    output logic [2:0] dir_o
);
  logic clk;
  logic locked;

  board_pll #(
      .Divr(0),
      .Divf(79),
      .Divq(4),
      .FilterRange(1)
  ) pll (
      .crystal_i(clk_i),
      .clk_o(clk),
      .locked_o(locked)
  );

  board_card #(
      .BuildId(BuildId),
      .BuildDirty(BuildDirty),
      .BoardId(32'd1),
      .ClockHz(32'd60000000),
      .ResetBits(10),
      .Axes(3),
      .GeometryDepth(2048),
      .FeedDepth(2560),
      .ArcGenerator(0),
      .PathCommands(1),
      .UnderrunHold(0),
      .Accumulator(0),
      .DirectMode(0),
      .Classes(0),
      .Watermarks(0),
      .MachineInputs(1),
      .EmergencyStop(1),
      .Enables(1),
      .Inputs(8),
      .Outputs(4)
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
endmodule

`default_nettype wire
