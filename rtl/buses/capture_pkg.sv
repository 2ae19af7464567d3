// Signals from the capture units to the registers: requests, captures for the queue, state. ASK is combinational from
// the inputs; the other fields are registered.
`default_nettype none
package capture_pkg;

  // Fields, lowest bit first; each ends where the next one begins. The first three have one bit per unit, for four
  // units.
  localparam int ASK = 0;  // levels: the unit requests a snapshot
  localparam int PASSED = 4;  // levels: the unit has a capture for the queue
  localparam int EDGE = 8;  // with PASSED: the level after the captured edge
  localparam int STATE = 12;  // 32 bits: the register CAPTURE_STATE
  localparam int WIDTH = 44;

  function automatic logic [3:0] ask(input logic [WIDTH-1:0] capture);
    ask = capture[ASK+:4];
  endfunction

  function automatic logic [3:0] passed(input logic [WIDTH-1:0] capture);
    passed = capture[PASSED+:4];
  endfunction

  function automatic logic [3:0] edge_of(input logic [WIDTH-1:0] capture);
    edge_of = capture[EDGE+:4];
  endfunction

  function automatic logic [31:0] state(input logic [WIDTH-1:0] capture);
    state = capture[STATE+:32];
  endfunction

  function automatic logic [WIDTH-1:0] pack(input logic [31:0] shown, input logic [3:0] level,
                                            input logic [3:0] hands_on, input logic [3:0] wants);
    pack = {shown, level, hands_on, wants};
  endfunction

endpackage
`default_nettype wire
