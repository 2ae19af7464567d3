// The roles of the card's inputs: active levels after the filters, registered. In a field of 8 bits, bit n belongs to
// axis n; absent axes are 0.
`default_nettype none
package input_roles_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int LIMIT_MINUS = 0;  // 8 bits: limit switch at the axis's negative end
  localparam int LIMIT_PLUS = 8;  // 8 bits: limit switch at the axis's positive end
  localparam int DRIVE_FAULT = 16;  // 8 bits: the axis's drive reports a fault
  localparam int FEED_HOLD = 24;  // the feed hold button
  localparam int CYCLE_START = 25;  // the cycle start button
  localparam int TOOL_SETTER = 26;  // the tool setter's overtravel switch
  localparam int PROBE = 27;
  localparam int WIDTH = 28;

  function automatic logic [7:0] limit_minus(input logic [WIDTH-1:0] roles);
    limit_minus = roles[LIMIT_MINUS+:8];
  endfunction

  function automatic logic [7:0] limit_plus(input logic [WIDTH-1:0] roles);
    limit_plus = roles[LIMIT_PLUS+:8];
  endfunction

  function automatic logic [7:0] drive_fault(input logic [WIDTH-1:0] roles);
    drive_fault = roles[DRIVE_FAULT+:8];
  endfunction

endpackage
`default_nettype wire
