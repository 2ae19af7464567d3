// Destinations of halfwords: {unit, target} on the load bus, where each unit numbers its own targets, and the targets
// of the feed load.
`default_nettype none
package load_target_pkg;

  // Units. Those with a descriptor have the same number in rtl/regs/units.toml. Units 0 to 7 are the axes.
  localparam logic [4:0] UNIT_SEQUENCER = 5'd8;
  localparam logic [4:0] UNIT_PRESCALER = 5'd9;
  localparam logic [4:0] UNIT_ACCUMULATOR = 5'd10;
  localparam logic [4:0] UNIT_ARC_GENERATOR = 5'd11;
  localparam logic [4:0] UNIT_PATH_COMMANDS = 5'd12;
  localparam logic [4:0] UNIT_NOWHERE = 5'd31;

  // Targets of an axis.
  localparam logic [3:0] INCREMENT = 4'd0;
  localparam logic [3:0] COUNT = 4'd1;  // steps of a direct move

  function automatic logic [8:0] of_axis(input logic [2:0] axis, input logic [3:0] target);
    of_axis = {2'd0, axis, target};
  endfunction

  // Targets of the other units.
  localparam logic [8:0] TICKS = {UNIT_SEQUENCER, 4'd0};  // ticks of the path
  localparam logic [8:0] PRESCALE = {UNIT_PRESCALER, 4'd0};
  localparam logic [8:0] DEVIATION = {UNIT_ACCUMULATOR, 4'd0};
  localparam logic [8:0] GRADIENT_X = {UNIT_ACCUMULATOR, 4'd1};
  localparam logic [8:0] GRADIENT_Y = {UNIT_ACCUMULATOR, 4'd2};
  localparam logic [8:0] HALF_X = {UNIT_ACCUMULATOR, 4'd3};
  localparam logic [8:0] HALF_Y = {UNIT_ACCUMULATOR, 4'd4};
  localparam logic [8:0] END_X = {UNIT_ACCUMULATOR, 4'd5};
  localparam logic [8:0] END_Y = {UNIT_ACCUMULATOR, 4'd6};
  localparam logic [8:0] QUADRANTS = {UNIT_ACCUMULATOR, 4'd7};
  localparam logic [8:0] PLANE = {UNIT_ACCUMULATOR, 4'd8};
  localparam logic [8:0] CHORD_SHIFTS = {UNIT_ARC_GENERATOR, 4'd0};
  localparam logic [8:0] CHORD_STATE = {UNIT_ARC_GENERATOR, 4'd1};  // X, then Y
  localparam logic [8:0] CHORD_CLOSING = {UNIT_ARC_GENERATOR, 4'd2};  // closing increment of x, then of y
  localparam logic [8:0] CHORD_PLANE = {UNIT_ARC_GENERATOR, 4'd8};
  localparam logic [8:0] COMMAND = {UNIT_PATH_COMMANDS, 4'd0};  // fields of commands that are not paths
  localparam logic [8:0] NOWHERE = {UNIT_NOWHERE, 4'd15};

  // Targets of the feed load, in the order of a piece's fields.
  localparam logic [2:0] FEED_TICKS = 3'd0;
  localparam logic [2:0] FEED_RATE = 3'd1;
  localparam logic [2:0] FEED_FLOOR = 3'd2;
  localparam logic [2:0] FEED_STOP_DISTANCE = 3'd3;
  localparam logic [2:0] FEED_ACCELERATION = 3'd4;
  localparam logic [2:0] FEED_JERK = 3'd5;
  localparam logic [2:0] FEED_NOWHERE = 3'd6;

endpackage
`default_nettype wire
