// What the lockstep and the soft limits see of an axis.
`default_nettype none
package axis_observe_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int STEP = 0;  // event: a step on the path
  localparam int DIR = 1;  // with step: 1 backwards, 0 forwards; held
  localparam int POSITION = 2;  // 32 bits: steps at the pins
  localparam int COUNTS = 34;  // event: a pulse begins; the position has it in the next clock
  localparam int COUNTS_BACK = 35;  // with it: 1 backwards, 0 forwards
  localparam int WIDTH = 36;

  function automatic logic [31:0] position(input logic [WIDTH-1:0] axis);
    position = axis[POSITION+:32];
  endfunction

endpackage
`default_nettype wire
