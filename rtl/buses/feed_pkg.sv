// What the time part says to the geometry part and, of the silence, to the axes.
`default_nettype none
package feed_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int AT_BARRIER = 0;  // the feed stands at a barrier
  localparam int RUNS = 1;  // a piece gives ticks, or a decoded one waits (combinational)
  localparam int AT_REST = 2;  // the ratio is 0 (combinational)
  localparam int STOPPING = 3;  // on the way to a fault's cut
  localparam int SILENT = 4;  // the piece's ticks make no steps
  localparam int CLOSING = 5;  // no tick is taken any more, a cut follows
  localparam int CAUSED = 6;  // a cause of a stop comes, or a stop is under way or has been (combinational)
  localparam int LATCHED = 7;  // the emergency stop's latch: asynchronous
  localparam int ENABLED = 8;  // the drives are
  localparam int RELEASED = 9;  // their brake is
  localparam int HEALTHY = 10;  // the card is
  localparam int PUMP = 11;  // the charge pump's square wave
  localparam int GIVES = 12;  // a piece is under way, and the drives do not keep its ticks back (combinational)
  localparam int RATIO = 13;  // 17 bits: 2^-16
  localparam int RATE = 30;  // 32 bits: 2^-32 feed ticks per enabled clock
  localparam int WIDTH = 62;

  function automatic logic [16:0] ratio(input logic [WIDTH-1:0] feed);
    ratio = feed[RATIO+:17];
  endfunction

  function automatic logic [31:0] rate(input logic [WIDTH-1:0] feed);
    rate = feed[RATE+:32];
  endfunction

endpackage
`default_nettype wire
