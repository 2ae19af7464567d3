// Signals from the geometry part to the time part.
`default_nettype none
package path_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int TAKING = 0;  // a path takes ticks
  localparam int DIRECT = 1;  // a direct move is under way
  localparam int STREAMING = 2;  // position streaming is in force
  localparam int BARRIER_BEGINS = 3;  // event: a barrier begins
  localparam int BARRIER_COUNTS = 4;  // the barrier counts clocks
  localparam int BARRIER_DONE = 5;  // event: both queues continue after the barrier
  localparam int DROP = 6;  // commands up to PROBE_END are dropped
  localparam int HALT = 7;  // event: the path and the piece under way end here
  localparam int HOLD = 8;  // a probe has tripped: the time base slows down to rest
  localparam int MISMATCH = 9;  // event: the fault TICK_MISMATCH
  localparam int INCOMPLETE = 10;  // event: the fault PATH_INCOMPLETE
  localparam int MISSING = 11;  // event: the fault MISSING_PERIOD
  localparam int PROBING = 12;  // a probe is armed, or has tripped and waits for PROBE_END
  localparam int UNFINISHED = 13;  // the path under way has ticks left (combinational)
  localparam int LEFT = 14;  // 40 bits: ticks left; valid three clocks after a tick, two clocks after a swap
  localparam int WIDTH = 54;

endpackage
`default_nettype wire
