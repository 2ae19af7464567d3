// Outputs that have a role follow it; commands and safe levels do not change them. An inactive role gives the output
// the strap's idle level, an active role the other level. The emergency stop's latch disables drives and sets brakes
// without a clock.
`default_nettype none

module output_roles #(
    parameter int Outputs = 4  // 1 to 16
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [Outputs-1:0] idle_i,  // strap
    input wire logic latched_i,  // latch of the emergency stop (asynchronous)
    input wire logic enabled_i,
    input wire logic released_i,  // the brake is released
    input wire logic pump_i,
    input wire logic healthy_i,
    input wire logic [Outputs-1:0] level_i,  // levels of outputs without a role
    output logic [Outputs-1:0] pin_o  // combinational
);
  logic [Outputs-1:0] enable_q;
  logic [Outputs-1:0] brake_q;
  logic [Outputs-1:0] pump_q;
  logic [Outputs-1:0] healthy_q;
  logic [Outputs-1:0] taken;  // outputs that have a role
  logic [Outputs-1:0] active;
  logic [       31:0] data;

  assign data = setting_bus_pkg::data(setting_i);
  assign taken = enable_q | brake_q | pump_q | healthy_q;
  assign active = (enabled_i && !latched_i ? enable_q : '0) | (released_i && !latched_i ? brake_q : '0) |
      (pump_i ? pump_q : '0) | (healthy_i ? healthy_q : '0);
  assign pin_o = (level_i & ~taken) | ((idle_i ^ active) & taken);

  always_ff @(posedge clk_i) begin
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_OUTPUT_ROLES)) begin
      enable_q <= data[Outputs-1:0];
      brake_q  <= data[16+:Outputs];
    end
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_HEALTH_ROLES)) begin
      pump_q <= data[Outputs-1:0];
      healthy_q <= data[16+:Outputs];
    end
    if (rst_i) begin
      enable_q  <= '0;
      brake_q   <= '0;
      pump_q    <= '0;
      healthy_q <= '0;
    end
  end

  logic unused;
  assign unused = &{1'b0, data};
endmodule

`default_nettype wire
