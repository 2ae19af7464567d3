// Signals from the probe and the inputs to the geometry sequencer.
`default_nettype none
package probe_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int MET = 0;  // the condition of the command decoded last is met (combinational)
  localparam int TAKEN = 1;  // the PROBE is taken now (combinational)
  localparam int STAYS = 2;  // PROBE_END must wait (combinational)
  localparam int HOLD = 3;  // the probe has tripped: the time base slows down to rest
  localparam int BUSY = 4;  // the probe is armed, or has tripped and PROBE_END has not ended it
  localparam int WIDTH = 5;

endpackage
`default_nettype wire
