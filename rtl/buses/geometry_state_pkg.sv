// What the registers and the lockstep see of the geometry part.
`default_nettype none
package geometry_state_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int GEOMETRY_BEGUN = 0;  // 32 bits: the register GEOMETRY_BEGUN
  localparam int INPUTS = 32;  // 16 bits: levels, after synchroniser and polarity
  localparam int OUTPUTS = 48;  // 16 bits: levels
  localparam int MARKS = 64;  // 32 bits: MARKs that have taken effect
  localparam int STALE_TICKS = 96;  // 32 bits: ticks beyond the end of the last line of position streaming
  localparam int PATH_SWAP = 128;  // event: a path begins; of the lockstep alone
  localparam int STALE = 129;  // a line goes on beyond its end
  localparam int PROBED = 130;  // the probe has tripped
  localparam int PROBE_MISSED = 131;  // PROBE_END came before an edge
  localparam int WAITING = 132;  // WAIT_INPUT waits
  localparam int PATH_ACTIVE = 133;  // a path is under way
  localparam int ENDED = 134;  // the last command was an END (combinational)
  localparam int DIRECT = 135;  // a direct move is under way
  localparam int WIDTH = 136;

  function automatic logic [31:0] geometry_begun(input logic [WIDTH-1:0] state);
    geometry_begun = state[GEOMETRY_BEGUN+:32];
  endfunction

  function automatic logic [15:0] inputs(input logic [WIDTH-1:0] state);
    inputs = state[INPUTS+:16];
  endfunction

  function automatic logic [15:0] outputs(input logic [WIDTH-1:0] state);
    outputs = state[OUTPUTS+:16];
  endfunction

  function automatic logic [31:0] marks(input logic [WIDTH-1:0] state);
    marks = state[MARKS+:32];
  endfunction

  function automatic logic [31:0] stale_ticks(input logic [WIDTH-1:0] state);
    stale_ticks = state[STALE_TICKS+:32];
  endfunction

endpackage
`default_nettype wire
