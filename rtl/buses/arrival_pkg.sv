// Halfwords that the command checker stores in the two command queues. A barrier is stored in both queues.
`default_nettype none
package arrival_pkg;

  // Fields, lowest bit first; each ends where the next one begins.
  localparam int HALFWORD = 0;  // 16 bits: keeps its value between writes
  localparam int FEED_WRITE = 16;  // event: HALFWORD is stored in the feed queue, as part of the command under way
  localparam int FEED_COMMIT = 17;  // event: the command is complete
  localparam int GEOMETRY_WRITE = 18;
  localparam int GEOMETRY_COMMIT = 19;
  localparam int DROP = 20;  // event: the command under way is discarded
  localparam int FULL = 21;  // a queue may have too little room for the next command
  localparam int WIDTH = 22;

  function automatic logic [15:0] halfword(input logic [WIDTH-1:0] arrival);
    halfword = arrival[HALFWORD+:16];
  endfunction

  // Whether a halfword arrives for either queue.
  function automatic logic writes(input logic [WIDTH-1:0] arrival);
    writes = arrival[GEOMETRY_WRITE] || arrival[FEED_WRITE];
  endfunction

  // Whether the command under way ends, complete or discarded.
  function automatic logic ends(input logic [WIDTH-1:0] arrival);
    ends = arrival[DROP] || arrival[GEOMETRY_COMMIT] || arrival[FEED_COMMIT];
  endfunction

endpackage
`default_nettype wire
