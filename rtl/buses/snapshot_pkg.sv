// The snapshot chain: a shift register through all blocks that own a latched value. At a strobe each owner takes its
// value; at a shift it takes the word of the owner before it.
`default_nettype none
package snapshot_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int WORD = 0;  // 32 bits: word of the owner before
  localparam int STROBE = 32;  // event
  localparam int SHIFT = 33;  // event, never with a strobe
  localparam int REST = 34;  // with STROBE: the snapshot is for the area REST
  localparam int WIDTH = 35;

  function automatic logic [31:0] word(input logic [WIDTH-1:0] chain);
    word = chain[WORD+:32];
  endfunction

  // The chain after an owner that holds `value`.
  function automatic logic [WIDTH-1:0] with_word(input logic [WIDTH-1:0] chain, input logic [31:0] value);
    with_word = {chain[REST], chain[SHIFT], chain[STROBE], value};
  endfunction

  function automatic logic [WIDTH-1:0] pack(input logic of_rest, input logic shift_now, input logic strobe_now,
                                            input logic [31:0] value);
    pack = {of_rest, shift_now, strobe_now, value};
  endfunction

endpackage
`default_nettype wire
