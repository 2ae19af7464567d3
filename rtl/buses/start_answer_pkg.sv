// Signals from the direct loader to the registers.
`default_nettype none
package start_answer_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int REASON = 0;  // 8 bits: with ERROR: why START is refused
  localparam int ERROR = 8;  // with DONE: START is refused
  localparam int DONE = 9;  // event: START is carried out or refused
  localparam int ADDRESS = 10;  // 10 bits: word address of the register that the loader reads
  localparam int WIDTH = 20;

  function automatic logic [7:0] reason(input logic [WIDTH-1:0] answer);
    reason = answer[REASON+:8];
  endfunction

  function automatic logic [9:0] address(input logic [WIDTH-1:0] answer);
    address = answer[ADDRESS+:10];
  endfunction

  function automatic logic [WIDTH-1:0] pack(input logic [9:0] place, input logic now, input logic refused,
                                            input logic [7:0] why);
    pack = {place, now, refused, why};
  endfunction

endpackage
`default_nettype wire
