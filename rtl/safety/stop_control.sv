// All stops of the card: collects the faults, holds the time base, cuts.
//
// A fault stops at once or, if its reaction says so, after the time base has come to rest. In both cases the tick gate
// is shut then, and the cut waits until the ticks in flight have made their steps and the last pulse has ended. So the
// snapshot REST, strobed in the clock of the cut, has a tick and positions that agree. The cut leaves nothing that
// could move, so clearing FAULT never starts motion. An abort cuts at once, unless a fault's stop is under way already.
//
// The wait is bounded: with the gate shut, path_tick_gate has at most seven ticks, each step takes its engine at most
// 17 clocks, and a shaper holds four steps besides the pulse under way.
//
// A HOLD waits for the end of the fixed pieces that are under way. If nothing moves, or the time base is at rest, it
// takes effect at once and stays until it is withdrawn: a fixed piece that is sent in the meantime starts no motion.
`default_nettype none

module stop_control #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1  // built-in engines: bits card_map_pkg::ENGINE_*
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [Axes-1:0] step_fault_i,
    input wire logic mismatch_i,
    input wire logic incomplete_i,
    input wire logic missing_i,  // event: position streaming lacks its next period
    input wire logic expired_i,  // level: the watchdog has expired
    input wire logic link_lost_i,  // level: the link is lost
    input wire logic emergency_i,  // level: emergency stop
    input wire logic [stop_causes_pkg::WIDTH-1:0] causes_i,  // from the machine's inputs
    input wire logic soft_limit_i,  // event: a pulse beyond a soft limit
    input wire logic abort_i,
    input wire logic [31:0] clear_i,  // ones written to FAULT
    input wire logic at_rest_i,  // the ratio is 0
    input wire logic moving_i,  // pieces are giving ticks
    input wire logic fixed_i,  // the present piece is fixed
    input wire logic underrun_i,  // under-run hold: neither a fault nor a cut
    input wire logic probe_i,  // a probe has tripped: neither a fault nor a cut
    input wire logic button_i,  // the feed hold button holds, like HOLD
    // motion that is still under way
    input wire logic take_i,  // a tick is taken in this clock (combinational)
    input wire logic swap_i,  // a path begins
    input wire logic quiet_i,  // no path tick waits or is on its way to an engine, and no engine is making a step
    input wire logic pulses_i,  // an axis is busy
    input wire logic busy_i,  // something runs or is queued
    output logic [31:0] fault_o,
    output logic hold_o,  // the time base slows down to rest
    output logic cut_o,
    output logic stop_o,  // event: a stop begins
    output logic rest_o,  // event (combinational): requests the snapshot REST; a cut follows in the next clock
    output logic caused_o,  // a cause of a stop is present, or the card is not in RUN (combinational)
    output logic stopping_o,  // a stop is under way, a cut follows (combinational)
    output logic closing_o,  // last part of a stop: the gate is shut (combinational)
    output logic shut_o,  // no tick may be taken
    output logic settled_o,  // STATUS.settled (combinational)
    output logic closed_o  // no command and no START is accepted
);
  // The upper bit shuts the tick gate.
  typedef enum logic [1:0] {
    RUN,
    RAMP,
    CLOSING,
    STOPPED
  } state_e;

  // Clocks without motion until the card is settled. A tick takes at most 10 clocks to its axis's busy flag. The
  // snapshot STOP takes 20 clocks from the cause on, and REST must not interrupt it.
  localparam logic [4:0] SETTLED = 5'd31;

  localparam int Faults = card_map_pkg::BIT_FAULT_TOOL_SETTER + 1;
  localparam logic [Faults-1:0] OF_INPUTS = Faults'(1) << card_map_pkg::BIT_FAULT_LIMIT |
      Faults'(1) << card_map_pkg::BIT_FAULT_DRIVE_FAULT | Faults'(1) << card_map_pkg::BIT_FAULT_PROBE |
      Faults'(1) << card_map_pkg::BIT_FAULT_TOOL_SETTER;
  // The causes that can arise in this card, and those whose reaction can be chosen. The others get no flip-flops.
  localparam logic [Faults-1:0] BUILT = (Faults'(1) << Axes) - Faults'(1) |
      Faults'(1) << card_map_pkg::BIT_FAULT_TICK_MISMATCH | Faults'(1) << card_map_pkg::BIT_FAULT_PATH_INCOMPLETE |
      Faults'(Engines[card_map_pkg::ENGINE_STREAMING]) << card_map_pkg::BIT_FAULT_MISSING_PERIOD |
      Faults'(1) << card_map_pkg::BIT_FAULT_WATCHDOG | Faults'(1) << card_map_pkg::BIT_FAULT_LINK_LOSS |
      Faults'(Engines[card_map_pkg::ENGINE_EMERGENCY_STOP]) << card_map_pkg::BIT_FAULT_EMERGENCY_STOP |
      Faults'(Engines[card_map_pkg::ENGINE_SOFT_LIMITS]) << card_map_pkg::BIT_FAULT_SOFT_LIMIT |
      (Engines[card_map_pkg::ENGINE_MACHINE_INPUTS] ? OF_INPUTS : '0);
  localparam logic [Faults-1:0] REACTIONS = card_map_pkg::MASK_STOP_REACTION[Faults-1:0] & BUILT;

  state_e              state_q;
  state_e              state_d;
  logic   [Faults-1:0] fault_q;
  logic   [Faults-1:0] cause;
  logic                hold_q;
  logic                hold_latched_q;  // the hold stays, even when a fixed piece begins
  logic                asked;
  logic                stays;
  logic   [Faults-1:0] ramped_q;  // causes whose reaction is a ramp
  logic                any;
  logic                immediate;
  logic   [       4:0] settle_q;
  logic                still;
  logic                finished;
  logic   [      31:0] data;

  assign data = setting_bus_pkg::data(setting_i);
  assign any = cause != '0;
  assign asked = hold_q || button_i;
  assign stays = asked && (hold_latched_q || !moving_i || at_rest_i);
  assign immediate = (cause & ~ramped_q) != '0 || causes_i[stop_causes_pkg::BEYOND];

  always_comb begin
    cause = Faults'(step_fault_i) << card_map_pkg::BIT_FAULT_STEP;
    cause[card_map_pkg::BIT_FAULT_TICK_MISMATCH] = mismatch_i;
    cause[card_map_pkg::BIT_FAULT_PATH_INCOMPLETE] = incomplete_i;
    cause[card_map_pkg::BIT_FAULT_MISSING_PERIOD] = missing_i;
    cause[card_map_pkg::BIT_FAULT_WATCHDOG] = expired_i;
    cause[card_map_pkg::BIT_FAULT_LINK_LOSS] = link_lost_i;
    cause[card_map_pkg::BIT_FAULT_SOFT_LIMIT] = soft_limit_i;
    cause[card_map_pkg::BIT_FAULT_EMERGENCY_STOP] = emergency_i;
    cause[card_map_pkg::BIT_FAULT_LIMIT] = causes_i[stop_causes_pkg::LIMIT];
    cause[card_map_pkg::BIT_FAULT_DRIVE_FAULT] = causes_i[stop_causes_pkg::DRIVE_FAULT];
    cause[card_map_pkg::BIT_FAULT_PROBE] = causes_i[stop_causes_pkg::PROBE];
    cause[card_map_pkg::BIT_FAULT_TOOL_SETTER] = causes_i[stop_causes_pkg::TOOL_SETTER];
    cause = cause & BUILT;
  end

  always_comb begin
    state_d = state_q;
    case (state_q)
      RUN:
      if (immediate || (any && abort_i)) state_d = CLOSING;
      else if (any) state_d = RAMP;
      RAMP: if (immediate || abort_i || at_rest_i) state_d = CLOSING;
      CLOSING: if (finished) state_d = STOPPED;
      default: if (!any && fault_q == '0) state_d = RUN;
    endcase
  end

  // stop_o restarts the count in the first clock outside RUN.
  assign still = (at_rest_i || shut_o) && quiet_i && !pulses_i && !take_i && !stop_o;
  assign settled_o = settle_q == SETTLED && !swap_i;
  assign finished = closing_o && settle_q == SETTLED && !stop_o;
  assign rest_o = finished || (abort_i && state_q == RUN && busy_i);

  always_ff @(posedge clk_i) begin
    if (!still || rst_i) settle_q <= 5'd0;
    else if (settle_q != SETTLED) settle_q <= settle_q + 5'd1;
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_HOLD)) hold_q <= data[0];
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_STOP_REACTION)) ramped_q <= data[Faults-1:0] & REACTIONS;
    fault_q <= (fault_q & ~clear_i[Faults-1:0] & BUILT) | cause;
    state_q <= state_d;
    cut_o <= finished || (abort_i && (state_q == STOPPED || (state_q == RUN && !any)));
    stop_o <= state_q == RUN && state_d != RUN;
    hold_latched_q <= stays;
    // The ratio stays 0 from the end of a ramp to the cut.
    hold_o <= (asked && (stays || !fixed_i)) || underrun_i || probe_i || state_q == RAMP || (closing_o && at_rest_i);
    closed_o <= fault_q != '0 || state_q != RUN;
    if (rst_i) begin
      hold_q   <= card_map_pkg::RESET_HOLD[0];
      ramped_q <= card_map_pkg::RESET_STOP_REACTION[Faults-1:0] & REACTIONS;
      fault_q  <= '0;
      state_q  <= RUN;
      hold_latched_q <= 1'b0;
      cut_o    <= 1'b0;
      stop_o   <= 1'b0;
      hold_o   <= 1'b0;
      closed_o <= 1'b0;
    end
  end

  assign fault_o = 32'(fault_q);
  assign caused_o = any || state_q != RUN;
  assign stopping_o = state_q == RAMP || closing_o;
  assign closing_o = state_q == CLOSING;
  assign shut_o = state_q[1];

  logic unused;  // bits of absent axes, and of faults that are not built in
  assign unused = &{1'b0, data[31:Faults], clear_i};
endmodule

`default_nettype wire
