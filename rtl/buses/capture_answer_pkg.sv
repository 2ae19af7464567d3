// Answers of the registers to the capture units. They are combinational and depend on the requests in capture_pkg,
// which do not depend on the answers.
`default_nettype none
package capture_answer_pkg;

  // Fields, lowest bit first; each ends where the next one begins. The first two have one bit per unit, for four
  // units.
  localparam int CAPTURED = 0;  // events: the requested snapshot is in the unit's area
  localparam int QUEUED = 4;  // events: the capture that the unit handed on is in the queue, or was lost
  localparam int FULL = 8;  // with QUEUED: the queue is full and the capture is lost
  localparam int WIDTH = 9;

  function automatic logic [3:0] captured(input logic [WIDTH-1:0] answer);
    captured = answer[CAPTURED+:4];
  endfunction

  function automatic logic [3:0] queued(input logic [WIDTH-1:0] answer);
    queued = answer[QUEUED+:4];
  endfunction

  function automatic logic [WIDTH-1:0] pack(input logic full, input logic [3:0] in_queue, input logic [3:0] in_area);
    pack = {full, in_queue, in_area};
  endfunction

endpackage
`default_nettype wire
