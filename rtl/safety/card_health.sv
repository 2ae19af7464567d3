// Whether the card is healthy, for an emergency-stop chain: a level, and the square wave of a charge pump, which a hung
// card cannot make. The card is healthy while none of the faults that HEALTH_CAUSES names is present and, if
// HEALTH_CAUSES requires it, the watchdog is running.
`default_nettype none

module card_health (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [31:0] fault_i,
    input wire logic fed_i,  // the watchdog is running
    output logic healthy_o,
    output logic pump_o
);
  localparam int Faults = card_map_pkg::BIT_FAULT_TOOL_SETTER + 1;

  logic [Faults-1:0] causes_q;
  logic              needs_watchdog_q;
  logic [      15:0] half_q;  // half period of the wave, in clocks; 0: no wave
  logic [      15:0] count_q;
  logic [      31:0] data;
  logic              beats;

  assign data  = setting_bus_pkg::data(setting_i);
  assign beats = healthy_o && half_q != '0;

  always_ff @(posedge clk_i) begin
    healthy_o <= (fault_i[Faults-1:0] & causes_q) == '0 && (fed_i || !needs_watchdog_q);
    // If the half period is shortened below the count, it ends at once.
    count_q <= !beats || count_q + 16'd1 >= half_q ? 16'd0 : count_q + 16'd1;
    pump_o <= beats && (pump_o ^ (count_q + 16'd1 >= half_q));
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_HEALTH_CAUSES)) begin
      causes_q <= data[Faults-1:0];
      needs_watchdog_q <= data[31];
    end
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_CHARGE_PUMP)) half_q <= data[15:0];
    if (rst_i) begin
      healthy_o <= 1'b0;
      pump_o <= 1'b0;
      count_q <= '0;
      causes_q <= '0;
      needs_watchdog_q <= 1'b0;
      half_q <= '0;
    end
  end

  logic unused;  // faults that are not built in
  assign unused = &{1'b0, data, fault_i};
endmodule

`default_nettype wire
