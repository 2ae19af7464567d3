// One axis: the pulse generator's steps and those of the deviation accumulator, merged, shaped and counted.
`default_nettype none

module axis #(
    parameter int CountWidth = 32,
    parameter bit Counted = 1
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic clear_i,
    input wire logic tick_i,
    input wire logic swap_i,
    input wire logic active_i,
    input wire logic counted_i,
    input wire logic mirror_i,
    input wire logic load_increment_i,
    input wire logic load_count_i,
    input wire logic [15:0] word_i,
    input wire logic ext_step_i,  // a path runs on one engine: never together with a step of the generator
    input wire logic ext_dir_i,
    input wire logic [15:0] step_length_i,
    input wire logic [15:0] step_space_i,
    input wire logic [15:0] dir_setup_i,
    input wire logic [15:0] dir_hold_i,
    input wire logic [3:0] mode_i,
    input wire logic hold_tick_i,
    input wire logic clear_fault_i,
    output logic path_step_o,
    output logic path_dir_o,
    output logic live_o,
    output logic step_o,
    output logic dir_o,
    output logic [31:0] position_o,
    output logic busy_o,
    output logic fault_o
);

  logic generator_step;
  logic generator_dir;

  pulse_generator #(
      .CountWidth(CountWidth),
      .Counted   (Counted)
  ) u_pulse_generator (
      .clk_i,
      .rst_i,
      .clear_i,
      .tick_i,
      .swap_i,
      .active_i,
      .counted_i,
      .mirror_i,
      .load_increment_i,
      .load_count_i,
      .word_i,
      .step_o(generator_step),
      .dir_o (generator_dir),
      .live_o
  );

  // clear_i does not drop the step in this register: a step on its way to the shaper is made.
  always_ff @(posedge clk_i) begin
    path_step_o <= generator_step | ext_step_i;
    if (generator_step | ext_step_i) path_dir_o <= ext_step_i ? ext_dir_i : generator_dir;
    if (rst_i) begin
      path_step_o <= 1'b0;
      path_dir_o  <= 1'b0;
    end
  end

  step_shaper u_step_shaper (
      .clk_i,
      .rst_i,
      .step_i(path_step_o),
      .dir_i (path_dir_o),
      .step_length_i,
      .step_space_i,
      .dir_setup_i,
      .dir_hold_i,
      .mode_i,
      .hold_tick_i,
      .clear_fault_i,
      .step_o,
      .dir_o,
      .position_o,
      .busy_o,
      .fault_o
  );

endmodule

`default_nettype wire
