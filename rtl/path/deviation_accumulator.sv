// Deviation accumulator: makes a conic or a line, one step per path tick. In 4 directions it makes a unit step, chosen
// by the sign of the deviation F. In 8 directions (the path's bit of PLANE) it steps along x, y or both, whichever
// leaves the least deviation.
//
// A step of s in x does F += s*GX + CX/2 and GX += s*CX; a step in y does the same with GY and CY; all word by word
// (deviation_steps). In 8 directions a second pass, in which all words circulate unchanged, compares the candidates
// for the next step (deviation_compare).
//
// Timing: a tick at c gives its step at c+2 and ready_o again at c+9; start_i at c gives ready_o at c+2. In 8
// directions ready_o comes 8 clocks later each time. A loaded halfword makes the block unready until the next start_i,
// which comes at the earliest two clocks after END_X, END_Y and QUADRANTS, and one clock after the others.
// load_i and start_i are given only at rest; all nine chains are loaded before a start.
`default_nettype none

module deviation_accumulator #(
    parameter int EightDirections = 0  // 1: with paths in 8 directions
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic clear_i,
    input wire logic [load_bus_pkg::WIDTH-1:0] load_i,
    input wire logic start_i,
    input wire logic tick_i,
    output logic step_x_o,
    output logic dir_x_o,
    output logic step_y_o,
    output logic dir_y_o,
    output logic ready_o,
    output logic stepping_o,  // a step is under way, except in the last four clocks before ready_o (combinational)
    output logic at_end_o
);
  // Words in transit: 5 words of G enter the adders in phases 0..4 and come back three clocks later, in 3..7.
  localparam int LAST = 7;

  logic [79:0] f_q, gx_q, gy_q;
  logic [47:0] hx_q, hy_q;  // CX/2, CY/2
  logic [31:0] ex_q, ey_q;  // remaining displacement
  logic [15:0] quadrants_q;
  logic        clockwise_q;
  logic        eight_q;  // this path's step rule: 8 directions

  // Chains by their target on the load bus.
  localparam int F = 32'(load_target_pkg::DEVIATION[3:0]);
  localparam int GX = 32'(load_target_pkg::GRADIENT_X[3:0]);
  localparam int GY = 32'(load_target_pkg::GRADIENT_Y[3:0]);
  localparam int HX = 32'(load_target_pkg::HALF_X[3:0]);
  localparam int HY = 32'(load_target_pkg::HALF_Y[3:0]);
  localparam int EX = 32'(load_target_pkg::END_X[3:0]);
  localparam int EY = 32'(load_target_pkg::END_Y[3:0]);
  localparam int QUADRANTS = 32'(load_target_pkg::QUADRANTS[3:0]);
  localparam int PLANE = 32'(load_target_pkg::PLANE[3:0]);

  // The chains take a halfword one clock late, so that the selection among so many chains is in no long path.
  logic [15:0] word;
  logic [ 8:0] load;
  logic        loading;
  logic        loading_q;
  assign loading = load_bus_pkg::to_unit(load_i, load_target_pkg::UNIT_ACCUMULATOR);
  always_ff @(posedge clk_i) begin
    word <= load_bus_pkg::word(load_i);
    loading_q <= loading;
    for (int i = 0; i < 9; i++) load[i] <= load_bus_pkg::to(load_i, load_target_pkg::DEVIATION + 9'(i));
  end

  // Control: one-hot phases of a step and of the comparing pass, and enables registered one clock ahead.
  logic [LAST:0] phase_q;
  logic [LAST:0] compare_q;
  logic run_q, start_q, turn_q, g_shift_q, f_shift_q, f_turn_q, h_shift_q, e_shift_q;
  logic drop, accept, compare, settled;
  assign drop = rst_i | clear_i | loading;
  assign accept = ready_o & tick_i & ~at_end_o;
  assign compare = eight_q & (phase_q[LAST] | start_q);
  assign settled = ((phase_q[LAST] | start_q) & ~eight_q) | compare_q[LAST];
  assign stepping_o = phase_q[3:0] != '0 | compare_q[3:0] != '0 | (eight_q & (phase_q[LAST:4] != '0 | start_q));

  always_ff @(posedge clk_i) begin
    if (drop) begin
      phase_q   <= '0;
      compare_q <= '0;
      run_q     <= 1'b0;
      start_q   <= 1'b0;
      ready_o   <= 1'b0;
      turn_q    <= 1'b0;
      g_shift_q <= 1'b0;
      f_shift_q <= 1'b0;
      f_turn_q  <= 1'b0;
      h_shift_q <= 1'b0;
      e_shift_q <= 1'b0;
    end else if (accept | run_q | start_i | start_q) begin
      phase_q   <= {phase_q[LAST-1:0], accept};
      compare_q <= {compare_q[LAST-1:0], compare};
      start_q   <= start_i;
      ready_o   <= settled;
      run_q     <= accept | (|phase_q[LAST-1:0]) | compare | (|compare_q[LAST-1:0]);
      turn_q    <= compare | (|compare_q[3:0]);
      g_shift_q <= accept | (|phase_q[LAST-1:0]) | compare | (|compare_q[3:0]);
      f_shift_q <= |phase_q[6:1] | (eight_q & phase_q[LAST]) | (|compare_q[5:1]);
      f_turn_q  <= |compare_q[5:1];
      h_shift_q <= accept | (|phase_q[1:0]) | compare | (|compare_q[1:0]);
      e_shift_q <= accept | (|phase_q[2:0]);
    end
  end

  // Choice of the next step, and the words that come back to the chains' ends. Pairs are {y, x}.
  logic x_zero_q, y_zero_q, done_q, finish, finish_q;
  logic [1:0] take, negative, old_sign, sides;
  logic [ 1:0] came;  // the last word of the axis's gradient comes back from the step, with its sign
  logic [15:0] f_back;
  logic [31:0] g_back, e_back, halves;
  assign halves = {hy_q[15:0], hx_q[15:0]} & {32{h_shift_q}};
  assign came   = take & {2{phase_q[LAST]}};

  deviation_choice #(
      .EightDirections(EightDirections)
  ) next_step (
      .clk_i,
      .rest_i(ready_o),
      .eight_i(eight_q),
      .clockwise_i(clockwise_q),
      .inside_i(f_q[79]),
      .gradient_i({gy_q[79], gx_q[79]}),
      .compare_i(compare),
      .next_i({came[1] ? g_back[31] : gy_q[79], came[0] ? g_back[15] : gx_q[79]}),
      .sides_i(sides),
      .last_i(done_q),
      .left_i({ey_q[31], ex_q[31]}),
      .arrived_i({y_zero_q, x_zero_q}),
      .finishing_i(finish_q),
      .finish_o(finish),
      .take_o(take),
      .negative_o(negative),
      .old_sign_o(old_sign)
  );

  always_ff @(posedge clk_i) begin
    if (ready_o) finish_q <= finish;
    if (start_q) finish_q <= 1'b0;
  end

  deviation_steps #(
      .EightDirections(EightDirections)
  ) steps (
      .clk_i,
      .run_i(run_q),
      .phase_i(phase_q[2:0] | compare_q[2:0]),
      .eight_i(eight_q),
      .take_i(take),
      .negative_i(negative),
      .f_i(f_q[15:0]),
      .gradient_i({gy_q[15:0], gx_q[15:0]}),
      .half_i(halves),
      .left_i({ey_q[15:0], ex_q[15:0]}),
      .f_o(f_back),
      .gradient_o(g_back),
      .left_o(e_back),
      .sides_o(sides)
  );

  // State: shift chains. A chain that rotates is complete again when its last word is back.
  always_ff @(posedge clk_i) begin
    if (loading_q | run_q) begin
      if (load[F] | f_shift_q) f_q <= {load[F] ? word : f_turn_q ? f_q[15:0] : f_back, f_q[79:16]};
      if (load[GX] | (g_shift_q & take[0])) gx_q <= {load[GX] ? word : turn_q ? gx_q[15:0] : g_back[15:0], gx_q[79:16]};
      if (load[GY] | (g_shift_q & take[1]))
        gy_q <= {load[GY] ? word : turn_q ? gy_q[15:0] : g_back[31:16], gy_q[79:16]};
      if (load[HX] | (h_shift_q & take[0])) hx_q <= {load[HX] ? word : hx_q[15:0], hx_q[47:16]};
      if (load[HY] | (h_shift_q & take[1])) hy_q <= {load[HY] ? word : hy_q[15:0], hy_q[47:16]};
      if (load[EX] | (e_shift_q & take[0])) ex_q <= {load[EX] ? word : e_back[15:0], ex_q[31:16]};
      if (load[EY] | (e_shift_q & take[1])) ey_q <= {load[EY] ? word : e_back[31:16], ey_q[31:16]};
      if (load[PLANE]) clockwise_q <= word[0];
    end
  end

  if (EightDirections != 0) begin : gen_eight_directions
    always_ff @(posedge clk_i) begin
      if (load[PLANE]) eight_q <= word[1];
    end
  end else begin : gen_four_directions
    assign eight_q = 1'b0;
  end

  // Quadrants: the last change is predicted, so that at_end_o and the next choice know of it together with the sign
  // itself. If the upper bits are 0, the change uses up the last quadrant; at 0 done_q is set already, and the count no
  // longer matters.
  logic upper_zero_q, change, done;
  assign change = |(came & ({g_back[31], g_back[15]} ^ old_sign));
  assign done   = start_q ? upper_zero_q & ~quadrants_q[0] : done_q | (change & upper_zero_q);
  always_ff @(posedge clk_i) begin
    if (load[QUADRANTS]) quadrants_q <= word;
    else if (change) quadrants_q <= quadrants_q - 16'd1;
    // Flags of the state at a start, and after a step.
    if (start_i | run_q) begin
      upper_zero_q <= quadrants_q[15:1] == 15'd0;
      x_zero_q <= ex_q == 32'd0;
      y_zero_q <= ey_q == 32'd0;
    end
    if (start_q | phase_q[LAST]) done_q <= done;
    if (drop) at_end_o <= 1'b0;
    else if (settled) at_end_o <= done & x_zero_q & y_zero_q;
  end

  always_ff @(posedge clk_i) begin
    if (rst_i | clear_i) begin
      step_x_o <= 1'b0;
      step_y_o <= 1'b0;
    end else if (run_q) begin
      step_x_o <= phase_q[0] & take[0];
      step_y_o <= phase_q[0] & take[1];
    end
    if (rst_i) begin
      dir_x_o <= 1'b0;
      dir_y_o <= 1'b0;
    end else if (phase_q[0] & ~clear_i) begin
      if (take[0]) dir_x_o <= negative[0];
      if (take[1]) dir_y_o <= negative[1];
    end
  end
endmodule

`default_nettype wire
