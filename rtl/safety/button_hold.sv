// The buttons: feed hold holds the path until cycle start. While the feed hold button is pressed, nothing releases the
// hold. A cycle start button that is held down does not release a later hold.
`default_nettype none

module button_hold (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [input_roles_pkg::WIDTH-1:0] roles_i,
    output logic hold_o
);
  logic was_started_q;
  logic starts;

  assign starts = roles_i[input_roles_pkg::CYCLE_START] && !was_started_q;

  always_ff @(posedge clk_i) begin
    was_started_q <= roles_i[input_roles_pkg::CYCLE_START];
    hold_o <= roles_i[input_roles_pkg::FEED_HOLD] || (hold_o && !starts);
    if (rst_i) begin
      was_started_q <= 1'b1;
      hold_o <= 1'b0;
    end
  end

  logic unused;  // roles that are not buttons
  assign unused = &{1'b0, roles_i};
endmodule

`default_nettype wire
