// Counts the ticks of a path or a piece, 40 bits: `last_o` says that the next tick taken is the last one. The next
// count is shifted in from the load bus in the meantime; a load takes it together with its zero flags.
//
// Four fast bits count every tick. The upper 36 bits follow in two parts with registered borrows and zero flags. They
// change at most once in 16 ticks, so their flags, updated with each tick, are valid long before the fast bits reach 1.
// The loaded value comes with its flags, so that a count of 1 is recognised in the clock after the load. Its upper
// parts are taken one clock later, so that the late load_i does not reach so many flip-flops; the next count keeps its
// value until then.
`default_nettype none

module tick_counter (
    input wire logic clk_i,
    input wire logic rst_i,
    // a halfword of the next count; the count is at least 1 if ticks count it
    input wire logic next_i,
    input wire logic [15:0] word_i,
    output logic [39:0] count_o,  // the next count; still there in the clock after load_i
    output logic zero_o,  // the next count is 0; delayed by two clocks
    input wire logic load_i,  // takes the next count
    input wire logic take_i,
    output logic [39:0] left_o,  // ticks left; valid three clocks after the last load or take
    output logic last_o
);
  logic [39:0] count_q;  // the next count
  assign count_o = count_q;
  logic [7:0] top_pass_q;  // upper byte of the third halfword: unused, but the first two halfwords pass here
  logic       loaded_q;
  logic       settled_q;
  logic       next_low_zero_q;  // zero flags of bits 3 to 0, 19 to 4, 39 to 20, delayed by a clock
  logic       next_mid_zero_q;
  logic       next_top_zero_q;

  always_ff @(posedge clk_i) begin
    if (next_i) {top_pass_q, count_q} <= {word_i, top_pass_q, count_q[39:16]};
    loaded_q  <= next_i;
    settled_q <= loaded_q;
    if (loaded_q) begin
      next_low_zero_q <= count_q[3:0] == 4'd0;
      next_mid_zero_q <= count_q[19:4] == 16'd0;
      next_top_zero_q <= count_q[39:20] == 20'd0;
    end
    if (settled_q) zero_o <= next_low_zero_q && next_mid_zero_q && next_top_zero_q;
  end

  logic [ 3:0] low_q;
  logic [15:0] mid_q;  // mid_q and top_q are inverted: they count up, so load and count fit one 4-input table per bit
  logic [19:0] top_q;
  assign left_o = {~top_q, ~mid_q, low_q};

  logic        mid_zero_q;
  logic        top_zero_q;
  logic        mid_borrow_q;
  logic        top_borrow_q;
  logic        load_q;

  // The added load enable has no effect, because a load overrides the sum; it lets table and carry share an input.
  logic [15:0] mid_sum;
  logic [19:0] top_sum;
  assign mid_sum = mid_q + {16{load_q}} + 16'd1;
  assign top_sum = top_q + {20{load_q}} + 20'd1;

  always_ff @(posedge clk_i) begin
    if (load_q || mid_borrow_q) mid_q <= load_q ? ~count_q[19:4] : mid_sum;
    if (load_q || top_borrow_q) top_q <= load_q ? ~count_q[39:20] : top_sum;
    if (load_i) begin
      low_q      <= count_q[3:0];
      mid_zero_q <= next_mid_zero_q;
      top_zero_q <= next_top_zero_q;
      last_o     <= count_q[3:0] == 4'd1 && next_mid_zero_q && next_top_zero_q;
    end else begin
      if (take_i) begin
        last_o <= low_q == 4'd2 && mid_zero_q && top_zero_q;
        low_q  <= low_q - 4'd1;
        if (!load_q) begin
          mid_zero_q <= mid_q == '1;
          top_zero_q <= top_q == '1;
        end
      end
    end
    // A borrow in the clock of a load meets the upper parts when they are taken; taking has priority.
    mid_borrow_q <= take_i && low_q == 4'd0;
    top_borrow_q <= mid_borrow_q && mid_zero_q && !load_q;
    load_q <= load_i;
    if (rst_i) begin
      load_q       <= 1'b0;
      mid_borrow_q <= 1'b0;
      top_borrow_q <= 1'b0;
      last_o       <= 1'b0;
    end
  end
endmodule

`default_nettype wire
