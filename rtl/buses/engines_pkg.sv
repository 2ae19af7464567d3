// State of the engine and of the axes on which the path runs.
`default_nettype none
package engines_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int READY = 0;  // a feed tick may be taken
  localparam int PAYLOAD_READY = 1;  // the engine's state may be loaded
  localparam int SHADOWS_FREE = 2;  // the increments of the axes may be loaded
  localparam int DONE = 3;  // all path ticks given so far are finished
  localparam int MISSED_END = 4;  // with DONE: the path ended away from its commanded end point
  localparam int LIVE = 5;  // an axis of a direct move has not yet made its count of steps
  localparam int BUSY = 6;  // an axis is still moving (combinational)
  localparam int QUIET = 7;  // no path tick waits or is on its way to an engine, and no engine is making a step
  localparam int WIDTH = 8;

endpackage
`default_nettype wire
