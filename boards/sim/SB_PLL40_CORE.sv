// Stands for the iCE40's PLL in simulation: the reference is the card's clock already, and locked after eight of its clocks.
`default_nettype none

module SB_PLL40_CORE #(
    parameter FEEDBACK_PATH = "SIMPLE",
    parameter logic [3:0] DIVR = 0,
    parameter logic [6:0] DIVF = 0,
    parameter logic [2:0] DIVQ = 0,
    parameter logic [2:0] FILTER_RANGE = 0
) (
    input  wire logic REFERENCECLK,
    input  wire logic RESETB,
    input  wire logic BYPASS,
    output logic      PLLOUTGLOBAL,
    output logic      LOCK
);
  logic [3:0] count_q = '0;
  always_ff @(posedge REFERENCECLK) if (!count_q[3]) count_q <= count_q + 4'd1;

  assign PLLOUTGLOBAL = REFERENCECLK;
  assign LOCK = count_q[3];

  logic unused;
  assign unused = &{1'b0, RESETB, BYPASS, FEEDBACK_PATH, DIVR, DIVF, DIVQ, FILTER_RANGE};
endmodule

`default_nettype wire
