// The count of a pulse generator: a counted line makes exactly `count` steps, up to one per clock.
//
// The count is kept inverted and counts up: the load and the increment of a bit then fit one 4-input table. The lower
// four bits count at once. The upper bits follow one clock later, and their flag has the time of 14 steps to settle.
`default_nettype none

module step_count #(
    parameter int Width = 32  // at least 17, at most 32
) (
    input  wire logic        clk_i,
    input  wire logic        clear_i,
    input  wire logic        load_i,     // two halfwords, the lower first
    input  wire logic [15:0] word_i,
    input  wire logic        arm_i,      // the swap
    input  wire logic        counted_i,  // sampled with arm_i
    input  wire logic        begin_i,    // two clocks after arm_i: steps belong to the new line from the next clock on
    input  wire logic        step_i,
    output logic             live_o,
    output logic             nothing_o,  // combinational, valid with begin_i: the count is 0, no step is allowed
    output logic             last_o      // combinational: step_i is the line's last step
);

  logic [      3:0] fast_q;
  logic [Width-1:4] slow_q;
  logic             slow_zero_q;
  logic             borrow_q;
  logic             counting_q;
  logic             count_step;
  logic [      3:0] fast_next;
  logic [Width-1:4] slow_next;
  logic [Width-1:4] slow_sum;
  logic             slow_full;
  logic [     31:0] shifted;

  assign shifted = {~word_i, 16'(slow_q[Width-1:16])};
  assign count_step = step_i & counting_q;
  assign last_o = count_step & slow_zero_q & (fast_q == 4'b1110);
  assign nothing_o = live_o & slow_zero_q & (fast_q == 4'b1111);

  // The added load enable has no effect, because a load overrides the sum. It lets table and carry share an input.
  assign {slow_full, slow_sum} = {1'b0, slow_q} + {1'b0, {(Width - 4) {load_i}}} + (Width - 3)'(1);
  assign fast_next = load_i ? shifted[3:0] : fast_q + {4{load_i}} + 4'd1;
  assign slow_next = load_i ? shifted[Width-1:4] : slow_sum;

  always_ff @(posedge clk_i) begin
    if (load_i | count_step) fast_q <= fast_next;
    if (load_i | borrow_q) slow_q <= slow_next;
    slow_zero_q <= slow_full;
    borrow_q <= count_step & (fast_q == 4'b1111);

    if (arm_i) live_o <= counted_i;
    else if (last_o | (begin_i & nothing_o)) live_o <= 1'b0;
    if (begin_i) counting_q <= live_o & ~nothing_o;
    else if (last_o) counting_q <= 1'b0;
    if (clear_i) begin
      live_o <= 1'b0;
      counting_q <= 1'b0;
      borrow_q <= 1'b0;
    end
  end

endmodule

`default_nettype wire
