// Signals of the card for the lockstep; a board leaves them open. Above these fields follow those of axis_observe_pkg,
// one set per axis, axis 0 lowest.
`default_nettype none
package observe_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int TICK = 0;  // event: a tick is taken
  localparam int PATH_TICK = 1;  // event: a tick of the path's engine
  localparam int PATH_SWAP = 2;  // event: a path begins
  localparam int FEED_SWAP = 3;  // event: a feed piece begins
  localparam int RATIO = 4;  // 17 bits: the ratio, in units of 2^-16
  localparam int RATE = 21;  // 32 bits: feed ticks per enabled clock, in units of 2^-32
  localparam int FEED_BEGUN = 53;  // 32 bits: this field and the next five are registers
  localparam int GEOMETRY_BEGUN = 85;  // 32 bits
  localparam int FAULT = 117;  // 32 bits
  localparam int STATUS = 149;  // 32 bits: its bit REFUSED shows a refusal of any port
  localparam int FEED_ROOM = 181;  // 16 bits
  localparam int GEOMETRY_ROOM = 197;  // 16 bits
  localparam int WIDTH = 213;

endpackage
`default_nettype wire
