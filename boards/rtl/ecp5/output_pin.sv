// An output from the flip-flop in the pin (ECP5): idle in reset, clock or none.
`default_nettype none

module output_pin #(
    parameter logic Idle = 0
) (
    input  wire logic clk_i,
    input  wire logic rst_i,
    input  wire logic level_i,
    output logic      pin_o
);
  if (Idle) begin : gen_high
    OFS1P3BX flip_flop (
        .SCLK(clk_i),
        .SP  (1'b1),
        .PD  (rst_i),
        .D   (level_i),
        .Q   (pin_o)
    );
  end else begin : gen_low
    OFS1P3DX flip_flop (
        .SCLK(clk_i),
        .SP  (1'b1),
        .CD  (rst_i),
        .D   (level_i),
        .Q   (pin_o)
    );
  end
endmodule

`default_nettype wire
