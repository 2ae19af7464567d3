// Signals from the path engines to the axes. A field of 8 bits has one bit per axis, also for axes that the card
// lacks.
`default_nettype none
package axis_drive_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int CHORD_WORD = 0;  // 16 bits: a halfword of an axis's increment for the next chord of an arc
  localparam int CHORD_LOAD = 16;  // 8 bits: the axes that shift CHORD_WORD in
  localparam int CHORD_SWAP = 24;  // 8 bits: the axes whose next chord begins; a clock after the old chord ends
  localparam int STEP = 32;  // 8 bits: steps that an engine makes
  localparam int DIR = 40;  // 8 bits: with STEP: 1 backwards, 0 forwards
  localparam int TICK = 48;  // event: a tick for the axes' own pulse generators
  localparam int SWAP = 49;  // event: the next path begins
  localparam int WIDTH = 50;

  function automatic logic [15:0] chord_word(input logic [WIDTH-1:0] drive);
    chord_word = drive[CHORD_WORD+:16];
  endfunction

endpackage
`default_nettype wire
