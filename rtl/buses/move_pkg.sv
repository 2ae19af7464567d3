// A path that the geometry part hands to the engines and the axes.
`default_nettype none
package move_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int ENGINE = 0;  // 5 bits: with SWAP: number of the path's engine, card_map_pkg::ENGINE_*
  localparam int AXES = 5;  // 8 bits: with SWAP: the axes whose own pulse generators make the steps
  localparam int SWAP = 13;  // event: the path begins with the next tick
  localparam int DIRECT = 14;  // the path is a direct move
  localparam int TAKING = 15;  // a path on an engine other than lines still takes ticks (combinational)
  localparam int WIDTH = 16;

  function automatic logic [4:0] engine(input logic [WIDTH-1:0] move);
    engine = move[ENGINE+:5];
  endfunction

  function automatic logic [7:0] axes(input logic [WIDTH-1:0] move);
    axes = move[AXES+:8];
  endfunction

endpackage
`default_nettype wire
