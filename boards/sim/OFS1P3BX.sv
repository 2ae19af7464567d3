// Stands for the flip-flop of an ECP5's output pin in simulation; PD makes it 1, whatever the clock does.
`default_nettype none

module OFS1P3BX (
    input  wire logic SCLK,
    input  wire logic SP,
    input  wire logic PD,
    input  wire logic D,
    output logic      Q
);
  always_ff @(posedge SCLK or posedge PD)
    if (PD) Q <= 1'b1;
    else if (SP) Q <= D;
endmodule

`default_nettype wire
