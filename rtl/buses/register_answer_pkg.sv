// The answer to an access.
`default_nettype none
package register_answer_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int DATA = 0;  // 32 bits: with ACK: data of a read that was not refused (combinational); otherwise 0
  localparam int ERROR = 32;  // with ACK: the access was refused and changed nothing
  localparam int ACK = 33;  // event
  localparam int WIDTH = 34;

  function automatic logic [31:0] data(input logic [WIDTH-1:0] answer);
    data = answer[DATA+:32];
  endfunction

  function automatic logic [WIDTH-1:0] pack(input logic now, input logic refused, input logic [31:0] value);
    pack = {now, refused, value};
  endfunction

  // The answer for one of several ports: without ACK unless it is for this port.
  function automatic logic [WIDTH-1:0] only_if(input logic [WIDTH-1:0] answer, input logic mine);
    only_if = {answer[ACK] && mine, answer[ACK-1:0]};
  endfunction

endpackage
`default_nettype wire
