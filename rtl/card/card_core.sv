// The card behind its inner register port: registers, command checker, queues and all that moves.
// Ports and latencies: docs/developer/architecture.md.
`default_nettype none
module card_core #(
    parameter int          Axes              = 4,     // 1 to 8
    parameter int          GeometryDepth     = 4096,  // halfwords, 2 to 32,768
    parameter int          FeedDepth         = 2560,
    parameter int          Accumulator       = 1,     // 0: without arcs and conics
    parameter int          EightDirections   = 0,     // 1: the accumulator's second step rule
    parameter int          ArcGenerator      = 0,     // 1: arcs in chords
    parameter int          DirectMode        = 1,     // 0: without
    parameter int          UnderrunHold      = 1,     // 0: without
    parameter int          Classes           = 1,     // 0: one ratio for all pieces
    parameter int          Watermarks        = 1,     // 0: without
    parameter int          PathCommands      = 0,     // 1: OUTPUT, MARK, WAIT_INPUT, PROBE; inputs and outputs
    parameter int          PositionStreaming = 0,     // 1: for a host that sends a line each period
    parameter int          Inputs            = 4,     // 1 to 16, of a card with path commands
    parameter int          Outputs           = 4,
    parameter int          Ports             = 1,     // 1 to 4: what is joined in front of the inner port
    parameter logic [31:0] BuildId           = 0,
    parameter int          BuildDirty        = 0,
    parameter logic [31:0] BoardId           = 0
) (
    input wire logic clk_i,
    input wire logic rst_i,
    // the inner port
    input wire logic request_i,
    input wire logic write_i,
    input wire logic partial_i,
    input wire logic [1:0] port_i,
    input wire logic [11:0] address_i,
    input wire logic [31:0] data_i,
    output logic ack_o,
    output logic error_o,
    output logic [31:0] data_o,
    // straps
    input wire logic [31:0] clock_hz_i,
    input wire logic [2*Axes-1:0] idle_level_i,  // {second pins, first pins}
    input wire logic [Outputs-1:0] output_idle_i,  // levels in reset
    // pins
    input wire logic [Inputs-1:0] input_i,
    output logic [Outputs-1:0] output_o,
    output logic [Axes-1:0] step_o,
    output logic [Axes-1:0] dir_o,
    output logic irq_o,
    // for lockstep; a board leaves it open
    output logic [34*Axes+212:0] observe_o
);
  // A parameter out of its range stops every reader here: there is no module of this name, and the name says why.
  if (Axes < 1 || Axes > 8) begin : gen_wrong_axes
    ERROR_Axes_must_be_1_to_8 error ();
  end
  if (GeometryDepth < 2 || GeometryDepth > 32768 || FeedDepth < 2 || FeedDepth > 32768) begin : gen_wrong_depth
    ERROR_GeometryDepth_and_FeedDepth_must_be_2_to_32768 error ();
  end
  if (Ports < 1 || Ports > 4) begin : gen_wrong_ports
    ERROR_Ports_must_be_1_to_4 error ();
  end

  if (Inputs < 1 || Inputs > 16 || Outputs < 1 || Outputs > 16) begin : gen_wrong_pins
    ERROR_Inputs_and_Outputs_must_be_1_to_16 error ();
  end
  if (EightDirections != 0 && Accumulator == 0) begin : gen_wrong_accumulator
    ERROR_EightDirections_needs_Accumulator error ();
  end

  localparam logic [31:0] ENGINES = 32'd1 << card_map_pkg::ENGINE_LINES |
      32'(Accumulator != 0) << card_map_pkg::ENGINE_ACCUMULATOR |
      32'(EightDirections != 0) << card_map_pkg::ENGINE_ACCUMULATOR_8 |
      32'(ArcGenerator != 0) << card_map_pkg::ENGINE_ARC_GENERATOR | 32'd1 << card_map_pkg::ENGINE_JERK |
      32'(DirectMode != 0) << card_map_pkg::ENGINE_DIRECT_MODE |
      32'(UnderrunHold != 0) << card_map_pkg::ENGINE_UNDERRUN_HOLD | 32'(Classes != 0) << card_map_pkg::ENGINE_CLASSES |
      32'(Watermarks != 0) << card_map_pkg::ENGINE_WATERMARKS |
      32'(PathCommands != 0) << card_map_pkg::ENGINE_PATH_COMMANDS |
      32'(PositionStreaming != 0) << card_map_pkg::ENGINE_STREAMING;

  // PORTS: {outputs, inputs, ports}.
  localparam logic [31:0] PORTS = 32'(Ports) | (PathCommands != 0 ? 32'(Inputs) << 8 | 32'(Outputs) << 16 : 32'd0);

  // What parameters and straps decide of the constants, by address.
  logic [511:0] constants;

  assign constants = 512'(Axes) << 8 * card_map_pkg::ADDR_AXES |
      512'(clock_hz_i) << 8 * card_map_pkg::ADDR_CLOCK_HZ |
      512'(ENGINES) << 8 * card_map_pkg::ADDR_ENGINES |
      512'(GeometryDepth) << 8 * card_map_pkg::ADDR_GEOMETRY_DEPTH |
      512'(FeedDepth) << 8 * card_map_pkg::ADDR_FEED_DEPTH |
      512'(BuildId) << 8 * card_map_pkg::ADDR_BUILD_ID |
      512'(BuildDirty != 0) << 8 * card_map_pkg::ADDR_BUILD_FLAGS |
      512'(BoardId) << 8 * card_map_pkg::ADDR_BOARD_ID |
      512'(PORTS) << 8 * card_map_pkg::ADDR_PORTS;

  logic [31:0] clear_fault;
  logic [31:0] fault;
  logic [31:0] status;
  logic [ 5:0] motion_status;
  logic        held;
  logic [65:0] late;  // {a line goes on beyond its period, ticks; held for under-run, how often}
  logic [63:0] begun;  // {geometry, feed}
  logic [31:0] room;  // {geometry, feed}
  logic [ 1:0] low;  // {feed, geometry}
  logic [40:0] setting;  // {set, address, data}
  logic        abort;
  logic        flush;
  logic        cut;
  logic        closed;
  logic        stop;
  logic        mark;
  logic        probe;
  logic        probe_clear;
  logic [66:0] io;  // {waiting, probe missed, probed, marks, outputs, inputs}
  logic [ 1:0] snapshot;  // {shift, strobe}
  logic [31:0] chain_far;
  logic [31:0] chain_near;
  logic        start;
  logic [ 9:0] start_answer;  // {done, error, reason}
  logic [ 7:0] loader_address;
  logic [31:0] loader_data;
  logic        stream_write;
  logic [18:0] answer;  // {partial, ready, refuse, number, reason}

  register_file #(
      .Axes(Axes),
      .Ports(Ports),
      .Engines(ENGINES)
  ) registers (
      .clk_i,
      .rst_i,
      .constants_i(constants),
      .idle_level_i,
      .request_i,
      .access_i({port_i, write_i, partial_i, address_i, data_i}),
      .ack_o,
      .error_o,
      .data_o,
      .irq_o,
      .motion_i(motion_status),
      .held_i(held),
      .late_i(late),
      .fault_i(fault),
      .room_i(room),
      .low_i(low),
      .begun_i(begun),
      .io_i(io),
      .status_o(status),
      .setting_o(setting),
      .clear_fault_o(clear_fault),
      .abort_o(abort),
      .probe_clear_o(probe_clear),
      .flush_o(flush),
      .stream_write_o(stream_write),
      .checker_i(answer),
      .start_o(start),
      .start_answer_i(start_answer),
      .loader_address_i(loader_address),
      .loader_data_o(loader_data),
      .stop_i(stop),
      .probe_i(probe),
      .mark_i(mark),
      .snapshot_o(snapshot),
      .chain_o(chain_far),
      .chain_i(chain_near)
  );

  logic [15:0] halfword;
  logic [ 1:0] geometry;  // {commit, write}
  logic        geometry_read;
  logic        geometry_empty;
  logic [15:0] geometry_word;
  logic [ 1:0] feed;  // {commit, write}
  logic        feed_read;
  logic        feed_empty;
  logic [15:0] feed_word;
  logic        drop;
  logic        full;  // no room for the largest command: 50 halfwords of geometry, 20 of feed

  assign full = room[31:22] == 10'd0 || room[15:5] == 11'd0;

  command_checker #(
      .Axes(Axes),
      .Engines(ENGINES)
  ) stream (
      .clk_i,
      .rst_i,
      .write_i(stream_write),
      .word_i(setting[31:0]),  // the word last written, whatever it was for
      .flush_i(flush),
      .clear_i(cut),
      .closed_i(closed),
      .room_i(room),
      .halfword_o(halfword),
      .geometry_o(geometry),
      .feed_o(feed),
      .drop_o(drop),
      .answer_o(answer)
  );

  halfword_queue #(
      .Depth(GeometryDepth)
  ) geometry_queue (
      .clk_i,
      .rst_i,
      .clear_i(cut),
      .store_i({drop, geometry, halfword}),
      .read_i (geometry_read),
      .word_o (geometry_word),
      .empty_o(geometry_empty),
      .room_o (room[31:16])
  );

  halfword_queue #(
      .Depth(FeedDepth)
  ) feed_queue (
      .clk_i,
      .rst_i,
      .clear_i(cut),
      .store_i({drop, feed, halfword}),
      .read_i (feed_read),
      .word_o (feed_word),
      .empty_o(feed_empty),
      .room_o (room[15:0])
  );

  if (Watermarks != 0) begin : gen_watermarks
    queue_watermarks #(
        .GeometryDepth(GeometryDepth),
        .FeedDepth(FeedDepth)
    ) watermarks (
        .clk_i,
        .rst_i,
        .setting_i(setting),
        .room_i(room),
        .low_o(low)
    );
  end else begin : gen_no_watermarks
    assign low = '0;
  end

  motion_core #(
      .Axes(Axes),
      .Engines(ENGINES),
      .Inputs(Inputs),
      .Outputs(Outputs)
  ) motion (
      .clk_i,
      .rst_i,
      .idle_level_i,
      .setting_i(setting),
      .abort_i(abort),
      .clear_fault_i(clear_fault),
      .input_i,
      .output_idle_i,
      .output_o,
      .mark_o(mark),
      .probe_o(probe),
      .probe_clear_i(probe_clear),
      .io_o(io),
      .geometry_empty_i(geometry_empty),
      .geometry_word_i(geometry_word),
      .geometry_read_o(geometry_read),
      .feed_empty_i(feed_empty),
      .feed_word_i(feed_word),
      .feed_read_o(feed_read),
      .arrive_i({full, drop, geometry, feed, halfword}),
      .start_i(start),
      .start_mask_i(setting[7:0]),
      .start_done_o(start_answer[9]),
      .start_error_o(start_answer[8]),
      .start_reason_o(start_answer[7:0]),
      .loader_address_o(loader_address),
      .loader_data_i(loader_data),
      .snapshot_i(snapshot),
      .chain_i(chain_far),
      .chain_o(chain_near),
      .fault_o(fault),
      .cut_o(cut),
      .closed_o(closed),
      .stop_o(stop),
      .status_o(motion_status),
      .held_o(held),
      .underrun_o(late[32:0]),
      .stale_o(late[65:33]),
      .geometry_begun_o(begun[63:32]),
      .feed_begun_o(begun[31:0]),
      .observe_o(observe_o[34*Axes+52:0]),
      .step_o,
      .dir_o
  );

  assign observe_o[34*Axes+212:34*Axes+53] = {room, status, fault, begun};
endmodule
`default_nettype wire
