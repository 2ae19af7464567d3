// Step shaper of one axis: turns one-clock steps into pulses at the pins that keep the drive's times, and counts the
// position by what the pins show.
//
// One timer serves all four times; a phase whose time is t lasts t + 3 clocks, of which a pulse shows max(1, t), from
// the third on. So a pulse is high for exactly max(1, length); low for space + 6 clocks between pulses at the highest
// rate (5 for length 0); DIR changes hold + 3 clocks or more behind the space, and is set up for setup + 5. Pins and
// position are one register behind the phases.
`default_nettype none

module step_shaper (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic        step_i,
    input  wire logic        dir_i,
    input  wire logic [15:0] step_length_i,
    input  wire logic [15:0] step_space_i,
    input  wire logic [15:0] dir_setup_i,
    input  wire logic [15:0] dir_hold_i,
    input  wire logic [ 3:0] mode_i,
    input  wire logic        hold_tick_i,
    input  wire logic        clear_fault_i,
    output logic             step_o,
    output logic             dir_o,
    output logic      [31:0] position_o,
    output logic             busy_o,
    output logic             fault_o
);

  // REST: the direction's hold, and waiting for steps.
  localparam logic [1:0] REST = 2'd0;
  localparam logic [1:0] SETUP = 2'd1;
  localparam logic [1:0] HIGH = 2'd2;
  localparam logic [1:0] SPACE = 2'd3;

  // Waiting steps, the next one at 0: a thermometer of valid flags and a direction each.
  logic [ 3:0] waiting_q;
  logic [ 3:0] direction_q;
  logic [ 1:0] phase_q;
  logic        dir_q;
  logic        same_q;  // a step waits that goes the way DIR points
  logic        other_q;  // a step waits that goes the other way
  logic        waited_q;  // since the last hold tick
  // The timer is zeroed as the phase begins, takes the time a clock later and counts down. Zero plus a time is a load,
  // plus ones a count: so one adder input serves both, and a second time is merged in the same 4-input table
  // (it needs no carry: in the clock of a load there is none). The adder's carry says that the timer is not zero.
  logic [15:0] pulse_time_q;  // all ones but in the first clock of a phase
  logic [15:0] dir_time_q;
  logic [15:0] timer_q;
  logic        loading_q;
  logic        expired_q;
  // The pulse, behind the phases.
  logic        go_q;
  logic        settled_q;
  logic        begun_q;  // first clock of the pulse, when the timer holds its time
  logic        pulse_q;

  function automatic logic [1:0] gray(input logic [1:0] place);
    gray = place ^ {1'b0, place[1]};
  endfunction

  always_ff @(posedge clk_i) begin : p_shaper
    logic        busy;
    logic [ 3:0] below;  // is there a step in the place before
    logic [ 3:0] above;  // and behind
    logic [ 3:0] direction_above;
    logic        same;
    logic        go;  // a pulse begins
    logic        turn;  // DIR changes
    logic        load;  // a phase begins
    logic        take_pulse_time;
    logic        nonzero;
    logic [15:0] timer_sum;

    // Each flip-flop is read before it is written: so a simulator needs no copy of it.
    busy = step_i | waiting_q[0] | (phase_q != REST) | ~expired_q;
    go   = (same_q && phase_q == REST) || (expired_q && (phase_q == SETUP || (phase_q == SPACE && same_q)));
    load = (phase_q == REST) ? same_q | (other_q & expired_q) : expired_q;

    // Pins. In quadrature they are the position's two low bits, as they will be, in Gray code (first pin leads forwards).
    case (mode_i[1:0])
      2'd0: {dir_o, step_o} <= mode_i[3:2] ^ {dir_q, pulse_q};
      2'd1: {dir_o, step_o} <= mode_i[3:2] ^ {pulse_q & dir_q, pulse_q & ~dir_q};
      default: {dir_o, step_o} <= mode_i[3:2] ^ gray(position_o[1:0] + (begun_q ? {dir_q, 1'b1} : 2'd0));
    endcase

    // Faults: no place left, or a step that waited from one hold tick to the next without any being served.
    if (clear_fault_i) fault_o <= 1'b0;
    if (~go & ((step_i & waiting_q[3]) | (hold_tick_i & waited_q))) fault_o <= 1'b1;
    if (go) waited_q <= 1'b0;
    else if (hold_tick_i) waited_q <= waiting_q[0];

    same = waiting_q[0] & (direction_q[0] == dir_q);
    if (begun_q) position_o <= position_o + {{31{dir_q}}, 1'b1};
    {nonzero, timer_sum} = {1'b0, timer_q} + {1'b0, pulse_time_q};
    timer_q <= timer_sum | (dir_time_q & ~pulse_time_q);
    if (load) timer_q <= '0;
    pulse_q <= settled_q | (pulse_q & nonzero & ~expired_q);
    begun_q <= settled_q;
    settled_q <= go_q;
    go_q <= go;

    expired_q <= ~load & (expired_q | (~loading_q & ~nonzero));
    loading_q <= load;

    take_pulse_time = phase_q == HIGH || phase_q == SETUP || same_q;
    dir_time_q   <= take_pulse_time ? '0 : (phase_q == REST) ? dir_setup_i : dir_hold_i;
    pulse_time_q <= '1;
    if (load) pulse_time_q <= !take_pulse_time ? '0 : (phase_q == HIGH) ? step_space_i : step_length_i;

    turn = phase_q == REST && other_q && expired_q;
    if (load) begin
      case (phase_q)
        REST: phase_q <= same_q ? HIGH : SETUP;
        SETUP: phase_q <= HIGH;
        HIGH: phase_q <= SPACE;
        default: phase_q <= same_q ? HIGH : REST;
      endcase
    end
    same_q  <= same;
    other_q <= waiting_q[0] & ~same;
    if (turn) dir_q <= ~dir_q;

    // A step that finds all places taken is dropped, which is the fault.
    if (go | step_i) begin
      below = {waiting_q[2:0], 1'b1};
      above = {1'b0, waiting_q[3:1]};
      direction_above = {1'b0, direction_q[3:1]};
      for (int i = 0; i < 4; i++) begin
        if (go) direction_q[i] <= above[i] ? direction_above[i] : dir_i;
        else if (!waiting_q[i]) direction_q[i] <= dir_i;
      end
      if (go ^ step_i) waiting_q <= go ? above : below;
    end

    busy_o <= busy;

    if (rst_i) begin
      phase_q <= REST;
      same_q <= 1'b0;
      other_q <= 1'b0;
      dir_q <= 1'b0;
      expired_q <= 1'b1;
      waiting_q <= '0;
      waited_q <= 1'b0;
      fault_o <= 1'b0;
      go_q <= 1'b0;
      settled_q <= 1'b0;
      begun_q <= 1'b0;
      pulse_q <= 1'b0;
      position_o <= '0;
      busy_o <= 1'b0;
      {dir_o, step_o} <= mode_i[3:2];
    end
  end

endmodule

`default_nettype wire
