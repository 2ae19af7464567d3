// The deviation accumulator's adders: words of F, gradients, half second differences and displacements come in, their
// values after a step go out. In 4 directions one lane serves both axes; if 8 directions are built in, y has its own
// lane. Pairs are {y, x}, also pairs of words. The phases are those of the lanes; F comes back in phases 3..7, after
// both steps in 4..8.
`default_nettype none

module deviation_steps #(
    parameter int EightDirections = 0  // 1: with 8 directions
) (
    input wire logic clk_i,
    input wire logic run_i,
    input wire logic [2:0] phase_i,
    input wire logic eight_i,  // the path's step rule: 8 directions
    input wire logic [1:0] take_i,
    input wire logic [1:0] negative_i,
    input wire logic [15:0] f_i,
    input wire logic [31:0] gradient_i,
    input wire logic [31:0] half_i,
    input wire logic [31:0] left_i,
    output logic [15:0] f_o,
    output logic [31:0] gradient_o,
    output logic [31:0] left_o,
    output logic [1:0] sides_o  // from deviation_compare
);
  // The first lane has x, or y if y steps in 4 directions.
  logic [15:0] change, after_first, deviation, gradient_x, gradient_y, left_x, left_y;
  logic on_x, negative, skip, carry_q;
  logic [16:0] after_sum;
  assign f_o = deviation;
  assign gradient_o = {gradient_y, gradient_x};
  assign left_o = {left_y, left_x};
  assign after_sum = {1'b0, f_i} + {1'b0, change} + {16'd0, carry_q};

  deviation_lane first (
      .clk_i,
      .run_i,
      .phase_i(phase_i[1:0]),
      .skip_i(skip),
      .negative_i(negative),
      .gradient_i(on_x ? gradient_i[15:0] : gradient_i[31:16]),
      .half_i(on_x ? half_i[15:0] : half_i[31:16]),
      .left_i(on_x ? left_i[15:0] : left_i[31:16]),
      .change_o(change),
      .gradient_o(gradient_x),
      .left_o(left_x)
  );

  always_ff @(posedge clk_i) begin
    if (run_i) begin
      {carry_q, after_first} <= after_sum;
      if (phase_i[1]) carry_q <= negative & ~skip;
    end
  end

  if (EightDirections != 0) begin : gen_eight_directions
    logic [15:0] change_y, after_both;

    assign on_x = take_i[0];
    assign negative = on_x ? negative_i[0] : negative_i[1];
    assign skip = eight_i & ~take_i[0];

    deviation_lane second (
        .clk_i,
        .run_i,
        .phase_i(phase_i[1:0]),
        .skip_i(~take_i[1]),
        .negative_i(negative_i[1]),
        .gradient_i(gradient_i[31:16]),
        .half_i(half_i[31:16]),
        .left_i(left_i[31:16]),
        .change_o(change_y),
        .gradient_o(gradient_y),
        .left_o(left_y)
    );

    deviation_compare compare (
        .clk_i,
        .run_i,
        .phase_i(phase_i[2:1]),
        .minus_i(negative_i & take_i),
        .deviation_i(f_i),
        .change_x_i(change),
        .change_y_i(change_y),
        .after_x_i(after_first),
        .after_both_o(after_both),
        .sides_o
    );

    assign deviation = eight_i ? after_both : after_first;
  end else begin : gen_four_directions
    assign on_x = take_i[0];
    assign negative = negative_i[0];
    assign skip = 1'b0;
    assign gradient_y = gradient_x;
    assign left_y = left_x;
    assign deviation = after_first;
    assign sides_o = 2'b00;

    logic unused;
    assign unused = &{1'b0, phase_i[2], eight_i, take_i[1], negative_i[1]};
  end
endmodule

`default_nettype wire
