// The ticks that a stop takes from the present ratio: stop distance * ratio^2, rounded up, computed every 32 clocks.
//
// The ratio is taken in 256ths, rounded up, and so is its square: at full ratio the product is exact, and it is never
// too small. By step_i: in 0 the ratio is taken (unless keep_i), in 1 to 10 it is squared, in 12 to 21 multiplied by
// the stop distance, and in 25 to 28 the product leaves in words of 14 bits. In 12 to 21 the stop distance does not
// change.
//
// The stop distance in force is that of the piece in force. A piece that ends at rest (0) keeps the stop distance of
// the piece before it, since it begins with the speed of that piece. If the next piece begins from rest (follow_i), its
// stop distance is used.
`default_nettype none

module stop_ticks (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic [4:0] step_i,
    input wire logic [16:0] ratio_i,
    input wire logic keep_i,  // the ratio taken before is kept
    input wire logic twice_i,  // twice the product is wanted; sampled in step 11
    input wire logic none_i,  // 0 instead of the product; sampled in step 11
    input wire logic [feed_load_pkg::WIDTH-1:0] load_i,
    input wire logic swap_i,  // a piece began in the clock before
    input wire logic from_rest_i,  // before it nothing was in force, or a piece that ends at rest
    input wire logic follow_i,
    output logic next_zero_o,  // the next piece's stop distance is 0: it ends at rest
    output logic ruled_o,  // the stop distance in force is not 0
    output logic [13:0] inverted_o  // a word of the product, inverted for the comparison
);
  logic        load;
  logic        half_q;  // the lower halfword has arrived
  logic        low_zero_q;
  logic [31:0] next_q;
  logic [15:0] word;
  assign load = feed_load_pkg::to(load_i, load_target_pkg::FEED_STOP_DISTANCE);
  assign word = feed_load_pkg::word(load_i);
  always_ff @(posedge clk_i) begin
    if (load) begin
      next_q <= {word, next_q[31:16]};
      low_zero_q <= word == 16'd0;
      next_zero_o <= half_q && low_zero_q && word == 16'd0;
      half_q <= !half_q;
    end
    if (rst_i || cut_i) begin
      half_q <= 1'b0;
      next_zero_o <= 1'b1;
    end
  end

  logic [31:0] distance_q;
  logic        due_q;
  logic        still;
  logic        take;
  // The next piece's stop distance arrives at least 14 clocks after a swap; by then one that is due has been taken.
  assign still = step_i >= 5'd12 && step_i <= 5'd21;
  assign take  = !still && (due_q || follow_i);
  always_ff @(posedge clk_i) begin
    if (take) begin
      distance_q <= next_q;
      ruled_o <= !next_zero_o;
      due_q <= 1'b0;
    end
    if (swap_i && (from_rest_i || !next_zero_o)) due_q <= 1'b1;
  end

  // The square is made in the register from whose lower end the ratio's bits leave. Later its own bits pass bit 7,
  // where the product reads them. The sum begins with 255, shifted in at the upper end in the eight clocks before; so
  // 256ths of it are rounded up.
  logic [ 8:0] ratio_q;
  logic [17:0] square_q;
  logic [ 9:0] square_sum;
  logic        add;
  logic        round;
  assign add = step_i <= 5'd10 && square_q[0];  // square_q[0] is 0 in steps 0 and 1
  assign round = step_i >= 5'd25 || step_i == 5'd0;
  assign square_sum = {1'b0, square_q[17:9]} + {1'b0, ratio_q};
  always_ff @(posedge clk_i) begin
    if (step_i == 5'd0 && !keep_i) ratio_q <= ratio_i[16:8] + {8'd0, ratio_i[7:0] != 8'd0};
    square_q <= {add ? square_sum : {round, square_q[17:9]}, square_q[8:1]};
    if (step_i == 5'd1) square_q[8:0] <= ratio_q;
  end

  // The square has nine bits: the tenth step halves, unless twice the product is wanted. Whether a bit counts is
  // decided after the addition: a table of the adder has room for that.
  logic        none_q;
  logic        twice_q;
  logic [33:0] product_q;
  logic [32:0] sum;
  assign sum = {1'b0, product_q[33:2]} + {1'b0, distance_q};
  always_ff @(posedge clk_i) begin
    if (step_i == 5'd11) begin
      none_q <= none_i;
      twice_q <= twice_i;
      product_q <= '0;
    end else if (still && !none_q && !(step_i == 5'd21 && twice_q)) begin
      product_q <= square_q[7] ? {sum, product_q[1]} : product_q >> 1;
    end
  end

  assign inverted_o = ~(step_i[1:0] == 2'd1 ? product_q[13:0] : step_i[1:0] == 2'd2 ? product_q[27:14] :
                        step_i[1:0] == 2'd3 ? {8'd0, product_q[33:28]} : 14'd0);
endmodule

`default_nettype wire
