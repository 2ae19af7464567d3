// Stands for the flip-flop of an ECP5's output pin in simulation; CD makes it 0, whatever the clock does.
`default_nettype none

module OFS1P3DX (
    input  wire logic SCLK,
    input  wire logic SP,
    input  wire logic CD,
    input  wire logic D,
    output logic      Q
);
  always_ff @(posedge SCLK or posedge CD)
    if (CD) Q <= 1'b0;
    else if (SP) Q <= D;
endmodule

`default_nettype wire
