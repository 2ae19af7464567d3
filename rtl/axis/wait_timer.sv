// One clock in HOLD_LIMIT: the tick by which the shapers judge how long a step has waited.
`default_nettype none

module wait_timer (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic [40:0] setting_i,
    output logic             tick_o
);
  logic [15:0] last_q;  // HOLD_LIMIT less one; it is at least 1
  logic [15:0] count_q;

  always_ff @(posedge clk_i) begin
    if (setting_i[40] && setting_i[39:32] == card_map_pkg::ADDR_HOLD_LIMIT[9:2]) last_q <= setting_i[15:0] - 16'd1;
    // A limit lowered in mid count takes effect in the next clock; >= costs no more than the equality.
    tick_o  <= count_q >= last_q;
    count_q <= (count_q >= last_q) ? 16'd0 : count_q + 16'd1;
    if (rst_i) begin
      last_q  <= card_map_pkg::RESET_HOLD_LIMIT[15:0] - 16'd1;
      tick_o  <= 1'b0;
      count_q <= 16'd0;
    end
  end

  logic unused;
  assign unused = &{1'b0, setting_i[31:16]};
endmodule

`default_nettype wire
