// Ticks once per HOLD_LIMIT clocks. At these ticks the shapers judge how long a step has waited.
`default_nettype none

module wait_timer (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    output logic tick_o
);
  logic [15:0] last_q;  // HOLD_LIMIT - 1; HOLD_LIMIT is at least 1
  logic [15:0] count_q;
  logic [31:0] data;

  assign data = setting_bus_pkg::data(setting_i);

  always_ff @(posedge clk_i) begin
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_HOLD_LIMIT)) last_q <= data[15:0] - 16'd1;
    // If the limit is lowered below the count, the tick comes in the next clock. >= costs no more than ==.
    tick_o  <= count_q >= last_q;
    count_q <= (count_q >= last_q) ? 16'd0 : count_q + 16'd1;
    if (rst_i) begin
      last_q  <= card_map_pkg::RESET_HOLD_LIMIT[15:0] - 16'd1;
      tick_o  <= 1'b0;
      count_q <= 16'd0;
    end
  end

  logic unused;
  assign unused = &{1'b0, data[31:16]};
endmodule

`default_nettype wire
