// The levels of the card's inputs behind synchroniser and polarity: one bundle for every block that looks at an input.
`default_nettype none
package input_levels_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int LEVELS = 0;  // 16 bits: a bit for each input, 0 for absent ones (combinational)
  localparam int WIDTH = 16;

  function automatic logic [15:0] levels(input logic [WIDTH-1:0] inputs);
    levels = inputs[LEVELS+:16];
  endfunction

endpackage
`default_nettype wire
