// State of paths and direct moves, for the registers and the lockstep.
`default_nettype none
package geometry_state_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int GEOMETRY_BEGUN = 0;  // 32 bits: the register GEOMETRY_BEGUN
  localparam int STALE_TICKS = 32;  // 32 bits: ticks beyond the end of the last line of position streaming
  localparam int PATH_SWAP = 64;  // event: a path begins; for the lockstep only
  localparam int STALE = 65;  // a line continues beyond its end (position streaming)
  localparam int WAITING = 66;  // a WAIT_INPUT is waiting (combinational)
  localparam int PATH_ACTIVE = 67;  // a path is under way
  localparam int ENDED = 68;  // the last command was an END (combinational)
  localparam int DIRECT = 69;  // a direct move is under way
  localparam int WIDTH = 70;

  function automatic logic [31:0] geometry_begun(input logic [WIDTH-1:0] state);
    geometry_begun = state[GEOMETRY_BEGUN+:32];
  endfunction

  function automatic logic [31:0] stale_ticks(input logic [WIDTH-1:0] state);
    stale_ticks = state[STALE_TICKS+:32];
  endfunction

endpackage
`default_nettype wire
