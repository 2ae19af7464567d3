// Carries the accumulator's steps to the two axes of the arc's plane.
//
// The plane is loaded with the arc, that is when no other arc runs, so that one register is enough.
`default_nettype none

module arc_router #(
    parameter int Axes = 4
) (
    input  wire logic            clk_i,
    input  wire logic            rst_i,
    input  wire logic [    21:0] load_i,
    input  wire logic            step_x_i,
    input  wire logic            dir_x_i,
    input  wire logic            step_y_i,
    input  wire logic            dir_y_i,
    output logic      [Axes-1:0] step_o,
    output logic      [Axes-1:0] dir_o
);
  logic [2:0] axis_x_q;
  logic [2:0] axis_y_q;

  always_ff @(posedge clk_i) begin
    if (load_i[21] && load_i[20:16] == load_target_pkg::PLANE) begin
      axis_x_q <= load_i[6:4];
      axis_y_q <= load_i[10:8];
    end
    // A direction is looked at with its step only.
    step_o <= '0;
    if ((step_x_i || step_y_i) && !rst_i) begin
      for (int i = 0; i < Axes; i++) begin
        step_o[i] <= (step_x_i && axis_x_q == 3'(i)) || (step_y_i && axis_y_q == 3'(i));
        dir_o[i]  <= (axis_x_q == 3'(i)) ? dir_x_i : dir_y_i;
      end
    end
  end

  logic unused;  // bits of the plane's halfword that the accumulator reads
  assign unused = &{1'b0, load_i[15:11], load_i[7], load_i[3:0]};
endmodule

`default_nettype wire
