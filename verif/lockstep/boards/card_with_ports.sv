// Replaces the card behind a board's pins. Its pins are idle in reset, and then follow the inputs
// and the serial line. The outputs also follow the emergency stop, without a clock.
`default_nettype none
module card_with_ports #(
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
    parameter int          AxiLite           = 1,
    parameter int          Uart              = 0
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [31:0] clock_hz_i,
    input wire logic [2*Axes-1:0] idle_level_i,
    input wire logic [Outputs-1:0] output_idle_i,
    input wire logic emergency_stop_level_i,
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
    input wire logic [wishbone_request_pkg::WIDTH-1:0] wishbone_i,
    output logic [wishbone_answer_pkg::WIDTH-1:0] wishbone_o,
    input wire logic rx_i,
    output logic tx_o,
    input wire logic sck_i,
    input wire logic cs_n_i,
    input wire logic mosi_i,
    output logic miso_o,
    output logic miso_enable_o,
    input wire logic [Inputs-1:0] input_i,
    input wire logic emergency_stop_i,
    output logic [Outputs-1:0] output_o,
    output logic [Axes-1:0] step_o,
    output logic [Axes-1:0] dir_o,
    output logic irq_o,
    output logic [observe_pkg::WIDTH+axis_observe_pkg::WIDTH*Axes-1:0] observe_o
);
  // The identification is sent on the serial line, one bit per clock after the reset: no other
  // signal of a board's top shows it.
  localparam logic [31:0] WHO = BoardId ^ {26'd0, Uart != 0, AxiLite == 0, PathCommands != 0, 3'd0};
  logic [63:0] told_q;
  logic [Outputs-1:0] output_q;

  assign output_o = output_q ^ {Outputs{emergency_stop_i}};

  always_ff @(posedge clk_i) begin
    step_o   <= Axes'(input_i);
    dir_o    <= ~Axes'(input_i);
    output_q <= {Outputs{rx_i}} ^ Outputs'(input_i) ^ Outputs'(input_i >> Outputs);
    told_q   <= {told_q[62:0], rx_i};
    if (rst_i) begin
      {dir_o, step_o} <= idle_level_i;
      output_q <= output_idle_i;
      told_q <= {WHO ^ {25'd0, emergency_stop_level_i, 6'd0}, clock_hz_i};
    end
  end
  assign tx_o = told_q[63];
endmodule
`default_nettype wire
