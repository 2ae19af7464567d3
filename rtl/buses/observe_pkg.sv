// What the lockstep sees of the card; a board leaves it open. Above these fields stand those of axis_observe_pkg for
// each axis, axis 0 lowest.
`default_nettype none
package observe_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int TICK = 0;  // event: a tick is taken
  localparam int PATH_TICK = 1;  // event: a tick of the path's engine
  localparam int PATH_SWAP = 2;  // event: a path begins
  localparam int FEED_SWAP = 3;  // event: a feed piece begins
  localparam int RATIO = 4;  // 17 bits: 2^-16
  localparam int RATE = 21;  // 32 bits: ticks per enabled clock, 2^-32
  localparam int FEED_BEGUN = 53;  // 32 bits: registers, as the next five
  localparam int GEOMETRY_BEGUN = 85;  // 32 bits
  localparam int FAULT = 117;  // 32 bits
  localparam int STATUS = 149;  // 32 bits: refused is any port's
  localparam int FEED_ROOM = 181;  // 16 bits
  localparam int GEOMETRY_ROOM = 197;  // 16 bits
  localparam int WIDTH = 213;

endpackage
`default_nettype wire
