// The feed load: carries halfwords of the next feed piece into shift chains, lowest halfword first. The targets are
// those of load_target_pkg.
`default_nettype none
package feed_load_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int WORD = 0;  // 16 bits: the halfword
  localparam int TARGET = 16;  // 3 bits
  localparam int VALID = 19;  // event
  localparam int WIDTH = 20;

  function automatic logic [15:0] word(input logic [WIDTH-1:0] load);
    word = load[WORD+:16];
  endfunction

  // Whether a halfword for this chain is on the bus now.
  function automatic logic to(input logic [WIDTH-1:0] load, input logic [2:0] target);
    to = load[VALID] && load[TARGET+:3] == target;
  endfunction

  function automatic logic [WIDTH-1:0] pack(input logic now, input logic [2:0] target, input logic [15:0] halfword);
    pack = {now, target, halfword};
  endfunction

endpackage
`default_nettype wire
