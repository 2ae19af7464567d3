// The card's reset from the PLL's lock: it comes at once, clock or none, and ends with the clock, 2^Bits clocks after the lock has
// been seen. Every flip-flop begins at 0 on the devices, which is in reset: so the card is in reset from configuration on.
`default_nettype none

module reset_synchroniser #(
    parameter int Bits = 11  // of the count: 2^Bits clocks
) (
    input  wire logic clk_i,
    input  wire logic locked_i,  // at any time
    output logic      rst_o
);
  // Marked, so that tools place the two side by side and know that the first one's clear has no timing.
  (* async_reg = "true" *) logic first_q;
  (* async_reg = "true" *) logic second_q;
  logic [Bits:0] count_q;

  // What follows the first two only keeps its value until they are over: the end of the clear cannot upset it.
  always_ff @(posedge clk_i or negedge locked_i)
    if (!locked_i) begin
      first_q  <= 1'b0;
      second_q <= 1'b0;
      count_q  <= '0;
    end else begin
      first_q  <= 1'b1;
      second_q <= first_q;
      if (second_q && !count_q[Bits]) count_q <= count_q + 1'b1;
    end

  assign rst_o = !count_q[Bits];
endmodule

`default_nettype wire
