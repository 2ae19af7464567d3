// The drives' enable and their brake: one sequence for all axes that ENABLE_AXES names.
//
//   OFF      disabled, brake set       -> TORQUE when a path waits for it or ENABLE requests it, and no cause bars it
//   TORQUE   enabled, brake set        for BRAKE_RELEASE_DELAY
//   SETTLE   enabled, brake released   for ENABLE_DELAY
//   READY    ticks are taken           until at rest for ENABLE_IDLE, ENABLE is withdrawn, or a cause bars it
//   LAST     as SETTLE                 for STOP_DELAY
//   BRAKE    enabled, brake set        for BRAKE_SET_DELAY
//
// Outside READY no tick is taken: a path waits at the gate, and nothing of it is lost. READY is left only at rest,
// except for the emergency stop, which disables at once in every state. Neither a reset nor clearing FAULT enables
// anything.
`default_nettype none

module drive_enable #(
    parameter int Axes      = 4,   // 1 to 8
    parameter int DelayBits = 12,  // delays are in units of 2^DelayBits clocks; the map says 12, proofs take fewer
    parameter int IdleBits  = 20   // ENABLE_IDLE is in units of 2^IdleBits clocks
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic moves_i,  // a path or a direct move takes ticks
    input wire logic busy_i,  // something runs or is queued, or a pulse is under way
    input wire logic emergency_i,  // level: emergency stop
    input wire logic [31:0] fault_i,
    output logic enabled_o,
    output logic released_o,  // the brake is released
    output logic wait_o,  // no tick may be taken
    output logic waiting_o,  // motion waits for the enable (combinational)
    output logic [Axes-1:0] disabled_o  // events: the axis's drive is disabled (combinational)
);
  localparam int Faults = card_map_pkg::BIT_FAULT_TOOL_SETTER + 1;
  localparam int TimerBits = 16 + IdleBits;

  typedef enum logic [2:0] {
    OFF,
    TORQUE,
    SETTLE,
    READY,
    LAST,
    BRAKE
  } state_e;

  state_e                 state_q;
  state_e                 state_d;
  logic   [     Axes-1:0] named_q;
  logic   [     Axes-1:0] axes_q;  // changes only at rest
  logic   [     Axes-1:0] axes_d;
  logic                   on_q;
  logic                   manual_q;
  logic   [         15:0] enable_delay_q;
  logic   [         15:0] release_delay_q;
  logic   [         15:0] stop_delay_q;
  logic   [         15:0] set_delay_q;
  logic   [         15:0] idle_q;
  logic   [   Faults-1:0] causes_q;
  logic   [TimerBits-1:0] left_q;
  logic   [TimerBits-1:0] next_left;
  logic                   none_left;
  logic   [TimerBits-1:0] load;
  logic                   rests;
  logic                   used;
  logic                   barred;
  logic                   wanted;
  logic                   leaves;
  logic   [         31:0] data;

  function automatic logic [TimerBits-1:0] clocks_of(input logic [15:0] count);
    clocks_of = TimerBits'(count) << DelayBits;
  endfunction

  assign data = setting_bus_pkg::data(setting_i);
  assign rests = !moves_i && !busy_i;
  assign axes_d = rests ? named_q : axes_q;
  assign used = axes_q != '0;
  // The emergency stop is not part of it: it forces OFF whatever the state.
  assign barred = (fault_i[Faults-1:0] & causes_q) != '0;
  assign wanted = used && !barred && (on_q || (moves_i && !manual_q));
  // One subtraction: its borrow is the comparison with 0.
  assign {none_left, next_left} = {1'b0, left_q} - 1'b1;
  assign leaves = rests && (barred || !used || (!on_q && (manual_q || (idle_q != '0 && none_left))));

  always_comb begin
    state_d = state_q;
    load = next_left;
    case (state_q)
      OFF:
      if (wanted) begin
        state_d = TORQUE;
        load = clocks_of(release_delay_q);
      end
      TORQUE:
      if (barred) begin
        state_d = BRAKE;
        load = clocks_of(set_delay_q);
      end else if (none_left) begin
        state_d = SETTLE;
        load = clocks_of(enable_delay_q);
      end
      SETTLE:
      if (barred) begin
        state_d = BRAKE;
        load = clocks_of(set_delay_q);
      end else if (none_left) begin
        state_d = READY;
        load = TimerBits'(idle_q) << IdleBits;
      end
      READY: begin
        if (none_left) load = '0;
        if (!rests) load = TimerBits'(idle_q) << IdleBits;
        if (leaves) begin
          state_d = LAST;
          load = clocks_of(stop_delay_q);
        end
      end
      LAST:
      if (none_left) begin
        state_d = BRAKE;
        load = clocks_of(set_delay_q);
      end
      default: if (none_left) state_d = OFF;
    endcase
    if (emergency_i) state_d = OFF;
  end

  always_ff @(posedge clk_i) begin
    state_q <= state_d;
    left_q <= load;
    enabled_o <= state_d != OFF;
    released_o <= state_d == SETTLE || state_d == READY || state_d == LAST;
    axes_q <= axes_d;
    // The path from here to the queues is one of the card's longest, so it begins at a flip-flop.
    wait_o <= axes_d != '0 && state_d != READY;
    if (setting_i[setting_bus_pkg::SET]) begin
      case (setting_bus_pkg::word(
          setting_i
      ))
        card_map_pkg::ADDR_ENABLE[11:2]: {manual_q, on_q} <= data[1:0];
        card_map_pkg::ADDR_ENABLE_AXES[11:2]: named_q <= data[Axes-1:0];
        card_map_pkg::ADDR_ENABLE_DELAY[11:2]: enable_delay_q <= data[15:0];
        card_map_pkg::ADDR_BRAKE_RELEASE_DELAY[11:2]: release_delay_q <= data[15:0];
        card_map_pkg::ADDR_STOP_DELAY[11:2]: stop_delay_q <= data[15:0];
        card_map_pkg::ADDR_BRAKE_SET_DELAY[11:2]: set_delay_q <= data[15:0];
        card_map_pkg::ADDR_ENABLE_IDLE[11:2]: idle_q <= data[15:0];
        card_map_pkg::ADDR_DISABLE_CAUSES[11:2]: causes_q <= data[Faults-1:0];
        default: ;
      endcase
    end
    if (rst_i) begin
      state_q <= OFF;
      enabled_o <= 1'b0;
      released_o <= 1'b0;
      named_q <= '0;
      axes_q <= '0;
      wait_o <= 1'b0;
      {manual_q, on_q} <= 2'b00;
      enable_delay_q <= '0;
      release_delay_q <= '0;
      stop_delay_q <= '0;
      set_delay_q <= '0;
      idle_q <= '0;
      causes_q <= '0;
    end
  end

  assign waiting_o  = wait_o && moves_i;
  // In the clock before OFF: derived from the next state, it would be one of the card's longest paths.
  assign disabled_o = state_q != OFF && (emergency_i || (state_q == BRAKE && none_left)) ? axes_q : '0;

  logic unused;  // bits of absent axes and faults
  assign unused = &{1'b0, data, fault_i};
endmodule

`default_nettype wire
