// Stops the ticks at any fault, until the path was aborted and FAULT is clear, in either order.
`default_nettype none

module fault_stop (
    input  wire logic clk_i,
    input  wire logic rst_i,
    input  wire logic abort_i,
    input  wire logic event_i,    // a fault arises
    input  wire logic latched_i,  // a bit of FAULT is set
    output logic      go_o        // ticks may be taken
);
  logic any;
  logic any_q;
  logic abort_due_q;  // a fault came and no abort since

  assign any = event_i | latched_i;

  always_ff @(posedge clk_i) begin
    any_q <= any;
    if (abort_i) abort_due_q <= 1'b0;
    else if (any & ~any_q) abort_due_q <= 1'b1;
    go_o <= ~any & ~any_q & ~abort_due_q;
    if (rst_i) begin
      any_q       <= 1'b0;
      abort_due_q <= 1'b0;
      go_o        <= 1'b1;
    end
  end
endmodule

`default_nettype wire
