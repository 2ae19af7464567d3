// Stands for the ECP5's PLL in simulation: the reference is the card's clock already, and locked after eight of its clocks.
`default_nettype none

module EHXPLLL #(
    parameter int CLKI_DIV = 1,
    parameter int CLKFB_DIV = 1,
    parameter FEEDBK_PATH = "CLKOP",
    parameter CLKOP_ENABLE = "ENABLED",
    parameter int CLKOP_DIV = 8,
    parameter int CLKOP_CPHASE = 0,
    parameter CLKOS_ENABLE = "ENABLED",
    parameter int CLKOS_DIV = 8,
    parameter int CLKOS_CPHASE = 0
) (
    input  wire logic CLKI,
    input  wire logic CLKFB,
    input  wire logic PHASESEL0,
    input  wire logic PHASESEL1,
    input  wire logic PHASEDIR,
    input  wire logic PHASESTEP,
    input  wire logic PHASELOADREG,
    input  wire logic STDBY,
    input  wire logic PLLWAKESYNC,
    input  wire logic RST,
    input  wire logic ENCLKOP,
    input  wire logic ENCLKOS,
    input  wire logic ENCLKOS2,
    input  wire logic ENCLKOS3,
    output logic      CLKOP,
    output logic      CLKOS,
    output logic      LOCK
);
  logic [3:0] count_q = '0;
  always_ff @(posedge CLKI) if (!count_q[3]) count_q <= count_q + 4'd1;

  assign CLKOP = CLKI;
  assign CLKOS = CLKI;
  assign LOCK  = count_q[3];

  logic unused;
  assign unused = &{1'b0, CLKFB, PHASESEL0, PHASESEL1, PHASEDIR, PHASESTEP, PHASELOADREG, STDBY, PLLWAKESYNC, RST,
                    ENCLKOP, ENCLKOS, ENCLKOS2, ENCLKOS3, FEEDBK_PATH, CLKOP_ENABLE, CLKOS_ENABLE, CLKI_DIV, CLKFB_DIV,
                    CLKOP_DIV, CLKOP_CPHASE, CLKOS_DIV, CLKOS_CPHASE};
endmodule

`default_nettype wire
