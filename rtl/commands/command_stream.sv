// The stream of commands: the checker, the two queues that it fills, and their watermarks.
`default_nettype none
module command_stream #(
    parameter int          Axes          = 4,     // 1 to 8
    parameter logic [31:0] Engines       = '1,    // built-in engines: bits card_map_pkg::ENGINE_*
    parameter int          GeometryDepth = 4096,  // halfwords, 2 to 32,768
    parameter int          FeedDepth     = 2560
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    // registers
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic write_i,  // a word of the stream is on the setting bus, where it stays until it is answered
    input wire logic flush_i,
    input wire logic closed_i,  // no command is accepted
    output logic [stream_answer_pkg::WIDTH-1:0] answer_o,
    output logic [queue_state_pkg::WIDTH-1:0] queue_state_o,
    // queues
    output logic [arrival_pkg::WIDTH-1:0] arrival_o,
    output logic geometry_empty_o,
    output logic [15:0] geometry_word_o,
    input wire logic geometry_read_i,
    output logic feed_empty_o,
    output logic [15:0] feed_word_o,
    input wire logic feed_read_i
);
  logic [15:0] geometry_room;
  logic [15:0] feed_room;

  assign queue_state_o[queue_state_pkg::GEOMETRY_ROOM+:16] = geometry_room;
  assign queue_state_o[queue_state_pkg::FEED_ROOM+:16] = feed_room;

  command_checker #(
      .Axes(Axes),
      .Engines(Engines)
  ) stream (
      .clk_i,
      .rst_i,
      .write_i,
      .word_i(setting_bus_pkg::data(setting_i)),
      .flush_i,
      .clear_i(cut_i),
      .closed_i,
      .geometry_room_i(geometry_room),
      .feed_room_i(feed_room),
      .arrival_o,
      .answer_o
  );

  halfword_queue #(
      .Depth(GeometryDepth)
  ) geometry_queue (
      .clk_i,
      .rst_i,
      .clear_i(cut_i),
      .drop_i(arrival_o[arrival_pkg::DROP]),
      .commit_i(arrival_o[arrival_pkg::GEOMETRY_COMMIT]),
      .write_i(arrival_o[arrival_pkg::GEOMETRY_WRITE]),
      .halfword_i(arrival_pkg::halfword(arrival_o)),
      .read_i(geometry_read_i),
      .word_o(geometry_word_o),
      .empty_o(geometry_empty_o),
      .room_o(geometry_room)
  );

  halfword_queue #(
      .Depth(FeedDepth)
  ) feed_queue (
      .clk_i,
      .rst_i,
      .clear_i(cut_i),
      .drop_i(arrival_o[arrival_pkg::DROP]),
      .commit_i(arrival_o[arrival_pkg::FEED_COMMIT]),
      .write_i(arrival_o[arrival_pkg::FEED_WRITE]),
      .halfword_i(arrival_pkg::halfword(arrival_o)),
      .read_i(feed_read_i),
      .word_o(feed_word_o),
      .empty_o(feed_empty_o),
      .room_o(feed_room)
  );

  if (Engines[card_map_pkg::ENGINE_WATERMARKS]) begin : gen_watermarks
    queue_watermarks #(
        .GeometryDepth(GeometryDepth),
        .FeedDepth(FeedDepth)
    ) watermarks (
        .clk_i,
        .rst_i,
        .setting_i,
        .geometry_room_i(geometry_room),
        .feed_room_i(feed_room),
        .geometry_low_o(queue_state_o[queue_state_pkg::GEOMETRY_LOW]),
        .feed_low_o(queue_state_o[queue_state_pkg::FEED_LOW])
    );
  end else begin : gen_no_watermarks
    assign queue_state_o[queue_state_pkg::GEOMETRY_LOW] = 1'b0;
    assign queue_state_o[queue_state_pkg::FEED_LOW] = 1'b0;
  end
endmodule
`default_nettype wire
