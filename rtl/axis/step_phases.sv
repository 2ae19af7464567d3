// The phases of a step and their timer: when a pulse begins and ends and when DIR may change.
//
// One timer serves all four times. A phase with the time t lasts t + 3 clocks; a pulse is visible for max(1, t) of
// them, from the third on. So a pulse is high for exactly max(1, length) clocks. At the highest rate it is low for
// space + 6 clocks between pulses (space + 5 for length 0). DIR changes at least hold + 3 clocks after the space, and
// is set up for setup + 5.
`default_nettype none

module step_phases (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic        same_i,         // a waiting step has DIR's direction
    input  wire logic        other_i,        // a waiting step has the other direction
    input  wire logic [15:0] step_length_i,
    input  wire logic [15:0] step_space_i,
    input  wire logic [15:0] dir_setup_i,
    input  wire logic [15:0] dir_hold_i,
    output logic             go_o,           // a step is served now (combinational)
    output logic             resting_o,      // no phase runs, DIR's hold time is over (combinational)
    output logic             dir_o,
    output logic             begun_o,        // first clock of a pulse
    output logic             pulse_o
);
  // REST is DIR's hold time, and then the wait for a step.
  typedef enum logic [1:0] {
    REST,
    SETUP,
    HIGH,
    SPACE
  } phase_e;

  phase_e phase_q;
  logic   expired_q;
  logic   load;  // a phase begins
  logic   turn;  // DIR changes

  assign load = (phase_q == REST) ? same_i || (other_i && expired_q) : expired_q;
  assign turn = phase_q == REST && other_i && expired_q;
  assign go_o = (same_i && phase_q == REST) || (expired_q && (phase_q == SETUP || (phase_q == SPACE && same_i)));
  assign resting_o = phase_q == REST && expired_q;

  always_ff @(posedge clk_i) begin
    if (load) begin
      case (phase_q)
        REST: phase_q <= same_i ? HIGH : SETUP;
        SETUP: phase_q <= HIGH;
        HIGH: phase_q <= SPACE;
        default: phase_q <= same_i ? HIGH : REST;
      endcase
    end
    if (turn) dir_o <= !dir_o;
    if (rst_i) begin
      phase_q <= REST;
      dir_o   <= 1'b0;
    end
  end

  // The timer is zeroed as the phase begins, takes the time a clock later and counts down. Adding a time to 0 loads it;
  // adding all ones counts down. So one adder input serves both. The second time is ORed in, within the same 4-input
  // table: it needs no carry, because no carry arises in the clock of a load. The adder's carry says that the timer is
  // not zero.
  logic [15:0] pulse_time_q;  // all ones except in the first clock of a phase
  logic [15:0] dir_time_q;
  logic [15:0] timer_q;
  logic [15:0] timer_sum;
  logic        nonzero;
  logic        loading_q;
  logic        take_pulse_time;
  assign {nonzero, timer_sum} = {1'b0, timer_q} + {1'b0, pulse_time_q};
  assign take_pulse_time = phase_q == HIGH || phase_q == SETUP || same_i;

  always_ff @(posedge clk_i) begin
    timer_q <= timer_sum | (dir_time_q & ~pulse_time_q);
    if (load) timer_q <= '0;
    loading_q <= load;
    expired_q <= !load && (expired_q || (!loading_q && !nonzero));
    if (rst_i) expired_q <= 1'b1;

    dir_time_q   <= take_pulse_time ? '0 : (phase_q == REST) ? dir_setup_i : dir_hold_i;
    pulse_time_q <= '1;
    if (load) pulse_time_q <= !take_pulse_time ? '0 : (phase_q == HIGH) ? step_space_i : step_length_i;
  end

  // The pulse follows its phase by three clocks; by then the timer holds the phase's time.
  logic go_q;
  logic settled_q;
  always_ff @(posedge clk_i) begin
    go_q      <= go_o;
    settled_q <= go_q;
    begun_o   <= settled_q;
    pulse_o   <= settled_q || (pulse_o && nonzero && !expired_q);
    if (rst_i) begin
      go_q      <= 1'b0;
      settled_q <= 1'b0;
      begun_o   <= 1'b0;
      pulse_o   <= 1'b0;
    end
  end
endmodule

`default_nettype wire
