// The feed generator: rate, acceleration and jerk of one profile piece, and a 48-bit phase whose carry is the tick.
//
// Enabled clocks 32k..32k+31 of a piece add clamp(R_k) to the phase; R_0 is the rate itself, unclamped.
// R and A are added in nibbles, 17 clocks for 68 bits, right after R_k was taken, so R_(k+1) and its comparison with
// the floor are ready 20 clocks later, 12 before the earliest need. A swap may come at any clock, also amid an update.
//
// The phase is 16 + 32 bits with a registered carry: everything of the upper 32 bits (its part of R, the floor, the
// slope) is taken one clock after the lower part. So the shadow must hold in the clock of a swap and behind it. Swaps are
// 24 clocks apart or more (the card's decoder takes longer to load a piece); nothing is enabled before the first one.
// An enable at c gives its tick at c+3; the rate shows with the same delay.
`default_nettype none

module feed_generator (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic        clear_i,
    input  wire logic        enable_i,
    input  wire logic [ 3:0] load_i,
    input  wire logic [15:0] word_i,
    input  wire logic        swap_i,
    output logic             tick_o,
    output logic      [31:0] rate_o
);
  localparam int Word = 4;
  // 64 fraction bits and a nibble: neither R nor A wraps within +-8.
  localparam int Width = 68;
  localparam logic [4:0] LAST_STEP = 5'd16;

  // The next piece, shifted in from the load bus.
  logic [63:0] next_rate_q, next_acceleration_q, next_jerk_q;
  logic [31:0] next_floor_q;
  always_ff @(posedge clk_i) begin
    if (load_i[0]) next_rate_q <= {word_i, next_rate_q[63:16]};
    if (load_i[1]) next_acceleration_q <= {word_i, next_acceleration_q[63:16]};
    if (load_i[2]) next_jerk_q <= {word_i, next_jerk_q[63:16]};
    if (load_i[3]) next_floor_q <= {word_i, next_floor_q[31:16]};
  end

  // Enabled clocks of the piece, modulo 32, and the moments at which the two parts of the slope are taken from R.
  logic [4:0] count_q;
  logic swap_q, load_low_q, load_high_q;
  always_ff @(posedge clk_i) begin
    if (rst_i || swap_i) count_q <= '0;
    else if (enable_i) count_q <= count_q + 5'd1;
    swap_q <= swap_i && !rst_i;
    load_low_q <= !rst_i && (swap_i || (enable_i && count_q == 5'd31));
    load_high_q <= load_low_q && !rst_i;
  end

  // Steps of an update: words 0..16 are added at steps 0..16; at steps 9..16 the words 8..15, which hold bits 32..63
  // of the new R, stand at its upper end and are compared with the floor; then the sign and overflow are judged.
  logic [4:0] step_q;
  logic rotate_q, compare_q, judge_q;
  logic keep;
  logic last_step;
  assign keep = !rst_i && !swap_i;
  assign last_step = step_q == LAST_STEP;
  always_ff @(posedge clk_i) begin
    if (load_high_q) step_q <= '0;
    else if (rotate_q) step_q <= step_q + 5'd1;
    rotate_q  <= keep && ((load_high_q && !swap_q) || (rotate_q && !last_step));
    compare_q <= keep && rotate_q && step_q[4:3] == 2'b01;
    judge_q   <= keep && rotate_q && last_step;
  end

  logic [Width-1:0] rate_q, acceleration_q, jerk_q;
  logic [31:0] floor_q;
  logic rate_carry_q, acceleration_carry_q, borrow_q;
  logic [Word:0] rate_sum, acceleration_sum, difference;
  assign rate_sum = {1'b0, rate_q[Word-1:0]} + {1'b0, acceleration_q[Word-1:0]} + {4'd0, rate_carry_q};
  assign acceleration_sum = {1'b0, acceleration_q[Word-1:0]} + {1'b0, jerk_q[Word-1:0]} + {4'd0, acceleration_carry_q};
  assign difference = {1'b0, rate_q[Width-1-:Word]} - {1'b0, floor_q[Word-1:0]} - {4'd0, borrow_q};
  always_ff @(posedge clk_i) begin
    rate_carry_q <= rotate_q && rate_sum[Word];
    acceleration_carry_q <= rotate_q && acceleration_sum[Word];
    borrow_q <= compare_q && difference[Word];

    if (swap_i) rate_q[31:0] <= next_rate_q[31:0];
    else if (rotate_q) rate_q[31:0] <= rate_q[31+Word:Word];

    if (swap_q) begin
      rate_q[Width-1:32] <= {4'd0, next_rate_q[63:32]};
      acceleration_q <= {{4{next_acceleration_q[63]}}, next_acceleration_q};
      jerk_q <= {{4{next_jerk_q[63]}}, next_jerk_q};
    end else if (rotate_q) begin
      rate_q[Width-1:32] <= {rate_sum[Word-1:0], rate_q[Width-1:32+Word]};
      acceleration_q <= {acceleration_sum[Word-1:0], acceleration_q[Width-1:Word]};
      jerk_q <= {jerk_q[Word-1:0], jerk_q[Width-1:Word]};
    end

    // Eight nibbles: after the comparison the floor is back in its place.
    if (swap_q) floor_q <= next_floor_q;
    else if (compare_q) floor_q <= {floor_q[Word-1:0], floor_q[31:Word]};
  end

  // Where R lies: below the floor, or at 1 or above. Both are 0 behind a swap, so the first slope is not clamped.
  logic below_q, above_q, below_high_q, above_high_q;
  logic negative;
  logic whole;
  assign negative = rate_q[Width-1];
  assign whole = |rate_q[Width-2:64];
  always_ff @(posedge clk_i) begin
    if (rst_i || swap_i) begin
      below_q <= 1'b0;
      above_q <= 1'b0;
    end else if (judge_q) begin
      below_q <= negative || (!whole && borrow_q);
      above_q <= !negative && whole;
    end
    below_high_q <= below_q;
    above_high_q <= above_q;
  end

  logic [15:0] slope_low_q;
  logic [31:0] slope_high_q;
  always_ff @(posedge clk_i) begin
    if (rst_i) slope_low_q <= '0;
    else if (load_low_q) slope_low_q <= (rate_q[31:16] | {16{above_q}}) & ~{16{below_q}};
    if (rst_i) slope_high_q <= '0;
    else if (load_high_q) slope_high_q <= below_high_q ? floor_q : rate_q[63:32] | {32{above_high_q}};
  end

  logic [15:0] phase_low_q;
  logic [31:0] phase_high_q;
  logic enable_low_q, enable_high_q, carry_q, tick_q;
  logic [16:0] low_sum;
  logic [32:0] high_sum;
  assign low_sum  = {1'b0, phase_low_q} + {1'b0, slope_low_q};
  assign high_sum = {1'b0, phase_high_q} + {1'b0, slope_high_q} + {32'd0, carry_q};
  always_ff @(posedge clk_i) begin
    carry_q <= low_sum[16];
    if (rst_i || clear_i) begin
      enable_low_q <= 1'b0;
      enable_high_q <= 1'b0;
      tick_q <= 1'b0;
      phase_low_q <= '0;
      phase_high_q <= '0;
    end else begin
      enable_low_q <= enable_i;
      enable_high_q <= enable_low_q;
      tick_q <= enable_high_q && high_sum[32];
      if (enable_low_q) phase_low_q <= low_sum[15:0];
      if (enable_high_q) phase_high_q <= high_sum[31:0];
    end
  end

  assign tick_o = tick_q;
  assign rate_o = slope_high_q;
endmodule

`default_nettype wire
