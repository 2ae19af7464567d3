// Step shaper of one axis: turns one-clock steps into pulses at the pins that keep the drive's times, and counts the
// position by what the pins show.
//
// One timer serves all four times; a phase whose time is t lasts t + 2 clocks, of which a pulse shows max(1, t). So a
// pulse is high for exactly max(1, length); low for space + 4 clocks between pulses at the highest rate; DIR
// changes hold + 2 clocks or more behind the space, and is set up for setup + 2. Pins and position are one register
// behind the phases.
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
    output logic [31:0]      position_o,
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

  logic [ 1:0] phase_q;
  logic [ 1:0] phase_d;
  logic        dir_q;
  logic        same;     // a step waits that goes the way DIR points
  logic        same_q;
  logic        other_q;  // a step waits that goes the other way
  logic        go;       // a pulse begins
  logic        turn;     // DIR changes
  logic        load;
  logic [15:0] pulse_time_q;  // the times that may follow, chosen a clock ahead: no phase is shorter than 2 clocks
  logic [15:0] dir_time_q;
  logic [15:0] next_time;
  logic [15:0] timer_q;
  logic [15:0] timer_sum;
  logic        run_out;
  logic        expired_q;
  assign same = waiting_q[0] & (direction_q[0] == dir_q);
  assign go = (phase_q == REST && same_q) || (phase_q == SPACE && same_q && expired_q) || (phase_q == SETUP && expired_q);
  assign turn = phase_q == REST && other_q && expired_q;
  assign load = go | turn | (phase_q[1] & expired_q);

  always_comb begin
    phase_d = phase_q;
    if (go) phase_d = HIGH;
    else if (turn) phase_d = SETUP;
    else if (phase_q == HIGH && expired_q) phase_d = SPACE;
    else if (phase_q == SPACE && expired_q) phase_d = REST;
  end

  // The timer counts up from the inverted time to all ones. The added load enable changes nothing (a load overrides
  // the sum); it lets table and carry share an input.
  assign next_time = (phase_q == HIGH || phase_q == SETUP || same_q) ? pulse_time_q : dir_time_q;
  assign timer_sum = timer_q + {16{load}} + 16'd1;
  assign run_out = &timer_q;

  always_ff @(posedge clk_i) begin
    phase_q <= phase_d;
    pulse_time_q <= (phase_q == HIGH) ? step_space_i : step_length_i;
    dir_time_q <= (phase_q == REST) ? dir_setup_i : dir_hold_i;
    same_q <= same;
    other_q <= waiting_q[0] & ~same;
    timer_q <= load ? ~next_time : timer_sum;
    expired_q <= ~load & (expired_q | run_out);
    if (turn) dir_q <= ~dir_q;
    if (rst_i) begin
      phase_q <= REST;
      expired_q <= 1'b1;
      same_q <= 1'b0;
      other_q <= 1'b0;
      dir_q <= 1'b0;
    end
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
  logic       begun_q;  // first clock of the pulse
  logic       pulse;
  logic [1:0] place;
  assign pulse = phase_q == HIGH && (begun_q || !(run_out || expired_q));
  assign place = begun_q ? position_o[1:0] + {dir_q, 1'b1} : position_o[1:0];

  always_ff @(posedge clk_i) begin
    begun_q <= go & ~rst_i;
    if (begun_q) position_o <= position_o + {{31{dir_q}}, 1'b1};
    busy_o <= step_i | waiting_q[0] | (phase_q != REST) | ~expired_q;
    case (mode_i[1:0])
      2'd0: {dir_o, step_o} <= mode_i[3:2] ^ {dir_q, pulse};
      2'd1: {dir_o, step_o} <= mode_i[3:2] ^ {pulse & dir_q, pulse & ~dir_q};
      default: {dir_o, step_o} <= mode_i[3:2] ^ {place[1], place[1] ^ place[0]};
    endcase
    if (rst_i) begin
      position_o <= '0;
      busy_o <= 1'b0;
      {dir_o, step_o} <= mode_i[3:2];
    end
  end

endmodule

`default_nettype wire
