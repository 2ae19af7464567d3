// Signals from a Wishbone B4 master to the card; each field is the Wishbone signal of that name.
`default_nettype none
package wishbone_request_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int DAT = 0;  // 32 bits: data of a write
  localparam int ADR = 32;  // 12 bits: address in bytes
  localparam int SEL = 44;  // 4 bits
  localparam int WE = 48;
  localparam int STB = 49;
  localparam int CYC = 50;
  localparam int WIDTH = 51;

  function automatic logic [31:0] dat(input logic [WIDTH-1:0] request);
    dat = request[DAT+:32];
  endfunction

  function automatic logic [11:0] adr(input logic [WIDTH-1:0] request);
    adr = request[ADR+:12];
  endfunction

  function automatic logic [3:0] sel(input logic [WIDTH-1:0] request);
    sel = request[SEL+:4];
  endfunction

endpackage
`default_nettype wire
