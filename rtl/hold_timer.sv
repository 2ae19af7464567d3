// One clock in `limit_i`: the beat by which the shapers judge how long a step has waited.
`default_nettype none

module hold_timer (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic [15:0] limit_i,  // clocks, at least 1
    output logic             tick_o
);
  logic [15:0] count_q;
  logic [15:0] last_q;

  always_ff @(posedge clk_i) begin
    last_q  <= limit_i - 16'd1;
    // A limit lowered in mid count takes effect in the next clock; >= costs no more than the equality.
    tick_o  <= count_q >= last_q;
    count_q <= (count_q >= last_q) ? 16'd0 : count_q + 16'd1;
    if (rst_i) begin
      last_q  <= card_map_pkg::RESET_HOLD_LIMIT[15:0] - 16'd1;
      tick_o  <= 1'b0;
      count_q <= 16'd0;
    end
  end
endmodule

`default_nettype wire
