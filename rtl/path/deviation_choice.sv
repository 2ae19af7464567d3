// The direction of the deviation accumulator's next step: updated at rest, constant while the step is made. Pairs are
// {y, x}.
//
// One axis moves inward, towards its zero, the other outward. In 4 directions the inward axis steps if the point is on
// or outside the curve, otherwise the outward axis. In 8 directions both step, unless F is nearer to 0 after one step
// alone: then the other axis rests. F after both steps lies between the other two, so signs of sums decide
// (deviation_compare). If F >= 0 and the outward axis has the larger gradient, the outward axis never steps alone
// (docs/decisions/0003).
`default_nettype none

module deviation_choice #(
    parameter int EightDirections = 0  // 1: with 8 directions
) (
    input wire logic clk_i,
    input wire logic rest_i,  // all inputs belong to the present point
    input wire logic eight_i,  // the path's step rule: 8 directions
    input wire logic clockwise_i,
    input wire logic inside_i,  // F is negative
    input wire logic [1:0] gradient_i,  // signs of GX and GY
    input wire logic compare_i,  // both axes are tried next; next_i says in which directions
    input wire logic [1:0] next_i,  // signs of GX and GY after the step
    input wire logic [1:0] sides_i,  // F after this axis's step, plus F after both steps, is negative
    input wire logic last_i,  // no quadrants left
    input wire logic [1:0] left_i,  // signs of the remaining displacements
    input wire logic [1:0] arrived_i,  // the remaining displacement is 0
    input wire logic finishing_i,
    output logic finish_o,  // steps straight to the end (combinational, at rest)
    output logic [1:0] take_o,
    output logic [1:0] negative_o,  // 1: negative; in 4 directions both bits are those of the axis that steps
    output logic [1:0] old_sign_o  // signs of the gradients before the step
);
  logic [1:0] ahead, reached, tabled, least, choice;
  logic inward_x;

  // Directions on the curve, by the 16-entry table.
  function automatic logic [1:0] heading(input logic backwards, input logic [1:0] signs);
    heading = {backwards ^ signs[0], backwards ^ ~signs[1]};
  endfunction

  assign ahead = heading(clockwise_i, gradient_i);
  assign inward_x = ahead[0] ^ gradient_i[0];
  assign tabled = {~(inward_x ^ inside_i), inward_x ^ inside_i};
  assign least = inward_x ? {sides_i[0], ~&sides_i} : {~&sides_i, sides_i[1]};
  assign reached = arrived_i | (left_i ^ ahead);
  assign finish_o = finishing_i | (last_i & (|reached));
  assign choice = finish_o ? {~arrived_i[1] & (eight_i | arrived_i[0]), ~arrived_i[0]} : eight_i ? least : tabled;

  if (EightDirections != 0) begin : gen_eight_directions
    always_ff @(posedge clk_i) begin
      if (rest_i) begin
        take_o <= choice;
        negative_o <= finish_o ? left_i : ahead;
        old_sign_o <= gradient_i;
      end
      if (compare_i) begin
        take_o <= 2'b11;
        negative_o <= heading(clockwise_i, next_i);
      end
    end
  end else begin : gen_four_directions
    logic take_x_q, negative_q, old_sign_q;

    always_ff @(posedge clk_i) begin
      if (rest_i) begin
        take_x_q   <= choice[0];
        negative_q <= finish_o ? (choice[0] ? left_i[0] : left_i[1]) : (choice[0] ? ahead[0] : ahead[1]);
        old_sign_q <= choice[0] ? gradient_i[0] : gradient_i[1];
      end
    end

    assign take_o = {~take_x_q, take_x_q};
    assign negative_o = {2{negative_q}};
    assign old_sign_o = {2{old_sign_q}};

    logic unused;
    assign unused = &{1'b0, compare_i, next_i, choice[1]};
  end
endmodule

`default_nettype wire
