// The limits of one axis: whether a step goes into an active switch, and how many more such steps the axis may make on
// the ramp to the stop. A pair of bits is {positive end, negative end}.
//
// A shared switch serves both ends. It blocks one direction: that of the last step when the switch became active.
// Before the first step since reset it blocks both directions.
`default_nettype none

module limit_axis #(
    parameter int Axis = 0
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [1:0] limit_i,  // levels of the limit roles
    input wire logic step_i,  // a step on the path
    input wire logic dir_i,  // direction of the last step, including step_i: 1 backwards, 0 forwards
    input wire logic shared_i,
    input wire logic any_step_i,  // each step, in either direction, counts as a step into a limit while any_limit_i
    input wire logic any_limit_i,
    input wire logic watched_step_i,  // event: an axis with any_step_i makes a step
    input wire logic ramp_i,  // the stop is under way: overtravel counts
    input wire logic clear_i,  // event: FAULT.limit is cleared
    output logic [1:0] active_o,  // combinational; without overridden limits
    output logic into_o,  // event
    output logic beyond_o,  // with into_o: no overtravel is left
    output logic [1:0] caused_o  // limits that caused FAULT.limit since it was cleared
);
  localparam logic [11:0] OVERTRAVEL = card_map_pkg::ADDR_OVERTRAVEL + 12'(Axis * card_map_pkg::STRIDE_OVERTRAVEL);

  logic [31:0] data;
  logic        overrides;
  logic [ 1:0] level;
  logic [ 1:0] blocked;
  logic        pressed;
  logic [ 1:0] side;  // direction of the last step
  logic [ 1:0] reached;  // directions that a shared switch blocks
  logic        into;
  logic [ 1:0] caused;
  logic [15:0] left;
  logic        none_left;
  logic [15:0] one_less;
  logic        beyond;
  logic [ 1:0] overridden_q;
  logic        moved_q;  // there has been a step since reset
  logic        was_pressed_q;
  logic [ 1:0] reached_q;
  logic [15:0] overtravel_q;
  logic [15:0] left_q;
  logic [ 1:0] caused_q;

  assign data = setting_bus_pkg::data(setting_i);
  assign overrides = setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_LIMIT_OVERRIDE);
  assign pressed = limit_i != 2'b00;
  assign level = shared_i ? {2{pressed}} : limit_i;
  assign active_o = level & ~overridden_q;
  assign side = dir_i ? 2'b01 : 2'b10;
  assign reached = was_pressed_q ? reached_q : (moved_q || step_i) ? side : 2'b11;
  assign blocked = any_step_i ? {2{any_limit_i}} : shared_i ? active_o & reached : active_o;
  assign into = step_i && (blocked & side) != 2'b00;
  // An axis with any_step_i names its own active limits, whichever axis made the step.
  assign caused = any_step_i ? (watched_step_i ? active_o : 2'b00) : into ? side : 2'b00;
  // The overtravel counts from the first step into a limit on.
  assign left = ramp_i ? left_q : overtravel_q;
  // One subtraction: its borrow is the comparison with 0. It does not depend on whether the step counts.
  assign {none_left, one_less} = {1'b0, left} - 17'd1;
  assign beyond = into && none_left;

  always_ff @(posedge clk_i) begin
    moved_q <= moved_q || step_i;
    was_pressed_q <= pressed;
    reached_q <= reached;
    overridden_q <= level & (overrides ? {data[8+Axis], data[Axis]} : overridden_q);
    if (setting_bus_pkg::writes(setting_i, OVERTRAVEL)) overtravel_q <= data[15:0];
    left_q   <= into && !none_left ? one_less : left;
    into_o   <= into;
    beyond_o <= beyond;
    caused_q <= caused;
    // In the same clock as FAULT, which is set by into_o.
    caused_o <= (clear_i ? 2'b00 : caused_o) | caused_q;
    if (rst_i) begin
      left_q <= '0;
      moved_q <= 1'b0;
      was_pressed_q <= 1'b0;
      overridden_q <= '0;
      overtravel_q <= card_map_pkg::RESET_OVERTRAVEL[15:0];
      into_o <= 1'b0;
      beyond_o <= 1'b0;
      caused_q <= '0;
      caused_o <= '0;
    end
  end

  logic unused;
  assign unused = &{1'b0, data[31:16]};
endmodule

`default_nettype wire
