// The steps that came and are not made yet, in order: a direction each, up to four.
//
// A step that finds all places taken is dropped, which is a fault; so is one that waits from one wait tick to the next
// without any being served.
`default_nettype none

module waiting_steps (
    input  wire logic clk_i,
    input  wire logic rst_i,
    input  wire logic step_i,
    input  wire logic dir_i,
    input  wire logic points_i,     // the way DIR points
    input  wire logic take_i,       // the first step is served
    input  wire logic wait_tick_i,
    output logic      any_o,        // a step waits
    output logic      same_o,       // the first goes the way DIR points; a clock late
    output logic      other_o,      // it goes the other way; a clock late
    output logic      fault_o       // event
);
  // The next one at 0: a thermometer of valid flags and a direction each.
  logic [3:0] valid_q;
  logic [3:0] direction_q;
  logic       waited_q;  // since the last wait tick
  logic       same;

  assign any_o = valid_q[0];
  assign same  = valid_q[0] && direction_q[0] == points_i;

  always_ff @(posedge clk_i) begin : p_steps
    logic [3:0] from_before;  // is there a step in the place before
    logic [3:0] from_after;  // and after
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
