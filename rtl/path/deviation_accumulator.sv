// Deviation accumulator: a conic or a line, one unit step a path tick, from the sign of the deviation F.
//
// A step of s in x does F += s*GX + CX/2 and GX += s*CX, in y likewise. Only the axis that steps is touched, so one
// set of three 16-bit adders serves both. With U = s*G + CX/2 the two updates are F + U and s*(U + CX/2); a negative
// s is an inversion on the way in and on the way out, and its missing one enters as the carry into F.
//
// Timing: a tick at c gives its step at c+2 and ready_o again at c+9; start_i at c gives ready_o at c+2.
// A load halfword makes the block unready until the next start_i: two clocks after END_X, END_Y, QUADRANTS, else one.
// load_i and start_i are given only at rest; all nine chains are loaded before a start.
`default_nettype none

module deviation_accumulator (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic        clear_i,
    input  wire logic [21:0] load_i,
    input  wire logic        start_i,
    input  wire logic        tick_i,
    output logic             step_x_o,
    output logic             dir_x_o,
    output logic             step_y_o,
    output logic             dir_y_o,
    output logic             ready_o,
    output logic             stepping_o,  // not in the last five clocks before ready_o (combinational)
    output logic             at_end_o
);
  // Words that travel: 5 words of G enter the adders in phases 0..4 and come back three clocks later, in 3..7.
  localparam int LAST = 7;

  logic [79:0] f_q, gx_q, gy_q;
  logic [47:0] hx_q, hy_q;  // CX/2, CY/2
  logic [31:0] ex_q, ey_q;  // displacement that remains
  logic [15:0] quadrants_q;
  logic        clockwise_q;

  // Its targets on the load bus. The chains take a halfword a clock late: the choice among so many is in no long path.
  logic [15:0] word;
  logic [ 8:0] load;
  logic        loading;
  logic        loading_q;
  assign loading = load_i[21] && load_i[20:16] >= load_target_pkg::DEVIATION && load_i[20:16] <= load_target_pkg::PLANE;
  always_ff @(posedge clk_i) begin
    word <= load_i[15:0];
    loading_q <= loading;
    for (int i = 0; i < 9; i++) begin
      load[i] <= load_i[21] && load_i[20:16] == load_target_pkg::DEVIATION + 5'(i);
    end
  end

  // Control: one-hot phase of a step, and enables registered a clock ahead.
  logic [LAST:0] phase_q;
  logic start_q, g_shift_q, f_shift_q, h_shift_q, e_shift_q;
  logic drop, accept;
  assign drop = rst_i | clear_i | loading;
  assign accept = ready_o & tick_i & ~at_end_o;
  assign stepping_o = phase_q[3:0] != '0;

  always_ff @(posedge clk_i) begin
    if (drop) begin
      phase_q   <= '0;
      start_q   <= 1'b0;
      ready_o   <= 1'b0;
      g_shift_q <= 1'b0;
      f_shift_q <= 1'b0;
      h_shift_q <= 1'b0;
      e_shift_q <= 1'b0;
    end else if (accept | g_shift_q | start_i | start_q) begin
      phase_q   <= {phase_q[LAST-1:0], accept};
      start_q   <= start_i;
      ready_o   <= phase_q[LAST] | start_q;
      g_shift_q <= accept | (|phase_q[LAST-1:0]);
      f_shift_q <= |phase_q[6:1];
      h_shift_q <= accept | (|phase_q[1:0]);
      e_shift_q <= accept | (|phase_q[2:0]);
    end
  end

  // Choice of the next step, renewed at rest, held while the step is made.
  logic x_zero_q, y_zero_q, done_q, finish_q, select_x_q, negative_q, old_sign_q;
  always_ff @(posedge clk_i) begin : p_choice_of_step
    logic gx_negative, gy_negative, x_negative, y_negative, x_table, x_reached, y_reached, finish;

    if (ready_o) begin
      gx_negative = gx_q[79];
      gy_negative = gy_q[79];
      x_negative = clockwise_q ^ ~gy_negative;
      y_negative = clockwise_q ^ gx_negative;
      x_table = ~(f_q[79] ^ gx_negative ^ gy_negative ^ clockwise_q);  // the 16-entry table's axis
      x_reached = x_zero_q | (ex_q[31] ^ x_negative);
      y_reached = y_zero_q | (ey_q[31] ^ y_negative);
      finish = finish_q | (done_q & (x_reached | y_reached));
      finish_q <= finish;
      if (finish ? ~x_zero_q : x_table) begin
        select_x_q <= 1'b1;
        negative_q <= finish ? ex_q[31] : x_negative;
        old_sign_q <= gx_negative;
      end else begin
        select_x_q <= 1'b0;
        negative_q <= finish ? ey_q[31] : y_negative;
        old_sign_q <= gy_negative;
      end
    end
    if (start_q) finish_q <= 1'b0;
  end

  // The words of the stepping axis: inverted gradient, half second difference (3 words, then zeros), displacement.
  logic [15:0] g_q, h_q, h_late_q, e_q, u_q, v_q, sum_q, rest_q;
  logic u_carry_q, v_carry_q, f_carry_q, e_carry_q;
  logic [16:0] u_sum, v_sum, f_sum, e_sum;
  assign u_sum = {1'b0, g_q} + {1'b0, h_q} + {16'd0, u_carry_q};
  assign v_sum = {1'b0, u_q} + {1'b0, h_late_q} + {16'd0, v_carry_q};
  assign f_sum = {1'b0, f_q[15:0]} + {1'b0, u_q} + {16'd0, f_carry_q};
  assign e_sum = {1'b0, e_q} + {1'b0, {16{~negative_q}}} + {16'd0, e_carry_q};

  always_ff @(posedge clk_i) begin
    // Between steps the words rest; what they held before a step's first phase never counts.
    if (g_shift_q) begin
      g_q <= (select_x_q ? gx_q[15:0] : gy_q[15:0]) ^ {16{negative_q}};
      h_q <= h_shift_q ? (select_x_q ? hx_q[15:0] : hy_q[15:0]) : 16'd0;
      h_late_q <= h_q;
      e_q <= select_x_q ? ex_q[15:0] : ey_q[15:0];
      {u_carry_q, u_q} <= u_sum & {~phase_q[0], 16'hFFFF};
      {v_carry_q, v_q} <= v_sum & {~phase_q[1], 16'hFFFF};
      {f_carry_q, sum_q} <= f_sum;
      if (phase_q[1]) f_carry_q <= negative_q;
      {e_carry_q, rest_q} <= e_sum;
      if (phase_q[0]) e_carry_q <= negative_q;
    end
  end

  // State: shift chains; a chain that travels is full again when its last word is back.
  logic [15:0] g_back;
  assign g_back = v_q ^ {16{negative_q}};
  always_ff @(posedge clk_i) begin
    if (loading_q | g_shift_q) begin
      if (load[0] | f_shift_q) f_q <= {load[0] ? word : sum_q, f_q[79:16]};
      if (load[1] | (g_shift_q & select_x_q)) gx_q <= {load[1] ? word : g_back, gx_q[79:16]};
      if (load[2] | (g_shift_q & ~select_x_q)) gy_q <= {load[2] ? word : g_back, gy_q[79:16]};
      if (load[3] | (h_shift_q & select_x_q)) hx_q <= {load[3] ? word : hx_q[15:0], hx_q[47:16]};
      if (load[4] | (h_shift_q & ~select_x_q)) hy_q <= {load[4] ? word : hy_q[15:0], hy_q[47:16]};
      if (load[5] | (e_shift_q & select_x_q)) ex_q <= {load[5] ? word : rest_q, ex_q[31:16]};
      if (load[6] | (e_shift_q & ~select_x_q)) ey_q <= {load[6] ? word : rest_q, ey_q[31:16]};
      if (load[8]) clockwise_q <= word[0];
    end
  end

  // Quadrants: the last one is foreseen, so that at_end_o and the next choice know of it with the sign itself. With
  // the upper bits 0 the change takes the last one: at 0 done_q is set already, and the count no longer matters.
  logic upper_zero_q, change, done;
  assign change = phase_q[LAST] & (g_back[15] ^ old_sign_q);
  assign done   = start_q ? upper_zero_q & ~quadrants_q[0] : done_q | (change & upper_zero_q);
  always_ff @(posedge clk_i) begin
    if (load[7]) quadrants_q <= word;
    else if (change) quadrants_q <= quadrants_q - 16'd1;
    // The flags of what a start finds, and of what a step leaves.
    if (start_i | g_shift_q) begin
      upper_zero_q <= quadrants_q[15:1] == 15'd0;
      x_zero_q <= ex_q == 32'd0;
      y_zero_q <= ey_q == 32'd0;
    end
    if (start_q | phase_q[LAST]) done_q <= done;
    if (drop) at_end_o <= 1'b0;
    else if (start_q | phase_q[LAST]) at_end_o <= done & x_zero_q & y_zero_q;
  end

  always_ff @(posedge clk_i) begin
    if (rst_i | clear_i) begin
      step_x_o <= 1'b0;
      step_y_o <= 1'b0;
    end else if (g_shift_q) begin
      step_x_o <= phase_q[0] & select_x_q;
      step_y_o <= phase_q[0] & ~select_x_q;
    end
    if (rst_i) begin
      dir_x_o <= 1'b0;
      dir_y_o <= 1'b0;
    end else if (phase_q[0] & ~clear_i) begin
      if (select_x_q) dir_x_o <= negative_q;
      else dir_y_o <= negative_q;
    end
  end
endmodule

`default_nettype wire
