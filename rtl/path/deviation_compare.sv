// Arithmetic of the 8-direction rule alone: F after both steps, and which of the three candidates is nearest to 0.
//
// With FX = F + UX and FY = F + UY the third candidate is FX + UY. sides_o has the signs of its sums with the other
// two, 2 FX + UY and 2 FY + UX. The phases are those of the lanes: words of F and of the lanes come in phases 2..6,
// those of FX in 3..7. F after both steps leaves in 4..8, and the signs are valid from phase 8 on.
`default_nettype none

module deviation_compare (
    input  wire logic        clk_i,
    input  wire logic        run_i,
    input  wire logic [ 2:1] phase_i,
    input  wire logic [ 1:0] minus_i,       // {y, x}: the one that the lane left out, to be added as a carry
    input  wire logic [15:0] deviation_i,
    input  wire logic [15:0] change_x_i,
    input  wire logic [15:0] change_y_i,
    input  wire logic [15:0] after_x_i,     // FX
    output logic      [15:0] after_both_o,
    output logic      [ 1:0] sides_o        // {y, x}: 1 if the sum with FY, with FX is negative
);
  logic [15:0] change_x_q, change_y_q, after_y_q;
  logic top_x_q, top_y_q;  // bits that the doubling carries into the next word
  logic y_carry_q, both_carry_q, side_x_carry_q, side_y_carry_q;
  logic [16:0] y_sum, both_sum, side_x_sum, side_y_sum;
  assign y_sum = {1'b0, deviation_i} + {1'b0, change_y_i} + {16'd0, y_carry_q};
  assign both_sum = {1'b0, after_x_i} + {1'b0, change_y_q} + {16'd0, both_carry_q};
  assign side_x_sum = {1'b0, after_x_i[14:0], top_x_q} + {1'b0, change_y_q} + {16'd0, side_x_carry_q};
  assign side_y_sum = {1'b0, after_y_q[14:0], top_y_q} + {1'b0, change_x_q} + {16'd0, side_y_carry_q};

  always_ff @(posedge clk_i) begin
    if (run_i) begin
      change_x_q <= change_x_i;
      change_y_q <= change_y_i;
      {y_carry_q, after_y_q} <= y_sum;
      {both_carry_q, after_both_o} <= both_sum;
      {side_x_carry_q, sides_o[0]} <= side_x_sum[16:15];
      {side_y_carry_q, sides_o[1]} <= side_y_sum[16:15];
      top_x_q <= after_x_i[15];
      top_y_q <= after_y_q[15];
      if (phase_i[1]) y_carry_q <= minus_i[1];
      if (phase_i[2]) begin
        both_carry_q <= minus_i[1];
        side_x_carry_q <= minus_i[1];
        side_y_carry_q <= minus_i[0];
        top_x_q <= 1'b0;
        top_y_q <= 1'b0;
      end
    end
  end

  logic unused;
  assign unused = &{1'b0, side_x_sum[14:0], side_y_sum[14:0]};
endmodule

`default_nettype wire
