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
  logic [3:0] waiting_q;
  logic [3:0] direction_q;
  logic [3:0] below;  // is there a step in the place before
  logic [3:0] above;  // and behind
  logic [3:0] direction_above;
  assign below = {waiting_q[2:0], 1'b1};
  assign above = {1'b0, waiting_q[3:1]};
  assign direction_above = {1'b0, direction_q[3:1]};

  logic [1:0] phase_q;
  logic [1:0] phase_d;
  logic       dir_q;
  logic       same;  // a step waits that goes the way DIR points
  logic       same_q;
  logic       other_q;  // a step waits that goes the other way
  logic       go;  // a pulse begins
  logic       turn;  // DIR changes
  logic       load;  // a phase begins
  logic       expired_q;
  assign same = waiting_q[0] & (direction_q[0] == dir_q);
  assign go   = (same_q && phase_q == REST) || (expired_q && (phase_q == SETUP || (phase_q == SPACE && same_q)));
  assign turn = phase_q == REST && other_q && expired_q;
  assign load = (phase_q == REST) ? same_q | (other_q & expired_q) : expired_q;

  // The phase behind this one, if it ends now.
  always_comb begin
    case (phase_q)
      REST: phase_d = same_q ? HIGH : SETUP;
      SETUP: phase_d = HIGH;
      HIGH: phase_d = SPACE;
      default: phase_d = same_q ? HIGH : REST;
    endcase
  end

  always_ff @(posedge clk_i) begin
    if (load) phase_q <= phase_d;
    same_q  <= same;
    other_q <= waiting_q[0] & ~same;
    if (turn) dir_q <= ~dir_q;
    if (rst_i) begin
      phase_q <= REST;
      same_q  <= 1'b0;
      other_q <= 1'b0;
      dir_q   <= 1'b0;
    end
  end

  // The timer is zeroed as the phase begins, takes the time a clock later and counts down. Zero plus a time is a load,
  // plus ones a count: so one adder input serves both, and a second time is merged in the same 4-input table
  // (it needs no carry: in the clock of a load there is none). The adder's carry says that the timer is not zero.
  logic [15:0] pulse_time_q;  // all ones but in the first clock of a phase
  logic [15:0] dir_time_q;
  logic        take_pulse_time;
  logic [15:0] timer_q;
  logic [15:0] timer_sum;
  logic        nonzero;
  logic        loading_q;
  assign take_pulse_time = phase_q == HIGH || phase_q == SETUP || same_q;
  assign {nonzero, timer_sum} = {1'b0, timer_q} + {1'b0, pulse_time_q};

  always_ff @(posedge clk_i) begin
    pulse_time_q <= (phase_q == HIGH) ? step_space_i : step_length_i;
    if (!take_pulse_time) pulse_time_q <= '0;
    if (!load) pulse_time_q <= '1;
    dir_time_q <= take_pulse_time ? '0 : (phase_q == REST) ? dir_setup_i : dir_hold_i;
    timer_q <= timer_sum | (dir_time_q & ~pulse_time_q);
    if (load) timer_q <= '0;
    loading_q <= load;
    expired_q <= ~load & (expired_q | (~loading_q & ~nonzero));
    if (rst_i) expired_q <= 1'b1;
  end

  // A step that finds all places taken is dropped, which is the fault.
  for (genvar i = 0; i < 4; i++) begin : g_place
    always_ff @(posedge clk_i) begin
      if (go ^ step_i) waiting_q[i] <= go ? above[i] : below[i];
      if (go) direction_q[i] <= above[i] ? direction_above[i] : dir_i;
      else if (!waiting_q[i]) direction_q[i] <= dir_i;
      if (rst_i) waiting_q[i] <= 1'b0;
    end
  end

  // Faults: no place left, or a step that waited from one hold tick to the next without any being served.
  logic waited_q;
  always_ff @(posedge clk_i) begin
    if (go) waited_q <= 1'b0;
    else if (hold_tick_i) waited_q <= waiting_q[0];
    if (clear_fault_i) fault_o <= 1'b0;
    if (~go & ((step_i & waiting_q[3]) | (hold_tick_i & waited_q))) fault_o <= 1'b1;
    if (rst_i) begin
      waited_q <= 1'b0;
      fault_o  <= 1'b0;
    end
  end

  // Pins. In quadrature they are the position's two low bits, as they will be, in Gray code (first pin leads forwards).
  logic       go_q;
  logic       settled_q;
  logic       begun_q;  // first clock of the pulse, when the timer holds its time
  logic       pulse_q;
  logic [1:0] place;
  assign place = begun_q ? position_o[1:0] + {dir_q, 1'b1} : position_o[1:0];

  always_ff @(posedge clk_i) begin
    go_q <= go;
    settled_q <= go_q;
    begun_q <= settled_q;
    pulse_q <= settled_q | (pulse_q & nonzero & ~expired_q);
    if (begun_q) position_o <= position_o + {{31{dir_q}}, 1'b1};
    busy_o <= step_i | waiting_q[0] | (phase_q != REST) | ~expired_q;
    case (mode_i[1:0])
      2'd0: {dir_o, step_o} <= mode_i[3:2] ^ {dir_q, pulse_q};
      2'd1: {dir_o, step_o} <= mode_i[3:2] ^ {pulse_q & dir_q, pulse_q & ~dir_q};
      default: {dir_o, step_o} <= mode_i[3:2] ^ {place[1], place[1] ^ place[0]};
    endcase
    if (rst_i) begin
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
