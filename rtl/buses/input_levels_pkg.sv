// The levels of the card's inputs after synchroniser and polarity, both before and after their filters: one bundle for
// all blocks that read inputs. There is one bit per input; absent inputs are 0. Without machine inputs there are no
// filters.
`default_nettype none
package input_levels_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int LEVELS = 0;  // 32 bits: after the filters (combinational)
  localparam int RAW = 32;  // 32 bits: before the filters (combinational)
  localparam int QUIET = 64;  // 32 bits, with captures: RAW has equalled LEVELS for a whole filter length
  localparam int WIDTH = 96;

  function automatic logic [31:0] levels(input logic [WIDTH-1:0] inputs);
    levels = inputs[LEVELS+:32];
  endfunction

  function automatic logic [31:0] raw(input logic [WIDTH-1:0] inputs);
    raw = inputs[RAW+:32];
  endfunction

  function automatic logic [31:0] quiet(input logic [WIDTH-1:0] inputs);
    quiet = inputs[QUIET+:32];
  endfunction

endpackage
`default_nettype wire
