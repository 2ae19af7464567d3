// Signals from the time part to the geometry part. SILENT also goes to the axes.
`default_nettype none
package feed_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int AT_BARRIER = 0;  // the feed waits at a barrier
  localparam int RUNS = 1;  // a piece gives ticks, or a decoded one waits (combinational)
  localparam int AT_REST = 2;  // the ratio is 0 (combinational)
  localparam int STOPPING = 3;  // a fault's stop is under way; a cut follows
  localparam int SILENT = 4;  // the ticks of the current piece make no steps
  localparam int CLOSING = 5;  // no more ticks are taken; a cut follows
  localparam int CAUSED = 6;  // a cause of a stop is present, or the card is stopping or stopped (combinational)
  localparam int LATCHED = 7;  // latch of the emergency stop (asynchronous)
  localparam int ENABLED = 8;  // the drives are enabled
  localparam int RELEASED = 9;  // the brake is released
  localparam int HEALTHY = 10;  // the card is healthy
  localparam int PUMP = 11;  // square wave of the charge pump
  localparam int GIVES = 12;  // a piece is under way, and the drives are ready for its ticks (combinational)
  localparam int RATIO = 13;  // 17 bits: the ratio, in units of 2^-16
  localparam int RATE = 30;  // 32 bits: feed ticks per enabled clock, in units of 2^-32
  localparam int WIDTH = 62;

  function automatic logic [16:0] ratio(input logic [WIDTH-1:0] feed);
    ratio = feed[RATIO+:17];
  endfunction

  function automatic logic [31:0] rate(input logic [WIDTH-1:0] feed);
    rate = feed[RATE+:32];
  endfunction

endpackage
`default_nettype wire
