// The roles of the inputs: a role is active while any of the inputs that its mask names is active.
//
// A scan of 64 clocks looks at one role per clock. So a level that lasts 64 clocks is seen, within 65 clocks of its
// beginning. Masks are 0 after a reset. No mask may be set in the 64 clocks after it, in which the masks are cleared.
`default_nettype none

module role_scan #(
    parameter int Axes   = 4,  // 1 to 8
    parameter int Inputs = 8   // 1 to 32
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [Inputs-1:0] levels_i,  // levels after the filters
    input wire logic set_i,
    input wire logic [5:0] set_role_i,  // 8 * kind + axis
    input wire logic [Inputs-1:0] set_mask_i,
    output logic [input_roles_pkg::WIDTH-1:0] roles_o
);
  // Kinds of roles that each axis has, and the roles of the card itself.
  localparam logic [2:0] LimitMinus = 3'd0;
  localparam logic [2:0] LimitPlus = 3'd1;
  localparam logic [2:0] DriveFault = 3'd4;
  localparam logic [5:0] Probe = 6'd48;
  localparam logic [5:0] ToolSetter = 6'd49;
  localparam logic [5:0] FeedHold = 6'd50;
  localparam logic [5:0] CycleStart = 6'd51;

  logic [       5:0] reads_q;
  logic              clearing_q;
  logic [Inputs-1:0] mask_read_q;
  logic [Inputs-1:0] mask_q;
  logic [       5:0] scanned;
  logic              active;

  // The content of the RAM comes two clocks after the address.
  assign scanned = reads_q - 6'd2;
  assign active  = |(levels_i & mask_q) && !clearing_q;

  always_ff @(posedge clk_i) begin
    reads_q <= reads_q + 6'd1;
    if (reads_q == '1) clearing_q <= 1'b0;
    for (int axis = 0; axis < Axes; axis++) begin
      if (scanned == {LimitMinus, 3'(axis)}) roles_o[input_roles_pkg::LIMIT_MINUS+axis] <= active;
      if (scanned == {LimitPlus, 3'(axis)}) roles_o[input_roles_pkg::LIMIT_PLUS+axis] <= active;
      if (scanned == {DriveFault, 3'(axis)}) roles_o[input_roles_pkg::DRIVE_FAULT+axis] <= active;
    end
    if (scanned == FeedHold) roles_o[input_roles_pkg::FEED_HOLD] <= active;
    if (scanned == CycleStart) roles_o[input_roles_pkg::CYCLE_START] <= active;
    if (scanned == ToolSetter) roles_o[input_roles_pkg::TOOL_SETTER] <= active;
    if (scanned == Probe) roles_o[input_roles_pkg::PROBE] <= active;
    if (rst_i) begin
      reads_q    <= '0;
      clearing_q <= 1'b1;
      roles_o    <= '0;
    end
  end

  logic [Inputs-1:0] masks[0:63];

  // One write port, and one read port with a register behind it.
  always_ff @(posedge clk_i) begin
    if (set_i || clearing_q) masks[clearing_q?scanned : set_role_i] <= clearing_q ? '0 : set_mask_i;
    mask_read_q <= masks[reads_q];
    mask_q <= mask_read_q;
  end
endmodule

`default_nettype wire
