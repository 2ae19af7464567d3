// The load bus: carries halfwords of decoded geometry commands and direct moves into shift chains, lowest halfword
// first (q <= {word, q[msb:16]}). Units and targets are those of load_target_pkg.
`default_nettype none
package load_bus_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int WORD = 0;  // 16 bits: the halfword
  localparam int TARGET = 16;  // 4 bits: the chain within the unit
  localparam int UNIT = 20;  // 5 bits: the block that owns the chain
  localparam int VALID = 25;  // event
  localparam int WIDTH = 26;

  function automatic logic [15:0] word(input logic [WIDTH-1:0] load);
    word = load[WORD+:16];
  endfunction

  // Whether a halfword for one of the unit's chains is on the bus now.
  function automatic logic to_unit(input logic [WIDTH-1:0] load, input logic [4:0] unit);
    to_unit = load[VALID] && load[UNIT+:5] == unit;
  endfunction

  // Whether a halfword for the chain at this {unit, target} is on the bus now.
  function automatic logic to(input logic [WIDTH-1:0] load, input logic [8:0] place);
    to = load[VALID] && load[TARGET+:9] == place;
  endfunction

  function automatic logic [WIDTH-1:0] pack(input logic now, input logic [8:0] place, input logic [15:0] halfword);
    pack = {now, place, halfword};
  endfunction

endpackage
`default_nettype wire
