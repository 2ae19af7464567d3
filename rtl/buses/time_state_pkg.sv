// State of the time part, for the registers and the lockstep.
`default_nettype none
package time_state_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int FAULT = 0;  // 32 bits: the register FAULT
  localparam int FEED_BEGUN = 32;  // 32 bits: the register FEED_BEGUN
  localparam int UNDERRUNS = 64;  // 32 bits: number of under-run holds so far
  localparam int RATE = 96;  // 32 bits: feed ticks per enabled clock, in units of 2^-32; for the lockstep only
  localparam int RATIO = 128;  // 17 bits: enabled clocks per clock, in units of 2^-16; for the lockstep only
  localparam int TICK = 145;  // event: a tick is taken; for the lockstep only
  localparam int FEED_SWAP = 146;  // event: a feed piece begins; for the lockstep only
  localparam int UNDERRUN = 147;  // an under-run hold is in force, or its rule keeps a piece waiting
  localparam int HELD = 148;  // the ratio is 0 (combinational)
  localparam int FEED_ACTIVE = 149;  // a feed piece gives ticks
  localparam int STOPPING = 150;  // a fault's stop is under way; a cut follows
  localparam int LIMIT_STATE = 151;  // 28 bits: the register LIMIT_STATE
  localparam int BUTTON_HOLD = 179;  // the feed hold button holds the motion
  localparam int PLACE = 180;  // 16 bits: the register PLACE
  localparam int SETTLED = 196;  // nothing moves, and no tick is on its way (combinational)
  localparam int ENABLED = 197;  // the drives are enabled
  localparam int ENABLE_WAITS = 198;  // motion waits until the drives are enabled (combinational)
  localparam int WIDTH = 199;

  function automatic logic [31:0] fault(input logic [WIDTH-1:0] state);
    fault = state[FAULT+:32];
  endfunction

  function automatic logic [31:0] feed_begun(input logic [WIDTH-1:0] state);
    feed_begun = state[FEED_BEGUN+:32];
  endfunction

  function automatic logic [31:0] underruns(input logic [WIDTH-1:0] state);
    underruns = state[UNDERRUNS+:32];
  endfunction

  function automatic logic [31:0] rate(input logic [WIDTH-1:0] state);
    rate = state[RATE+:32];
  endfunction

  function automatic logic [27:0] limit_state(input logic [WIDTH-1:0] state);
    limit_state = state[LIMIT_STATE+:28];
  endfunction

  function automatic logic [15:0] place(input logic [WIDTH-1:0] state);
    place = state[PLACE+:16];
  endfunction

  function automatic logic [16:0] ratio(input logic [WIDTH-1:0] state);
    ratio = state[RATIO+:17];
  endfunction

endpackage
`default_nettype wire
