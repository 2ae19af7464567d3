// The steps that have arrived and are not yet made: up to four directions, in order.
//
// A step that arrives while all places are taken is dropped, which is a fault. It is also a fault if a step waits from
// one wait tick to the next while no step is served.
`default_nettype none

module waiting_steps (
    input  wire logic clk_i,
    input  wire logic rst_i,
    input  wire logic step_i,
    input  wire logic dir_i,
    input  wire logic points_i,     // direction of DIR
    input  wire logic take_i,       // the first step is served
    input  wire logic wait_tick_i,
    output logic      any_o,        // a step waits
    output logic      same_o,       // the first step has DIR's direction; delayed by a clock
    output logic      other_o,      // the first step has the other direction; delayed by a clock
    output logic      fault_o       // event
);
  // Index 0 is the next step: valid flags as a thermometer code, and a direction per place.
  logic [3:0] valid_q;
  logic [3:0] direction_q;
  logic       waited_q;  // a step waited at the last wait tick, none was served since
  logic       same;

  assign any_o = valid_q[0];
  assign same  = valid_q[0] && direction_q[0] == points_i;

  always_ff @(posedge clk_i) begin : p_steps
    logic [3:0] from_before;  // the place before has a step
    logic [3:0] from_after;  // the place after has a step
    logic [3:0] direction_after;

    same_o  <= same;
    other_o <= valid_q[0] && !same;
    if (take_i || step_i) begin
      from_before = {valid_q[2:0], 1'b1};
      from_after = {1'b0, valid_q[3:1]};
      direction_after = {1'b0, direction_q[3:1]};
      for (int i = 0; i < 4; i++) begin
        if (take_i) direction_q[i] <= from_after[i] ? direction_after[i] : dir_i;
        else if (!valid_q[i]) direction_q[i] <= dir_i;
      end
      if (take_i ^ step_i) valid_q <= take_i ? from_after : from_before;
    end
    if (rst_i) begin
      valid_q <= '0;
      same_o  <= 1'b0;
      other_o <= 1'b0;
    end
  end

  always_ff @(posedge clk_i) begin
    fault_o <= !take_i && ((step_i && valid_q[3]) || (wait_tick_i && waited_q));
    if (take_i) waited_q <= 1'b0;
    else if (wait_tick_i) waited_q <= valid_q[0];
    if (rst_i) begin
      fault_o  <= 1'b0;
      waited_q <= 1'b0;
    end
  end
endmodule

`default_nettype wire
