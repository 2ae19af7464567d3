// Counts the ticks of a path or a piece down, 40 bits: `last_o` says that the next tick taken is the last one.
//
// Four fast bits take every tick; the upper 36 bits follow in two parts with registered borrows and zero flags. They
// change at most once in 16 ticks, so their flags, renewed with each tick, are settled long before the fast bits reach 1.
// The loaded value comes with its flags, so that a count of 1 is recognised in the clock after the load; its upper parts are
// taken one clock later, so that the late load_i does not reach so many flip-flops: count_i stands until then.
`default_nettype none

module tick_counter (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic        load_i,
    input  wire logic [39:0] count_i,     // at least 1
    input  wire logic        mid_zero_i,  // count_i[19:4] is 0
    input  wire logic        top_zero_i,  // count_i[39:20] is 0
    input  wire logic        take_i,
    output logic             last_o
);
  logic [ 3:0] low_q;
  logic [15:0] mid_q;  // these two inverted: so they count up, and load and count fit one 4-input table a bit
  logic [19:0] top_q;
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
    if (load_q || mid_borrow_q) mid_q <= load_q ? ~count_i[19:4] : mid_sum;
    if (load_q || top_borrow_q) top_q <= load_q ? ~count_i[39:20] : top_sum;
    if (load_i) begin
      low_q        <= count_i[3:0];
      mid_zero_q   <= mid_zero_i;
      top_zero_q   <= top_zero_i;
      mid_borrow_q <= 1'b0;
      top_borrow_q <= 1'b0;
      last_o       <= count_i[3:0] == 4'd1 && mid_zero_i && top_zero_i;
    end else begin
      top_borrow_q <= mid_borrow_q && mid_zero_q;
      mid_borrow_q <= take_i && low_q == 4'd0;
      if (take_i) begin
        last_o <= low_q == 4'd2 && mid_zero_q && top_zero_q;
        low_q  <= low_q - 4'd1;
        if (!load_q) begin
          mid_zero_q <= mid_q == '1;
          top_zero_q <= top_q == '1;
        end
      end
    end
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
