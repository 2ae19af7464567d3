// Arithmetic of a step along one axis, one word of 16 bits per clock, lowest first.
//
// With U = s*G + CX/2, a step of s adds U to F and replaces G by G + s*CX = s*(U + CX/2). For a negative s the words
// are inverted on the way in and on the way out; the missing one enters as the carry into F. Words that enter in phases
// 0..4 are words of U in phases 2..6 and come back in phases 3..7; the two words of the displacement come back in 2 and
// 3.
`default_nettype none

module deviation_lane (
    input  wire logic        clk_i,
    input  wire logic        run_i,       // words move; their content before phase 0 is ignored
    input  wire logic [ 1:0] phase_i,     // phases 1 and 0
    input  wire logic        skip_i,      // U is 0; words that come back are ignored
    input  wire logic        negative_i,
    input  wire logic [15:0] gradient_i,
    input  wire logic [15:0] half_i,      // CX/2: 3 words, then zeros
    input  wire logic [15:0] left_i,      // remaining displacement
    output logic      [15:0] change_o,    // U
    output logic      [15:0] gradient_o,
    output logic      [15:0] left_o
);
  logic [15:0] g_q, h_q, h_late_q, e_q, v_q;
  logic u_carry_q, v_carry_q, e_carry_q;
  logic [16:0] u_sum, v_sum, e_sum;
  assign u_sum = {1'b0, g_q} + {1'b0, h_q} + {16'd0, u_carry_q};
  assign v_sum = {1'b0, change_o} + {1'b0, h_late_q} + {16'd0, v_carry_q};
  assign e_sum = {1'b0, e_q} + {1'b0, {16{~negative_i}}} + {16'd0, e_carry_q};

  always_ff @(posedge clk_i) begin
    if (run_i) begin
      g_q <= gradient_i ^ {16{negative_i}};
      h_q <= half_i;
      h_late_q <= h_q;
      e_q <= left_i;
      {u_carry_q, change_o} <= u_sum & {~phase_i[0], {16{~skip_i}}};
      {v_carry_q, v_q} <= v_sum & {~phase_i[1], 16'hFFFF};
      {e_carry_q, left_o} <= e_sum;
      if (phase_i[0]) e_carry_q <= negative_i;
    end
  end

  assign gradient_o = v_q ^ {16{negative_i}};
endmodule

`default_nettype wire
