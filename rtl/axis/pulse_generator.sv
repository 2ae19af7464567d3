// Pulse generator of one axis: a phase accumulator with 40 fraction bits (fewer for proofs). Its carry is a step
// forward, its borrow a step back. A count can end the line early (direct mode).
//
// The accumulator is split. The low half is added at the tick, the high half one clock later; the high half of the
// increment, the preset and the tick are delayed by the same clock. The step is registered before it reaches the count,
// so neither adder precedes other logic. The latency from tick_i to step_o is always 3 clocks.
//
// A chord is a swap that keeps the phase and the active flag: the line continues with the next increment.
//
// Rules for the user: Swaps and chords are at least 3 clocks apart. No load comes in the 2 clocks after either. No
// swap, chord or count load comes while live_o is high. A line uses up its count; the next counted line needs a new
// load.
`default_nettype none

module pulse_generator #(
    parameter int FractionBits = 40,  // even, 4 to 40; fewer only to test all lines
    parameter int CountWidth   = 32,  // at least 17, at most 32
    parameter bit Counted      = 1    // 0: without count; counted_i, load_count_i ignored
) (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic        clear_i,           // ends the line and drops the steps in flight
    input  wire logic        tick_i,
    input  wire logic        swap_i,
    input  wire logic        chord_i,           // like a swap, but only of the increment
    input  wire logic        active_i,
    input  wire logic        counted_i,
    input  wire logic        mirror_i,
    input  wire logic        load_increment_i,
    input  wire logic        load_count_i,
    input  wire logic [15:0] word_i,
    output logic             step_o,
    output logic             dir_o,
    output logic             live_o
);

  localparam int HALF = FractionBits / 2;
  localparam logic [HALF-1:0] ONE_HALF = {1'b1, {(HALF - 1) {1'b0}}};

  // |increment| <= 2^FractionBits needs FractionBits + 2 bits signed; three halfwords shift through 48.
  logic [47:0] next_q;
  always_ff @(posedge clk_i) begin
    if (load_increment_i) next_q <= {word_i, next_q[47:16]};
  end

  // Low half of the accumulator. The preset is one half, or one half less 2^-FractionBits (0111..1). So apart from the
  // top bit, each half of the accumulator is preset to zeros or to ones.
  logic [HALF-1:0] low_q;
  logic [HALF-1:0] low_increment_q;
  logic [  HALF:0] low_sum;
  logic            carry_q;
  logic            preset_high;  // the preset's low bits are ones: a mirrored line that runs backwards
  assign low_sum = {1'b0, low_q} + {1'b0, low_increment_q};
  assign preset_high = swap_i & mirror_i & next_q[FractionBits+1];

  always_ff @(posedge clk_i) begin
    carry_q <= tick_i & low_sum[HALF];
    if (swap_i | chord_i) low_increment_q <= next_q[HALF-1:0];
    if (swap_i & ~preset_high) low_q <= '0;
    else if (swap_i | tick_i) low_q <= low_sum[HALF-1:0] | {HALF{preset_high}};
  end

  // High half, one clock later. A carry that differs from bit HALF of the increment is a step (bit HALF of the whole
  // sum); the increment's sign gives its direction. The tick gates the carries, so that a carry ends in a lookup table,
  // not in a wire.
  logic [HALF-1:0] high_q;
  logic [HALF+1:0] high_increment_q;
  logic [  HALF:0] high_sum;
  logic            tick_q;
  logic            swap_q;
  logic            turn_q;  // a swap or a chord
  logic            preset_high_q;
  logic            carried_q;
  logic            backwards_q;
  assign high_sum = {1'b0, high_q} + {1'b0, high_increment_q[HALF-1:0]} + {{HALF{1'b0}}, carry_q};

  always_ff @(posedge clk_i) begin
    tick_q <= tick_i;
    swap_q <= swap_i;
    turn_q <= swap_i | chord_i;
    preset_high_q <= preset_high;
    carried_q <= tick_q & (high_sum[HALF] ^ high_increment_q[HALF]);
    backwards_q <= high_increment_q[HALF+1];
    if (turn_q) high_increment_q <= next_q[FractionBits+1:HALF];
    if (swap_q & ~preset_high_q) high_q <= ONE_HALF;
    else if (swap_q) high_q <= ~ONE_HALF;
    else if (tick_q) high_q <= high_sum[HALF-1:0];
    if (rst_i | clear_i) swap_q <= 1'b0;
  end

  // The gate of a line opens in the clock in which the carry of its first tick can arrive. The old line's last carry is
  // before that.
  logic opening_q;  // the line swapped in last is active
  logic swap_late_q;
  logic open_q;
  logic nothing;  // the line is counted, and its count is 0
  logic last;  // the step under way completes the count
  logic step;
  assign step = carried_q & open_q;

  always_ff @(posedge clk_i) begin
    swap_late_q <= swap_q;
    if (swap_i) opening_q <= active_i;
    if (swap_late_q) open_q <= opening_q & ~nothing;
    else if (last) open_q <= 1'b0;
    step_o <= step;
    if (step & ~clear_i) dir_o <= backwards_q;
    if (rst_i | clear_i) begin
      swap_late_q <= 1'b0;
      open_q <= 1'b0;
      step_o <= 1'b0;
    end
    if (rst_i) dir_o <= 1'b0;
  end

  generate
    if (Counted) begin : g_count
      step_count #(
          .Width(CountWidth)
      ) u_count (
          .clk_i,
          .clear_i(rst_i | clear_i),
          .load_i(load_count_i),
          .word_i,
          .arm_i(swap_i),
          .counted_i(active_i & counted_i),
          .begin_i(swap_late_q),
          .step_i(carried_q),
          .live_o,
          .nothing_o(nothing),
          .last_o(last)
      );
    end else begin : g_free
      logic unused;
      assign unused = ^{counted_i, load_count_i};
      assign nothing = 1'b0;
      assign last = 1'b0;
      assign live_o = 1'b0;
    end
  endgenerate

  logic unused_extension;  // only 10 bits of the third halfword have a meaning
  assign unused_extension = ^next_q[47:FractionBits+2];

endmodule

`default_nettype wire
