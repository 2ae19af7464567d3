// A refusal that register_access reports to REFUSAL of the port that made the access (combinational).
`default_nettype none
package refusal_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int REASON = 0;  // 8 bits: a REFUSE_* of the register map
  localparam int NUMBER = 8;  // 8 bits: number of the stream's command
  localparam int REFUSE = 16;  // event: an access or a word of the stream was refused
  localparam int CLEAR = 17;  // event: the port clears its REFUSAL; never with a refusal
  localparam int WIDTH = 18;

  // {number, reason}, as REFUSAL shows them.
  function automatic logic [15:0] why(input logic [WIDTH-1:0] refusal);
    why = refusal[REASON+:16];
  endfunction

  function automatic logic [WIDTH-1:0] pack(input logic clear_now, input logic refuse_now, input logic [15:0] reasons);
    pack = {clear_now, refuse_now, reasons};
  endfunction

endpackage
`default_nettype wire
