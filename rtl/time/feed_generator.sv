// The feed generator: rate, acceleration and jerk of one feed piece, and a 48-bit phase whose carry is the tick.
//
// Enabled clocks 32k..32k+31 of a piece add clamp(R_k) to the phase; R_0 is the rate itself, unclamped. R and A are
// added in nibbles, in 17 clocks for 68 bits, right after R_k was taken. So R_(k+1) and its comparison with the floor
// are ready 20 clocks later, 12 before the earliest need. A swap may come at any clock, also during an update. A and J
// have no shadow. If no piece runs, they arrive before the swap (clear_i is high then). Otherwise they arrive after it,
// and R_1 is computed when the last halfword of J is there. That is 14 clocks after the swap at the latest; any later,
// the 32nd enabled clock could be missed.
//
// While frozen, the slope stays as it is until the next swap.
//
// Once R is outside -2 .. 2, it keeps its value to the end of the piece, and the slope is the floor or 1. Before that,
// A is within +-4.5 (the difference of two values of R, plus a J of at most one half). So neither ever leaves the +-8
// of its bits.
//
// The phase has 16 + 32 bits with a registered carry. All values for the upper 32 bits (their part of R, the floor, the
// slope) are taken one clock after those for the lower part. So the shadow must keep its values in the clock of a swap
// and in the next one. Swaps are at least 16 clocks apart (the decoder takes that long to load a piece); nothing is
// enabled before the first one. An enable at c gives its tick at c+3; the rate is shown with the same delay.
`default_nettype none

module feed_generator (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic clear_i,
    input wire logic enable_i,
    input wire logic freeze_i,
    input wire logic [feed_load_pkg::WIDTH-1:0] load_i,
    input wire logic swap_i,
    input wire logic [31:0] left_i,  // value of the snapshot REST in place of the rate
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o,
    output logic tick_o,
    output logic [31:0] rate_o
);
  localparam int Word = 4;
  // 64 fraction bits and a nibble: +-8.
  localparam int Width = 68;
  localparam logic [4:0] LAST_STEP = 5'd16;

  logic [15:0] word;
  logic load_rate, load_floor, load_acceleration, load_jerk;
  assign word = feed_load_pkg::word(load_i);
  assign load_rate = feed_load_pkg::to(load_i, load_target_pkg::FEED_RATE);
  assign load_floor = feed_load_pkg::to(load_i, load_target_pkg::FEED_FLOOR);
  assign load_acceleration = feed_load_pkg::to(load_i, load_target_pkg::FEED_ACCELERATION);
  assign load_jerk = feed_load_pkg::to(load_i, load_target_pkg::FEED_JERK);

  // First slope and floor of the next piece.
  logic [63:0] next_rate_q;
  logic [31:0] next_floor_q;
  always_ff @(posedge clk_i) begin
    if (load_rate) next_rate_q <= {word, next_rate_q[63:16]};
    if (load_floor) next_floor_q <= {word, next_floor_q[31:16]};
  end

  // Enabled clocks of the piece, modulo 32, and the clocks in which the two parts of the slope are taken from R.
  logic [4:0] count_q;
  logic swap_q, load_low_q, load_high_q;
  always_ff @(posedge clk_i) begin
    if (rst_i || swap_i) count_q <= '0;
    else if (enable_i) count_q <= count_q + 5'd1;
    swap_q <= swap_i && !rst_i;
    load_low_q <= !rst_i && (swap_i || (enable_i && !freeze_i && count_q == 5'd31));
    load_high_q <= load_low_q && !rst_i;
  end

  // Steps of an update: words 0..16 are added at steps 0..16. At steps 9..16 the words 8..15, which hold bits 32..63 of
  // the new R, are at its upper end and are compared with the floor. Then the sign and overflow are judged.
  logic [4:0] step_q;
  logic rotate_q, compare_q, judge_q;
  logic waits_q;  // waits for acceleration and jerk
  logic away_q;  // R is outside -2 .. 2
  logic primed_q;  // acceleration and jerk of the next piece are loaded
  logic load_jerk_q;
  logic loaded;
  logic keep;
  assign keep   = !rst_i && !swap_i && !clear_i;
  assign loaded = load_jerk_q && !load_jerk;
  always_ff @(posedge clk_i) begin
    load_jerk_q <= load_jerk;
    if (swap_i) waits_q <= !primed_q && !loaded;
    else if (loaded) waits_q <= 1'b0;
    primed_q <= clear_i && !swap_i && (primed_q || loaded);
    if (rst_i) begin
      load_jerk_q <= 1'b0;
      waits_q     <= 1'b0;
      primed_q    <= 1'b0;
    end
    compare_q <= 1'b0;
    judge_q   <= 1'b0;
    if (rotate_q) begin
      step_q    <= step_q + 5'd1;
      rotate_q  <= keep && step_q != LAST_STEP;
      compare_q <= keep && step_q[4:3] == 2'b01;
      judge_q   <= keep && step_q == LAST_STEP;
    end
    if (waits_q ? loaded : load_high_q) begin
      step_q   <= '0;
      rotate_q <= keep && !away_q;
    end
    if (rst_i) rotate_q <= 1'b0;
  end

  // Each value is an upper and a lower part that shift as one.
  logic [Width-33:0] rate_high_q;
  logic [31:0] rate_low_q;
  logic [Width-65:0] acceleration_top_q, jerk_top_q;
  logic [63:0] acceleration_q, jerk_q;
  logic [31:0] floor_q;
  logic rate_carry_q, acceleration_carry_q, borrow_q;
  always_ff @(posedge clk_i) begin : p_update
    logic [Word:0] rate_sum, acceleration_sum, difference;

    rate_carry_q <= 1'b0;
    acceleration_carry_q <= 1'b0;
    borrow_q <= 1'b0;

    if (rotate_q) begin
      rate_sum = {1'b0, rate_low_q[Word-1:0]} + {1'b0, acceleration_q[Word-1:0]} + {4'd0, rate_carry_q};
      acceleration_sum = {1'b0, acceleration_q[Word-1:0]} + {1'b0, jerk_q[Word-1:0]} + {4'd0, acceleration_carry_q};
      rate_carry_q <= rate_sum[Word];
      acceleration_carry_q <= acceleration_sum[Word];
      rate_low_q <= {rate_high_q[Word-1:0], rate_low_q[31:Word]};
      rate_high_q <= {rate_sum[Word-1:0], rate_high_q[Width-33:Word]};
    end
    if (rotate_q || load_acceleration) begin
      acceleration_top_q <= rotate_q ? acceleration_sum[Word-1:0] : {Word{word[15]}};
      if (rotate_q) acceleration_q <= {acceleration_top_q, acceleration_q[63:Word]};
      else acceleration_q <= {word, acceleration_q[63:16]};
    end
    if (rotate_q || load_jerk) begin
      jerk_top_q <= rotate_q ? jerk_q[Word-1:0] : {Word{word[15]}};
      if (rotate_q) jerk_q <= {jerk_top_q, jerk_q[63:Word]};
      else jerk_q <= {word, jerk_q[63:16]};
    end

    // Eight nibbles: after the comparison the floor is back in its original position.
    if (compare_q) begin
      difference = {1'b0, rate_high_q[Width-33-:Word]} - {1'b0, floor_q[Word-1:0]} - {4'd0, borrow_q};
      borrow_q <= difference[Word];
      floor_q  <= {floor_q[Word-1:0], floor_q[31:Word]};
    end

    if (swap_i) rate_low_q <= next_rate_q[31:0];
    if (swap_q) begin
      floor_q <= next_floor_q;
      rate_high_q <= {4'd0, next_rate_q[63:32]};
    end
  end

  // Range of R: below the floor, or at 1 or above. Both are 0 after a swap, so the first slope is not clamped.
  logic below_q, above_q, below_high_q, above_high_q;
  always_ff @(posedge clk_i) begin : p_judge
    logic negative;
    logic whole;

    if (rst_i || swap_i) begin
      below_q <= 1'b0;
      above_q <= 1'b0;
      away_q  <= 1'b0;
    end else if (judge_q) begin
      negative = rate_high_q[Width-33];
      whole = |rate_high_q[Width-34:32];
      below_q <= negative || (!whole && borrow_q);
      above_q <= !negative && whole;
      away_q  <= rate_high_q[Width-33-:3] != {3{negative}};
    end
    if (load_low_q) begin
      below_high_q <= below_q;
      above_high_q <= above_q;
    end
  end

  logic [15:0] slope_low_q;
  logic [31:0] slope_high_q;
  always_ff @(posedge clk_i) begin
    if (load_low_q) slope_low_q <= (rate_low_q[31:16] | {16{above_q}}) & ~{16{below_q}};
    if (load_high_q) slope_high_q <= below_high_q ? floor_q : rate_high_q[31:0] | {32{above_high_q}};
    if (rst_i) begin
      slope_low_q  <= '0;
      slope_high_q <= '0;
    end
  end

  logic [15:0] phase_low_q;
  logic [31:0] phase_high_q;
  logic enable_low_q, enable_high_q, carry_q, tick_q;
  always_ff @(posedge clk_i) begin : p_phase
    logic [16:0] low_sum;
    logic [32:0] high_sum;

    low_sum = {1'b0, phase_low_q} + {1'b0, slope_low_q};
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
      tick_q <= 1'b0;
      if (enable_low_q) phase_low_q <= low_sum[15:0];
      if (enable_high_q) begin
        high_sum = {1'b0, phase_high_q} + {1'b0, slope_high_q} + {32'd0, carry_q};
        tick_q <= high_sum[32];
        phase_high_q <= high_sum[31:0];
      end
    end
  end

  assign tick_o = tick_q;
  assign rate_o = slope_high_q;

  snapshot_slice rate (
      .clk_i,
      .snapshot_i,
      .value_i(snapshot_i[snapshot_pkg::REST] ? left_i : rate_o),
      .snapshot_o
  );
endmodule

`default_nettype wire
