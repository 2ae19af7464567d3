// An access to the registers. REQUEST is an event; the other fields keep their values from it until the answer,
// including the clock of the answer.
`default_nettype none
package register_access_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int DATA = 0;  // 32 bits: data of a write
  localparam int ADDRESS = 32;  // 12 bits: address in bytes
  localparam int PARTIAL = 44;  // a write that lacks a byte strobe
  localparam int WRITE = 45;  // 0: a read
  localparam int OF_SESSION = 46;  // 1: the access belongs to a session at the port; 0: to the port itself
  localparam int NEW_SESSION = 47;  // the first access of a session
  localparam int PORT = 48;  // 2 bits: the host port that made the access; 0 until the arbiter sets it
  localparam int REQUEST = 50;  // event
  localparam int WIDTH = 51;

  function automatic logic [31:0] data(input logic [WIDTH-1:0] access);
    data = access[DATA+:32];
  endfunction

  function automatic logic [11:0] address(input logic [WIDTH-1:0] access);
    address = access[ADDRESS+:12];
  endfunction

  function automatic logic [1:0] port(input logic [WIDTH-1:0] access);
    port = access[PORT+:2];
  endfunction

  // The register's address in words of 4 bytes.
  function automatic logic [9:0] word(input logic [WIDTH-1:0] access);
    word = access[ADDRESS+2+:10];
  endfunction

  // Whether the address is a multiple of 4.
  function automatic logic aligned(input logic [WIDTH-1:0] access);
    aligned = access[ADDRESS+:2] == 2'd0;
  endfunction

  function automatic logic [WIDTH-1:0] pack(input logic now, input logic is_write, input logic is_partial,
                                            input logic [11:0] place, input logic [31:0] value);
    pack = {now, 2'd0, 1'b0, 1'b1, is_write, is_partial, place, value};
  endfunction

  // The access of a port that has sessions.
  function automatic logic [WIDTH-1:0] with_session(input logic [WIDTH-1:0] access, input logic of_session,
                                                    input logic new_session);
    with_session = {access[WIDTH-1:PORT], new_session, of_session, access[OF_SESSION-1:0]};
  endfunction

  // The access as the arbiter passes it on: REQUEST is `now`, the port is `from`.
  function automatic logic [WIDTH-1:0] passed_on(input logic [WIDTH-1:0] access, input logic now,
                                                 input logic [1:0] from);
    passed_on = {now, from, access[PORT-1:0]};
  endfunction

endpackage
`default_nettype wire
