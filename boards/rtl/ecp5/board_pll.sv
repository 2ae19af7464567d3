// The card's clock from the board's crystal (ECP5): its oscillator runs at crystal * FeedbackDiv, and the card's clock is that
// divided by ClockDiv. A first output at the crystal's own frequency is fed back; the phase detector then runs above the 10 MHz
// below which its lock means nothing.
`default_nettype none

module board_pll #(
    parameter int FeedbackDiv = 1,
    parameter int ClockDiv    = 1
) (
    input  wire logic crystal_i,
    output logic      clk_o,
    output logic      locked_o
);
  logic feedback;
  EHXPLLL #(
      .CLKI_DIV    (1),
      .CLKFB_DIV   (1),
      .FEEDBK_PATH ("CLKOP"),
      .CLKOP_ENABLE("ENABLED"),
      .CLKOP_DIV   (FeedbackDiv),
      .CLKOP_CPHASE(FeedbackDiv - 1),
      .CLKOS_ENABLE("ENABLED"),
      .CLKOS_DIV   (ClockDiv),
      .CLKOS_CPHASE(ClockDiv - 1)
  ) pll (
      .CLKI        (crystal_i),
      .CLKFB       (feedback),
      .CLKOP       (feedback),
      .CLKOS       (clk_o),
      .LOCK        (locked_o),
      .PHASESEL0   (1'b0),
      .PHASESEL1   (1'b0),
      .PHASEDIR    (1'b0),
      .PHASESTEP   (1'b0),
      .PHASELOADREG(1'b0),
      .STDBY       (1'b0),
      .PLLWAKESYNC (1'b0),
      .RST         (1'b0),
      .ENCLKOP     (1'b1),
      .ENCLKOS     (1'b1),
      .ENCLKOS2    (1'b0),
      .ENCLKOS3    (1'b0)
  );
endmodule

`default_nettype wire
