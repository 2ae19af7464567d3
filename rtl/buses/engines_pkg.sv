// What engines and axes say of the path that runs on them.
`default_nettype none
package engines_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int READY = 0;  // a feed tick may be taken
  localparam int PAYLOAD_READY = 1;  // the engine's state may be loaded
  localparam int SHADOWS_FREE = 2;  // so may the axes' increments
  localparam int DONE = 3;  // every path tick given is finished
  localparam int MISSED_END = 4;  // with done: not on the commanded end point
  localparam int LIVE = 5;  // an axis has not made its count of steps
  localparam int BUSY = 6;  // an axis still moves (combinational)
  localparam int QUIET = 7;  // no path tick waits or is on its way to an engine, none makes a step
  localparam int WIDTH = 8;

endpackage
`default_nettype wire
