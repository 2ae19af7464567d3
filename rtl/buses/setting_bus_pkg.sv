// The setting bus: broadcasts each setting that a host writes, once the register map has checked it. Each block keeps
// its own settings and knows their addresses. Writes to the block RAM of the registers have the same form.
`default_nettype none
package setting_bus_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int DATA = 0;  // 32 bits
  localparam int WORD = 32;  // 10 bits: the register's address in words of 4 bytes
  localparam int SET = 42;  // event: word and data are valid in this clock
  localparam int WIDTH = 43;

  function automatic logic [9:0] word(input logic [WIDTH-1:0] bus);
    word = bus[WORD+:10];
  endfunction

  function automatic logic [31:0] data(input logic [WIDTH-1:0] bus);
    data = bus[DATA+:32];
  endfunction

  // Whether the setting at this byte address is written now.
  function automatic logic writes(input logic [WIDTH-1:0] bus, input logic [11:0] address);
    writes = bus[SET] && bus[WORD+:10] == address[11:2];
  endfunction

  function automatic logic [WIDTH-1:0] pack(input logic now, input logic [9:0] place, input logic [31:0] value);
    pack = {now, place, value};
  endfunction

endpackage
`default_nettype wire
