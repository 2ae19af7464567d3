// The register PLACE: POSITION_VALID says which axes are where the host believes, HOMED says which of them were homed.
// The host writes both by SET_PLACE; the card clears them.
//
// A fault of its drive clears both bits of an axis. A cut while the axis moves, and the disabling of its drive, clear
// them too, unless KEEPS_PLACE names the axis. An axis moves from its first step until neither a piece nor a direct
// move is under way; while the ratio is 0 it is at rest. So the cut that follows a hold, or the end of a ramp, clears
// nothing.
//
// An event is judged one clock later, from flip-flops, because its path through the emergency stop and the sequence of
// the drives is one of the card's longest. So a loss has priority over a write in its clock and in the next clock: the
// host could not know of the loss when it wrote. KEEPS_PLACE counts for an event in the clock in which it is written. A
// write in a later clock counts; so the host writes while the axes are at rest, when no cut clears anything.
`default_nettype none

module machine_place #(
    parameter int Axes = 4
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic cut_i,  // event
    input wire logic at_rest_i,  // the ratio is 0
    input wire logic runs_i,  // a piece or a direct move is under way
    input wire logic [Axes-1:0] step_i,  // steps on the path
    input wire logic [Axes-1:0] drive_fault_i,  // levels
    input wire logic [Axes-1:0] disabled_i,  // events: the drive is disabled
    output logic [15:0] place_o  // the register PLACE
);
  logic [Axes-1:0] valid_q;
  logic [Axes-1:0] homed_q;
  logic [Axes-1:0] keeps_q;
  logic [Axes-1:0] moved_q;  // axes that have stepped since the motion under way began
  logic [Axes-1:0] drive_fault_q;
  logic [Axes-1:0] disabled_q;
  logic            cut_q;  // a cut came while the ratio was not 0
  logic [Axes-1:0] lost;
  logic [Axes-1:0] written;
  logic [    31:0] data;

  assign data = setting_bus_pkg::data(setting_i);
  assign written = setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_SET_PLACE) ? data[16+:Axes] : '0;
  assign lost = drive_fault_q | ((disabled_q | (cut_q ? moved_q : '0)) & ~keeps_q);
  assign place_o = {8'(homed_q), 8'(valid_q)};

  always_ff @(posedge clk_i) begin
    moved_q <= runs_i ? moved_q | step_i : '0;
    drive_fault_q <= drive_fault_i;
    disabled_q <= disabled_i;
    cut_q <= cut_i && !at_rest_i;
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_KEEPS_PLACE)) keeps_q <= data[Axes-1:0];
    valid_q <= ((valid_q & ~written) | (data[0] ? written : '0)) & ~lost;
    homed_q <= ((homed_q & ~written) | (data[1] ? written : '0)) & ~lost;
    if (rst_i) begin
      moved_q <= '0;
      drive_fault_q <= '0;
      disabled_q <= '0;
      cut_q <= 1'b0;
      keeps_q <= card_map_pkg::RESET_KEEPS_PLACE[Axes-1:0];
      valid_q <= '0;
      homed_q <= '0;
    end
  end

  logic unused;  // bits of absent axes
  assign unused = &{1'b0, data};
endmodule

`default_nettype wire
