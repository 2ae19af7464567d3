// Targets of the load bus {valid, target[4:0], word[15:0]} and of the feed load {valid, target[2:0], word[15:0]}.
`default_nettype none
package load_target_pkg;

  localparam logic [4:0] INCREMENT = 5'd0;  // and the axis
  localparam logic [4:0] COUNT = 5'd8;  // and the axis
  localparam logic [4:0] TICKS = 5'd16;
  localparam logic [4:0] PRESCALE = 5'd17;
  localparam logic [4:0] DEVIATION = 5'd18;
  localparam logic [4:0] GRADIENT_X = 5'd19;
  localparam logic [4:0] GRADIENT_Y = 5'd20;
  localparam logic [4:0] HALF_X = 5'd21;
  localparam logic [4:0] HALF_Y = 5'd22;
  localparam logic [4:0] END_X = 5'd23;
  localparam logic [4:0] END_Y = 5'd24;
  localparam logic [4:0] QUADRANTS = 5'd25;
  localparam logic [4:0] PLANE = 5'd26;
  localparam logic [4:0] SHIFTS = 5'd27;  // the arc generator's
  localparam logic [4:0] STATE = 5'd28;  // X, then Y
  localparam logic [4:0] CLOSING = 5'd29;  // of x, then of y
  localparam logic [4:0] COMMAND = 5'd30;  // fields of commands that are no paths
  localparam logic [4:0] NOWHERE = 5'd31;

  localparam logic [2:0] FEED_TICKS = 3'd0;
  localparam logic [2:0] FEED_RATE = 3'd1;
  localparam logic [2:0] FEED_FLOOR = 3'd2;
  localparam logic [2:0] FEED_STOP_DISTANCE = 3'd3;
  localparam logic [2:0] FEED_ACCELERATION = 3'd4;
  localparam logic [2:0] FEED_JERK = 3'd5;
  localparam logic [2:0] FEED_NOWHERE = 3'd6;

endpackage
`default_nettype wire
