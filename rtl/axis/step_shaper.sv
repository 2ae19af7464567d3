// Step shaper of one axis: turns one-clock steps into pulses at the pins that respect the drive's timing. The position
// counts the pulses that the pins show.
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
    input  wire logic [ 1:0] idle_level_i,   // level in reset: {second pin, first pin}
    input  wire logic        wait_tick_i,
    output logic             step_o,
    output logic             dir_o,
    output logic      [31:0] position_o,
    output logic             begun_o,        // event: a pulse begins; position_o includes it from the next clock on
    output logic             back_o,         // with begun_o: 1 backwards, 0 forwards
    output logic             busy_o,
    output logic             fault_o         // event
);
  logic any;
  logic same;
  logic other;
  logic go;
  logic resting;
  logic dir;
  logic begun;
  logic pulse;

  waiting_steps waiting (
      .clk_i,
      .rst_i,
      .step_i,
      .dir_i,
      .points_i(dir),
      .take_i(go),
      .wait_tick_i,
      .any_o(any),
      .same_o(same),
      .other_o(other),
      .fault_o
  );

  step_phases phases (
      .clk_i,
      .rst_i,
      .same_i(same),
      .other_i(other),
      .step_length_i,
      .step_space_i,
      .dir_setup_i,
      .dir_hold_i,
      .go_o(go),
      .resting_o(resting),
      .dir_o(dir),
      .begun_o(begun),
      .pulse_o(pulse)
  );

  assign begun_o = begun;
  assign back_o  = dir;

  always_ff @(posedge clk_i) begin
    busy_o <= step_i || any || !resting;
    if (rst_i) busy_o <= 1'b0;
  end

  // The two pins in the axis's mode, and the position that they show. Both are registered one clock after the pulse.
  function automatic logic [1:0] gray(input logic [1:0] place);
    gray = place ^ {1'b0, place[1]};
  endfunction

  always_ff @(posedge clk_i) begin
    // In quadrature the pins are the two low bits of the new position in Gray code (the first pin leads in forward
    // motion).
    case (mode_i[1:0])
      2'd0: {dir_o, step_o} <= mode_i[3:2] ^ {dir, pulse};
      2'd1: {dir_o, step_o} <= mode_i[3:2] ^ {pulse && dir, pulse && !dir};
      default: {dir_o, step_o} <= mode_i[3:2] ^ gray(position_o[1:0] + (begun ? {dir, 1'b1} : 2'd0));
    endcase
    if (begun) position_o <= position_o + {{31{dir}}, 1'b1};
    if (rst_i) begin
      {dir_o, step_o} <= idle_level_i;
      position_o <= '0;
    end
  end
endmodule

`default_nettype wire
