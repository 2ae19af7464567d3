// The constant registers whose values depend on parameters: one word for each of the first 16 words of the register
// map.
`default_nettype none
package card_constants_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int FIRST = 0;  // 512 bits: 16 words, that of address 0 lowest
  localparam int WIDTH = 512;

  function automatic logic [31:0] word(input logic [WIDTH-1:0] constants, input logic [3:0] index);
    word = constants[32*index+:32];
  endfunction

  // All zeros except for the constant at this byte address.
  function automatic logic [WIDTH-1:0] at(input logic [11:0] address, input logic [31:0] value);
    at = WIDTH'(value) << 8 * address;
  endfunction

endpackage
`default_nettype wire
