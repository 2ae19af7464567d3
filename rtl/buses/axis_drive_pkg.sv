// What the path engines give to the axes. A bit per axis stands for each of the eight, whether the card has it or not.
`default_nettype none
package axis_drive_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int CHORD_WORD = 0;  // 16 bits: a halfword of the increment of an arc's next chord
  localparam int CHORD_LOAD = 16;  // 8 bits: the axes that take it
  localparam int CHORD_SWAP = 24;  // 8 bits: the axes that go on with their chord; a clock after the chord's last tick
  localparam int STEP = 32;  // 8 bits: steps of an engine
  localparam int DIR = 40;  // 8 bits: with step: 1 backwards, 0 forwards
  localparam int TICK = 48;  // event: a tick for the axes' own generators
  localparam int SWAP = 49;  // event: the next path begins
  localparam int WIDTH = 50;

  function automatic logic [15:0] chord_word(input logic [WIDTH-1:0] drive);
    chord_word = drive[CHORD_WORD+:16];
  endfunction

endpackage
`default_nettype wire
