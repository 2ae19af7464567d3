// An output from the flip-flop in the pin (iCE40): idle in reset. That flip-flop has no reset of its own, and begins at 0; for a pin that
// idles high the pin inverts it.
`default_nettype none

module output_pin #(
    parameter logic Idle = 0
) (
    input  wire logic clk_i,
    input  wire logic rst_i,
    input  wire logic level_i,
    output logic      pin_o
);
  SB_IO #(
      .PIN_TYPE(Idle ? 6'b01_11_01 : 6'b01_01_01)  // output from the flip-flop, inverted or not
  ) pin (
      .PACKAGE_PIN(pin_o),
      .OUTPUT_CLK (clk_i),
      .D_OUT_0    ((level_i ^ Idle) && !rst_i)
  );
endmodule

`default_nettype wire
