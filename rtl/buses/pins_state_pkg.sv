// State of inputs, outputs, MARKs and the probe, for the registers.
`default_nettype none
package pins_state_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int INPUTS = 0;  // 32 bits: levels, as in input_levels_pkg
  localparam int OUTPUTS = 32;  // 16 bits: levels
  localparam int MARKS = 48;  // 32 bits: number of MARKs that have taken effect
  localparam int PROBED = 80;  // the probe has tripped
  localparam int PROBE_MISSED = 81;  // PROBE_END came before the probe's edge
  localparam int WIDTH = 82;

  function automatic logic [31:0] inputs(input logic [WIDTH-1:0] state);
    inputs = state[INPUTS+:32];
  endfunction

  function automatic logic [15:0] outputs(input logic [WIDTH-1:0] state);
    outputs = state[OUTPUTS+:16];
  endfunction

  function automatic logic [31:0] marks(input logic [WIDTH-1:0] state);
    marks = state[MARKS+:32];
  endfunction

endpackage
`default_nettype wire
