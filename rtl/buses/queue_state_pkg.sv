// State of both command queues, for the registers.
`default_nettype none
package queue_state_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int FEED_ROOM = 0;  // 16 bits: free halfwords
  localparam int GEOMETRY_ROOM = 16;  // 16 bits: free halfwords
  localparam int FEED_LOW = 32;  // the feed queue is below its watermark
  localparam int GEOMETRY_LOW = 33;
  localparam int WIDTH = 34;

  function automatic logic [15:0] feed_room(input logic [WIDTH-1:0] state);
    feed_room = state[FEED_ROOM+:16];
  endfunction

  function automatic logic [15:0] geometry_room(input logic [WIDTH-1:0] state);
    geometry_room = state[GEOMETRY_ROOM+:16];
  endfunction

  function automatic logic [WIDTH-1:0] pack(input logic is_geometry_low, input logic is_feed_low,
                                            input logic [15:0] in_geometry, input logic [15:0] in_feed);
    pack = {is_geometry_low, is_feed_low, in_geometry, in_feed};
  endfunction

endpackage
`default_nettype wire
