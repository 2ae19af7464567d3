// What the time part says to the geometry part and, of the silence, to the axes.
`default_nettype none
package feed_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int AT_BARRIER = 0;  // the feed stands at a barrier
  localparam int RUNS = 1;  // a piece gives ticks, or a decoded one waits (combinational)
  localparam int AT_REST = 2;  // the ratio is 0 (combinational)
  localparam int STOPPING = 3;  // a fault's ramp
  localparam int SILENT = 4;  // the piece's ticks make no steps
  localparam int WIDTH = 5;

endpackage
`default_nettype wire
