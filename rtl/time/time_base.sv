// The time base: a clock enable with a programmable ratio of all clocks, slewed linearly towards its target.
//
// Every 4th clock the ratio moves by at most a step towards its goal and never past it. An update takes 4 clocks:
//   0  the last update's result becomes the ratio; the goal of this update is sampled (hold, or the class's target)
//   1  direction: goal against ratio
//   2  candidate: ratio + or - step
//   3  whether the candidate reached or passed the goal
// A step is SLEW. With classes it is doubled as often as the piece in force says, up to three times: turn 2 samples
// SLEW and the number of doublings for the next update, turns 3, 0 and 1 double. A doubling that would exceed 28 bits
// is not made.
// The goal is a sampled copy, because direction and arrival must be judged against the same goal: otherwise a hold that
// comes in between would let the ratio jump.
`default_nettype none

module time_base #(
    parameter logic [31:0] Engines = '1  // built-in engines: bits card_map_pkg::ENGINE_*
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic hold_i,
    input wire logic [1:0] class_i,  // class of the piece in force
    input wire logic [1:0] slew_shift_i,  // doublings of SLEW in that piece, with classes
    input wire logic [7:0] left_i,  // value of the snapshot REST in place of the ratio
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o,
    output logic enable_o,
    output logic [16:0] ratio_o
);
  // Q1.28: 1 is 2^28. The candidate is between -2^28 and 2^29 - 1, modulo 2^29.
  localparam logic [28:0] ONE = 29'h1000_0000;

  logic [16:0] feed_q;
  logic [16:0] rapid_q;
  logic [16:0] fixed_q;
  logic [16:0] target;
  logic [27:0] slew_q;
  logic [27:0] step_q;  // step of the update
  logic [ 1:0] doublings_q;  // doublings that the step still needs
  logic [ 1:0] turn_q;
  logic [31:0] data;

  assign data = setting_bus_pkg::data(setting_i);

  always_ff @(posedge clk_i) begin
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_RATIO_FEED)) feed_q <= data[16:0];
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_SLEW)) slew_q <= data[27:0];
    if (rst_i) begin
      feed_q <= card_map_pkg::RESET_RATIO_FEED[16:0];
      slew_q <= card_map_pkg::RESET_SLEW[27:0];
    end
  end

  if (Engines[card_map_pkg::ENGINE_CLASSES]) begin : gen_classes
    always_ff @(posedge clk_i) begin
      if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_RATIO_RAPID)) rapid_q <= data[16:0];
      if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_RATIO_FIXED)) fixed_q <= data[16:0];
      if (rst_i) begin
        rapid_q <= card_map_pkg::RESET_RATIO_RAPID[16:0];
        fixed_q <= card_map_pkg::RESET_RATIO_FIXED[16:0];
      end
    end

    always_comb begin
      target = feed_q;
      if (class_i == 2'(card_map_pkg::CLASS_RAPID)) target = rapid_q;
      if (class_i == 2'(card_map_pkg::CLASS_FIXED)) target = fixed_q;
    end

    always_ff @(posedge clk_i) begin
      if (turn_q == 2'd2) begin
        step_q <= slew_q;
        doublings_q <= slew_shift_i;
      end else if (doublings_q != 2'd0 && !step_q[27]) begin
        step_q <= {step_q[26:0], 1'b0};
        doublings_q <= doublings_q - 2'd1;
      end
      if (rst_i) begin
        step_q <= card_map_pkg::RESET_SLEW[27:0];
        doublings_q <= 2'd0;
      end
    end
  end else begin : gen_no_classes
    assign {rapid_q, fixed_q} = '0;
    assign target = feed_q;
    assign step_q = slew_q;
    assign doublings_q = 2'd0;

    logic unused_class;
    assign unused_class = &{1'b0, class_i, slew_shift_i, rapid_q, fixed_q, doublings_q};
  end

  logic [28:0] ratio_q;
  logic [16:0] inverted_goal_q;  // inverted, so that an adder compares with it: X - goal - 1 = X + ~goal
  logic up_q, arrived_q;
  logic [28:0] candidate_q;

  // Ratio less goal less one, and candidate less goal less one; the goal has 12 zeros below. The lowest bits make the
  // carry in: it is 1 if the number has ones below, and for a candidate on its way up. Ratio and candidate are within a
  // step of each other, and the goal is on the candidate's side or between them; so the candidate's difference needs no
  // more bits than the goal.
  logic [18:0] ratio_sum;
  logic [17:0] candidate_sum;
  assign ratio_sum = {1'b0, ratio_q[28:12], 1'b1} + {1'b1, inverted_goal_q, ratio_q[11:0] != 12'd0};
  assign candidate_sum = {candidate_q[28:12], 1'b1} + {inverted_goal_q, up_q || candidate_q[11:0] != 12'd0};

  logic [28:0] goal;
  assign goal = {~inverted_goal_q, 12'd0};

  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      turn_q <= 2'd0;
      ratio_q <= ONE;
      inverted_goal_q <= ~17'h1_0000;
      arrived_q <= 1'b1;
    end else begin
      turn_q <= turn_q + 2'd1;
      if (turn_q == 2'd0) begin
        ratio_q <= arrived_q ? goal : candidate_q[28:0];
        inverted_goal_q <= hold_i ? '1 : ~target;
      end
      if (turn_q == 2'd1) up_q <= ratio_sum[18];
      if (turn_q == 2'd2) begin
        candidate_q <= ratio_q + ({1'b0, step_q} ^ {29{!up_q}}) + {28'd0, !up_q};
      end
      if (turn_q == 2'd3) arrived_q <= candidate_sum[17] ^ up_q;
    end
  end

  logic [15:0] phase_q;
  logic enable_q;
  always_ff @(posedge clk_i) begin
    if (rst_i) {enable_q, phase_q} <= '0;
    else {enable_q, phase_q} <= {1'b0, phase_q} + ratio_q[28:12];
  end

  assign enable_o = enable_q;
  assign ratio_o  = ratio_q[28:12];

  // STATUS and FAULT pass through here: they are at most 22 bits wide.
  snapshot_slice #(
      .Width(22)
  ) ratio (
      .clk_i,
      .snapshot_i,
      .value_i(snapshot_i[snapshot_pkg::REST] ? {14'd0, left_i} : {5'd0, ratio_o}),
      .snapshot_o
  );

  logic unused;
  assign unused = &{1'b0, data[31:28], ratio_sum[17:0], candidate_sum[16:0]};
endmodule

`default_nettype wire
