// The card's registers: takes an access, judges it by the register map, acts and answers.
// Latencies: docs/developer/architecture.md.
`default_nettype none
module register_file #(
    parameter int          Axes          = 4,     // 1 to 8
    parameter int          Ports         = 1,     // 1 to 4
    parameter logic [31:0] Engines       = '1,    // built-in engines: bits card_map_pkg::ENGINE_*
    parameter int          GeometryDepth = 4096,  // halfwords, of the queues
    parameter int          FeedDepth     = 2560,
    parameter int          Inputs        = 4,     // 1 to 32; used with path commands
    parameter int          Outputs       = 4,
    parameter int          Captures      = 0,     // capture units
    parameter logic [31:0] BuildId       = 0,
    parameter int          BuildDirty    = 0,
    parameter logic [31:0] BoardId       = 0
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [31:0] clock_hz_i,  // strap
    input wire logic [2*Axes-1:0] idle_level_i,  // level before and in reset: {second pins, first pins}
    // the access
    input wire logic [register_access_pkg::WIDTH-1:0] access_i,
    output logic [register_answer_pkg::WIDTH-1:0] answer_o,
    output logic irq_o,
    // the card's state
    input wire logic busy_i,
    input wire logic [time_state_pkg::WIDTH-1:0] time_state_i,
    input wire logic [geometry_state_pkg::WIDTH-1:0] geometry_state_i,
    input wire logic [pins_state_pkg::WIDTH-1:0] pins_state_i,
    input wire logic [queue_state_pkg::WIDTH-1:0] queue_state_i,
    input wire logic [input_levels_pkg::WIDTH-1:0] inputs_i,
    input wire logic [input_roles_pkg::WIDTH-1:0] roles_i,
    output logic [31:0] status_o,  // combinational; its bit REFUSED shows a refusal of any port
    // effects of writes
    output logic [setting_bus_pkg::WIDTH-1:0] setting_o,
    output logic [31:0] clear_fault_o,
    output logic session_gone_o,  // the session that wrote the stream has been replaced by another
    output logic link_lost_o,
    output logic abort_o,
    output logic probe_clear_o,
    output logic flush_o,  // combinational
    output logic filling_o,  // after a reset: no snapshot may be requested yet
    // the stream of commands
    output logic stream_write_o,
    input wire logic [stream_answer_pkg::WIDTH-1:0] stream_answer_i,
    // the direct loader
    output logic [start_pkg::WIDTH-1:0] start_o,
    input wire logic [start_answer_pkg::WIDTH-1:0] start_answer_i,
    // snapshots
    input wire logic stop_i,  // events: each requests a snapshot
    input wire logic rest_i,
    input wire logic probe_i,
    input wire logic mark_i,
    input wire logic [capture_pkg::WIDTH-1:0] capture_i,  // field ASK: levels, each requests a snapshot
    output logic [capture_answer_pkg::WIDTH-1:0] capture_answer_o,
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,  // near end of the chain
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o  // the chain after FAULT and STATUS
);

  localparam logic MORE_AXES = Axes > 4;
  localparam logic PATH_COMMANDS = Engines[card_map_pkg::ENGINE_PATH_COMMANDS];
  // {outputs, inputs, ports}
  localparam logic [31:0] PORTS = 32'(Ports) | (PATH_COMMANDS ? 32'(Inputs) << 8 | 32'(Outputs) << 16 : 32'd0);

  localparam logic [card_constants_pkg::WIDTH-1:0] CONSTANTS = card_constants_pkg::at(
      card_map_pkg::ADDR_AXES, 32'(Axes)
  ) | card_constants_pkg::at(
      card_map_pkg::ADDR_GEOMETRY_DEPTH, 32'(GeometryDepth)
  ) | card_constants_pkg::at(
      card_map_pkg::ADDR_FEED_DEPTH, 32'(FeedDepth)
  ) | card_constants_pkg::at(
      card_map_pkg::ADDR_BUILD_ID, BuildId
  ) | card_constants_pkg::at(
      card_map_pkg::ADDR_BUILD_FLAGS, 32'(BuildDirty != 0)
  ) | card_constants_pkg::at(
      card_map_pkg::ADDR_BOARD_ID, BoardId
  ) | card_constants_pkg::at(
      card_map_pkg::ADDR_PORTS, PORTS
  );

  logic ack;
  logic error;
  logic live;
  logic sample;
  logic read;
  logic [refusal_pkg::WIDTH-1:0] refusal;
  logic snapshot;
  logic strobe;
  logic of_rest;
  logic shift;
  logic snapshotting;
  logic [setting_bus_pkg::WIDTH-1:0] store;
  logic [9:0] clocks;
  logic unit;
  logic writing;
  logic start;
  logic [9:0] word;
  logic [31:0] live_data;
  logic [31:0] ram_data;
  logic [3:0] captured;
  logic [3:0] queued;
  logic queue_full;
  logic [31:0] capture_queue;
  logic [31:0] oldest_data;
  logic of_oldest;  // a word of the oldest capture is read
  logic [31:0] written;

  assign word = register_access_pkg::word(access_i);
  assign written = register_access_pkg::data(access_i);
  assign start_o = start_pkg::pack(start, written[7:0], ram_data);
  assign answer_o = register_answer_pkg::pack(
      ack, error, !read ? '0 : live ? live_data : of_oldest ? oldest_data : ram_data
  );

  register_access #(
      .Axes(Axes),
      .Engines(Engines)
  ) i_access (
      .clk_i,
      .rst_i,
      .access_i,
      .ack_o(ack),
      .error_o(error),
      .writing_i(writing || snapshotting),
      .direct_i(geometry_state_i[geometry_state_pkg::DIRECT]),
      .live_o(live),
      .sample_o(sample),
      .read_o(read),
      .setting_o,
      .clear_fault_o,
      .snapshot_o(snapshot),
      .abort_o,
      .probe_clear_o,
      .flush_o,
      .stream_write_o,
      .stream_answer_i,
      .start_o(start),
      .start_answer_i,
      .refusal_o(refusal)
  );

  register_live #(
      .Ports  (Ports),
      .Engines(Engines)
  ) i_live (
      .clk_i,
      .rst_i,
      .setting_i(setting_o),
      .access_i,
      .sample_i(sample),
      .refusal_i(refusal),
      .busy_i,
      .time_state_i,
      .geometry_state_i,
      .pins_state_i,
      .queue_state_i,
      .inputs_i,
      .roles_i,
      .capture_state_i(capture_pkg::state(capture_i)),
      .capture_queue_i(capture_queue),
      .snapshotting_i(snapshotting),
      .incomplete_i(stream_answer_i[stream_answer_pkg::PARTIAL]),
      .status_o,
      .data_o(live_data),
      .irq_o,
      .snapshot_i(snapshot_pkg::pack(of_rest, shift, strobe, 32'd0)),
      .snapshot_o
  );

  snapshot_writer #(
      .Axes(Axes)
  ) i_snapshot (
      .clk_i,
      .rst_i,
      .host_i(snapshot),
      .stop_i,
      .rest_i,
      .probe_i,
      .mark_i,
      .capture_i(capture_pkg::ask(capture_i)),
      .word_i(snapshot_pkg::word(snapshot_i)),
      .strobe_o(strobe),
      .rest_o(of_rest),
      .shift_o(shift),
      .active_o(snapshotting),
      .captured_o(captured),
      .clocks_o(clocks),
      .unit_o(unit),
      .store_o(store)
  );

  link_watch i_link (
      .clk_i,
      .rst_i,
      .setting_i(setting_o),
      .access_i,
      .answer_i (answer_o),
      .unit_i   (unit),
      .gone_o   (session_gone_o),
      .lost_o   (link_lost_o)
  );

  if (Engines[card_map_pkg::ENGINE_CAPTURE_FIFO]) begin : gen_capture_fifo
    logic of_oldest_q;

    // The access keeps its values from its request on.
    always_ff @(posedge clk_i) of_oldest_q <= word[9:4] == card_map_pkg::AREA_CAPTURE_HEAD[11:6];
    assign of_oldest = of_oldest_q;

    capture_fifo i_queue (
        .clk_i,
        .rst_i,
        .setting_i(setting_o),
        .store_i(store),
        .passed_i(capture_pkg::passed(capture_i)),
        .active_i(capture_pkg::edge_of(capture_i)),
        .queued_o(queued),
        .full_o(queue_full),
        .state_o(capture_queue),
        .word_i(word[3:0]),
        .data_o(oldest_data)
    );
  end else begin : gen_no_capture_fifo
    assign queued = '0;
    assign queue_full = 1'b0;
    assign capture_queue = '0;
    assign oldest_data = '0;
    assign of_oldest = 1'b0;
  end

  // The direct loader owns the RAM's read port from its start to its end. The write of START waits during this time.
  logic loading_q;

  always_ff @(posedge clk_i) begin
    loading_q <= (loading_q || start) && !start_answer_i[start_answer_pkg::DONE];
    if (rst_i) loading_q <= 1'b0;
  end

  logic [9:0] place;

  assign place = loading_q ? register_fold_pkg::place_of(
      start_answer_pkg::address(start_answer_i), MORE_AXES
  ) : register_fold_pkg::place_of(
      word, MORE_AXES
  );

  register_ram #(
      .Axes(Axes),
      .Engines(Engines),
      .Constants(CONSTANTS),
      .Descriptors(card_map_pkg::unit_descriptors(
          Engines, Axes, PATH_COMMANDS ? 4 : 2, Ports, Inputs, Outputs, Captures
      ))
  ) i_ram (
      .clk_i,
      .rst_i,
      .clock_hz_i,
      .idle_level_i,
      .setting_i(setting_o),
      .store_i(store),
      .clocks_i(clocks),
      .place_i(place),
      .filling_o,
      .writing_o(writing),
      .data_o(ram_data)
  );

  assign capture_answer_o = capture_answer_pkg::pack(queue_full, queued, captured);

  logic unused;  // strobe and shift return with the chain; without a queue fields of capture_i are unused
  assign unused = &{1'b0, snapshot_i, written[31:8], capture_i};

endmodule
`default_nettype wire
