// Answers of the command checker to the stream.
`default_nettype none
package stream_answer_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int REASON = 0;  // 8 bits: reason of the last refusal
  localparam int NUMBER = 8;  // 8 bits: command number in the last header
  localparam int REFUSE = 16;  // event
  localparam int READY = 17;  // the next word may come
  localparam int PARTIAL = 18;  // the stream is inside a command
  localparam int WIDTH = 19;

  // {number, reason}, as REFUSAL shows them.
  function automatic logic [15:0] why(input logic [WIDTH-1:0] answer);
    why = answer[REASON+:16];
  endfunction

  function automatic logic [WIDTH-1:0] pack(input logic under_way, input logic ready_now, input logic refuse_now,
                                            input logic [7:0] number, input logic [7:0] reason);
    pack = {under_way, ready_now, refuse_now, number, reason};
  endfunction

endpackage
`default_nettype wire
