// Causes of a stop that come from the machine's inputs.
`default_nettype none
package stop_causes_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int LIMIT = 0;  // event: a step into an active limit
  localparam int BEYOND = 1;  // event, with LIMIT: the axis has used up its overtravel
  localparam int DRIVE_FAULT = 2;  // a drive reports a fault
  localparam int PROBE = 3;  // event: the probe became active during motion, outside probing
  localparam int TOOL_SETTER = 4;  // event: the tool setter's switch became active during motion
  localparam int WIDTH = 5;

endpackage
`default_nettype wire
