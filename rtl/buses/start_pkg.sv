// START for the direct loader, and the registers that the loader reads.
`default_nettype none
package start_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int DATA = 0;  // 32 bits: the register that start_answer_pkg::ADDRESS named two clocks ago
  localparam int MASK = 32;  // 8 bits: axes of the move; keeps its value until the answer
  localparam int START = 40;  // event
  localparam int WIDTH = 41;

  function automatic logic [31:0] data(input logic [WIDTH-1:0] start);
    data = start[DATA+:32];
  endfunction

  function automatic logic [7:0] mask(input logic [WIDTH-1:0] start);
    mask = start[MASK+:8];
  endfunction

  function automatic logic [WIDTH-1:0] pack(input logic now, input logic [7:0] axes, input logic [31:0] word);
    pack = {now, axes, word};
  endfunction

endpackage
`default_nettype wire
