// The card's clock from the board's crystal (iCE40): crystal * (Divf + 1) / ((Divr + 1) * 2^Divq).
`default_nettype none

module board_pll #(
    parameter logic [3:0] Divr        = 0,
    parameter logic [6:0] Divf        = 0,
    parameter logic [2:0] Divq        = 0,
    parameter logic [2:0] FilterRange = 1
) (
    input  wire logic crystal_i,
    output logic      clk_o,
    output logic      locked_o
);
  SB_PLL40_CORE #(
      .FEEDBACK_PATH("SIMPLE"),
      .DIVR         (Divr),
      .DIVF         (Divf),
      .DIVQ         (Divq),
      .FILTER_RANGE (FilterRange)
  ) pll (
      .REFERENCECLK(crystal_i),
      .PLLOUTGLOBAL(clk_o),
      .LOCK        (locked_o),
      .RESETB      (1'b1),
      .BYPASS      (1'b0)
  );
endmodule

`default_nettype wire
