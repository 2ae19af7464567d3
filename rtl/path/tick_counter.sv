// Counts the ticks of a path or a piece, 40 bits: `last_o` says that the next tick taken is the last one. The next count
// is shifted in from the load bus meanwhile, with the zero flags that come with it when it is loaded.
//
// Four fast bits take every tick; the upper 36 bits follow in two parts with registered borrows and zero flags. They
// change at most once in 16 ticks, so their flags, renewed with each tick, are settled long before the fast bits reach 1.
// The loaded value comes with its flags, so that a count of 1 is recognised in the clock after the load; its upper parts are
// taken one clock later, so that the late load_i does not reach so many flip-flops: the next count stands until then.
`default_nettype none

module tick_counter (
    input wire logic clk_i,
    input wire logic rst_i,
    // a halfword of the next count, which is at least 1 where ticks count it
    input wire logic next_i,
    input wire logic [15:0] word_i,
    output logic [39:0] count_o,  // the next count; still there in the clock after load_i
    output logic zero_o,  // it is 0; two clocks late
    input wire logic load_i,  // take it
    input wire logic take_i,
    output logic [39:0] left_o,  // ticks; right three clocks after the last load or take
    output logic last_o
);
  logic [39:0] count_q;  // the next one
  assign count_o = count_q;
  logic [7:0] top_pass_q;  // of the third halfword nothing counts, but the first two pass here
  logic       loaded_q;
  logic       settled_q;
  logic       next_low_zero_q;  // of bits 3 to 0, 19 to 4, 39 to 20, a clock late
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
  logic [15:0] mid_q;  // these two inverted: so they count up, and load and count fit one 4-input table a bit
  logic [19:0] top_q;
  assign left_o = {~top_q, ~mid_q, low_q};

  logic        mid_zero_q;
  logic        top_zero_q;
  logic        mid_borrow_q;
  logic        top_borrow_q;
  logic        load_q;

  // The added load changes nothing (a load overrides the sum); it lets table and carry share an input.
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
    // A borrow beside a load meets the upper parts in the clock in which they are taken, which goes before.
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
