// The two pins of an axis in its mode, and the position that they show. Both are a register after the pulse.
`default_nettype none

module step_pins (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic        dir_i,
    input  wire logic        begun_i,       // first clock of the pulse
    input  wire logic        pulse_i,
    input  wire logic [ 3:0] mode_i,        // {invert second pin, invert first pin, mode}
    input  wire logic [ 1:0] idle_level_i,
    output logic             step_o,
    output logic             dir_o,
    output logic      [31:0] position_o
);
  function automatic logic [1:0] gray(input logic [1:0] place);
    gray = place ^ {1'b0, place[1]};
  endfunction

  always_ff @(posedge clk_i) begin
    // In quadrature the pins are the position's two low bits, as they will be, in Gray code (first pin leads forwards).
    case (mode_i[1:0])
      2'd0: {dir_o, step_o} <= mode_i[3:2] ^ {dir_i, pulse_i};
      2'd1: {dir_o, step_o} <= mode_i[3:2] ^ {pulse_i && dir_i, pulse_i && !dir_i};
      default: {dir_o, step_o} <= mode_i[3:2] ^ gray(position_o[1:0] + (begun_i ? {dir_i, 1'b1} : 2'd0));
    endcase
    if (begun_i) position_o <= position_o + {{31{dir_i}}, 1'b1};
    if (rst_i) begin
      {dir_o, step_o} <= idle_level_i;
      position_o <= '0;
    end
  end
endmodule

`default_nettype wire
