// Signals of one axis for the lockstep and the soft limits.
`default_nettype none
package axis_observe_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int STEP = 0;  // event: a step on the path
  localparam int DIR = 1;  // with STEP: 1 backwards, 0 forwards; keeps its value between steps
  localparam int POSITION = 2;  // 32 bits: position counter, in steps at the pins
  localparam int COUNTS = 34;  // event: a pulse begins; POSITION includes it from the next clock on
  localparam int COUNTS_BACK = 35;  // with COUNTS: 1 backwards, 0 forwards
  localparam int WIDTH = 36;

  function automatic logic [31:0] position(input logic [WIDTH-1:0] axis);
    position = axis[POSITION+:32];
  endfunction

endpackage
`default_nettype wire
