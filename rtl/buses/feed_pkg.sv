// What the time part says to the geometry part.
`default_nettype none
package feed_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int TAKE = 0;  // the tick is taken in this clock (combinational)
  localparam int AT_BARRIER = 1;  // the feed stands at a barrier
  localparam int RUNS = 2;  // a piece gives ticks, or a decoded one waits (combinational)
  localparam int AT_REST = 3;  // the ratio is 0 (combinational)
  localparam int STOPPING = 4;  // a fault's ramp
  localparam int WIDTH = 5;

endpackage
`default_nettype wire
