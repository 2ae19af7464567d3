// Signals from the geometry sequencer to the path commands.
`default_nettype none
package commands_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int TAKE_OUTPUT = 0;  // OUTPUT is taken now; its last halfword is on the load bus (combinational)
  localparam int TAKE_MARK = 1;  // MARK is taken now (combinational)
  localparam int OVER = 2;  // event: a path ended: its last tick was taken (lines), or its engine has finished
  localparam int RUNS = 3;  // a path is under way
  localparam int PROBE_WAITS = 4;  // a PROBE is decoded and no path runs (combinational)
  localparam int PROBE_ENDS = 5;  // PROBE_END has begun (combinational)
  localparam int TAKE_PWM = 6;  // PWM is taken now; its last halfword is on the load bus (combinational)
  localparam int WIDTH = 7;

endpackage
`default_nettype wire
