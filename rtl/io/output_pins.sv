// The card's outputs, which commands set and clear. At a cut the outputs that OUTPUT_SAFE names take their safe levels.
// At the cause of a stop those that OUTPUT_SAFE_CAUSE names take theirs, and keep them as long as caused_i is high. The
// emergency stop's latch sets the latter at the pins without a clock; the cause that follows keeps them when the latch
// is cleared.
`default_nettype none

module output_pins #(
    parameter int Outputs = 4  // 1 to 16
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic caused_i,  // a cause of a stop is present, or the card is stopping or stopped
    input wire logic latched_i,  // latch of the emergency stop (asynchronous)
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [Outputs-1:0] idle_i,  // strap: the levels in reset
    input wire logic change_i,
    input wire logic [Outputs-1:0] set_i,  // with change_i; has priority over clear_i
    input wire logic [Outputs-1:0] clear_i,
    output logic [Outputs-1:0] pin_o  // combinational from latched_i
);
  logic [Outputs-1:0] level_q;
  logic [Outputs-1:0] safe_q;
  logic [Outputs-1:0] changes_q;  // outputs that a cut changes
  logic [Outputs-1:0] cause_safe_q;
  logic [Outputs-1:0] cause_changes_q;  // outputs that a cause of a stop, and a cut with it, changes

  logic [31:0] data;

  assign data  = setting_bus_pkg::data(setting_i);
  assign pin_o = latched_i ? (level_q & ~cause_changes_q) | (cause_safe_q & cause_changes_q) : level_q;

  always_ff @(posedge clk_i) begin : p_level
    logic [Outputs-1:0] level;

    level = level_q;
    if (cut_i) level = (level_q & ~changes_q) | (safe_q & changes_q);
    else if (change_i) level = (level_q & ~clear_i) | set_i;
    level_q <= level;
    if (cut_i || caused_i) level_q <= (level & ~cause_changes_q) | (cause_safe_q & cause_changes_q);
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_OUTPUT_SAFE)) begin
      safe_q <= data[Outputs-1:0];
      changes_q <= data[16+:Outputs];
    end
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_OUTPUT_SAFE_CAUSE)) begin
      cause_safe_q <= data[Outputs-1:0];
      cause_changes_q <= data[16+:Outputs];
    end
    if (rst_i) begin
      level_q <= idle_i;
      safe_q <= card_map_pkg::RESET_OUTPUT_SAFE[Outputs-1:0];
      changes_q <= card_map_pkg::RESET_OUTPUT_SAFE[16+:Outputs];
      cause_safe_q <= card_map_pkg::RESET_OUTPUT_SAFE_CAUSE[Outputs-1:0];
      cause_changes_q <= card_map_pkg::RESET_OUTPUT_SAFE_CAUSE[16+:Outputs];
    end
  end

  logic unused;
  assign unused = &{1'b0, data[31:0]};
endmodule

`default_nettype wire
