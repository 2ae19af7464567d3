// A capture unit: watches one input for an edge. It requests a snapshot at the first raw change after a quiet time,
// before the input's filter knows whether the change lasts.
//
// An input is quiet when it has been at its filtered level for a whole length of its filter. The first touch counts:
// all later changes of the input belong to the same edge, until the filter passes (the snapshot is then a capture) or
// the input is quiet again (the touch was a glitch, and nothing was captured). An input without a filter is always
// quiet, and each of its edges passes in its own clock. A capture stays until it is cleared; edges that pass in the
// meantime are overruns. While the snapshot of a passed edge is being written, no edge counts.
//
// A unit that queues its captures hands each one on as it passes. In such a unit an edge that passes is either handed
// on or an overrun: the queue was full, or the unit was not looking for the edge when it came.
`default_nettype none

module capture_unit #(
    parameter logic Queue = 0  // 1: there is a queue
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [31:0] raw_i,  // levels of the inputs
    input wire logic [31:0] level_i,  // levels after the filters
    input wire logic [31:0] quiet_i,  // flags of quiet inputs, registered
    input wire logic select_i,  // event: setting_i is a new CAPTURE_SELECT
    input wire logic [31:0] setting_i,
    input wire logic clear_i,  // event
    input wire logic captured_i,  // event: the requested snapshot is in the area
    input wire logic queued_i,  // event: the capture handed on is in the queue, or lost
    input wire logic full_i,  // with queued_i: the capture is lost
    output logic ask_o,  // combinational; stays until captured_i, or until the request is withdrawn
    output logic passed_o,  // level: a capture is handed on; its edge led to active_edge_o
    output logic active_edge_o,
    output logic pending_o,
    output logic valid_o,
    output logic overrun_o,
    output logic active_o
);
  typedef enum logic [1:0] {
    OFF,
    LOOK,    // waits for quiet at the level before the edge
    READY,
    PENDING  // an edge has come
  } state_e;

  state_e       state_q;
  logic   [4:0] input_q;
  logic         to_active_q;
  logic         to_inactive_q;
  logic         continuous_q;
  logic         queue_q;
  logic         old_q;  // the level before the edge
  logic         lost_q;  // the edge came while a capture was present
  logic         confirmed_q;
  logic         taken_q;
  logic         level_q;
  logic         watched_q;  // level_q belongs to the input that is watched now

  logic         raw;
  logic         level;
  logic         quiet;
  logic         old;
  logic         found;  // the input is quiet at a level from which a selected edge can start
  logic         over;  // the input was quiet again before its filter passed
  logic         starts;
  logic         touch;
  logic         missed;  // an edge passes for which no touch was taken

  assign raw   = raw_i[input_q];
  assign level = level_i[input_q];
  assign quiet = quiet_i[input_q];

  always_comb begin
    old = state_q == LOOK ? level : old_q;
    found = state_q == LOOK && quiet && (level ? to_inactive_q : to_active_q);
    over = state_q == PENDING && !confirmed_q && quiet && level == old_q;
    starts = state_q == READY || found || over;
    touch = starts && raw != old;
    missed = queue_q && watched_q && state_q != OFF && level != level_q && (level ? to_active_q : to_inactive_q) &&
        !touch && !(state_q == PENDING && !confirmed_q);
    // A pending request is withdrawn for one clock, so that the snapshot under way is not taken for that of the next
    // touch.
    if (select_i) ask_o = 1'b0;
    else if (touch) ask_o = !valid_o && (!over || taken_q || lost_q);
    else ask_o = state_q == PENDING && !over && !lost_q && !taken_q;
  end

  always_ff @(posedge clk_i) begin
    if (clear_i) begin
      valid_o   <= 1'b0;
      overrun_o <= 1'b0;
    end
    taken_q <= taken_q || captured_i;
    confirmed_q <= confirmed_q || level != old_q;
    if (starts) begin
      state_q <= touch ? PENDING : READY;
      old_q <= old;
      lost_q <= valid_o;
      taken_q <= 1'b0;
      confirmed_q <= level != old;
    end else if (state_q == PENDING && confirmed_q && (taken_q || lost_q) && (!queue_q || queued_i)) begin
      state_q <= continuous_q ? LOOK : OFF;
      if (lost_q || (queue_q && full_i)) overrun_o <= 1'b1;
      else if (!queue_q) begin
        valid_o  <= 1'b1;
        active_o <= !old_q;
      end
    end
    level_q   <= level;
    watched_q <= state_q != OFF && !select_i;
    if (missed) overrun_o <= 1'b1;
    if (select_i) begin
      input_q <= setting_i[4:0];
      to_active_q <= setting_i[card_map_pkg::BIT_CAPTURE_SELECT_TO_ACTIVE];
      to_inactive_q <= setting_i[card_map_pkg::BIT_CAPTURE_SELECT_TO_INACTIVE];
      continuous_q <= setting_i[card_map_pkg::BIT_CAPTURE_SELECT_CONTINUOUS];
      queue_q <= Queue && setting_i[card_map_pkg::BIT_CAPTURE_SELECT_QUEUE];
      state_q <= setting_i[card_map_pkg::BIT_CAPTURE_SELECT_TO_ACTIVE] ||
          setting_i[card_map_pkg::BIT_CAPTURE_SELECT_TO_INACTIVE] ? LOOK : OFF;
    end
    if (select_i || rst_i) begin
      valid_o   <= 1'b0;
      overrun_o <= 1'b0;
      active_o  <= 1'b0;
    end
    if (rst_i) begin
      state_q <= OFF;
      input_q <= '0;
    end
  end

  assign pending_o = state_q == PENDING;
  assign passed_o = queue_q && state_q == PENDING && confirmed_q && taken_q;
  assign active_edge_o = !old_q;

  logic unused;
  assign unused = &{1'b0, setting_i};
endmodule

`default_nettype wire
