// The card behind its inner register port: registers, command checker, queues, inputs and the motion core. Ports and
// latencies: docs/developer/architecture.md.
`default_nettype none
module card_core #(
    parameter int          Axes              = 4,     // 1 to 8
    parameter int          GeometryDepth     = 4096,  // halfwords, 2 to 32,768
    parameter int          FeedDepth         = 2560,
    parameter int          Accumulator       = 1,     // 0: without arcs and conics
    parameter int          EightDirections   = 0,     // 1: the accumulator's step rule for 8 directions
    parameter int          ArcGenerator      = 0,     // 1: arcs as chords
    parameter int          DirectMode        = 1,     // 0: without direct mode
    parameter int          UnderrunHold      = 1,     // 0: without under-run hold
    parameter int          Classes           = 1,     // 0: one ratio for all pieces
    parameter int          Watermarks        = 1,     // 0: without watermarks
    parameter int          PathCommands      = 0,     // 1: OUTPUT, MARK, WAIT_INPUT, PROBE; inputs and outputs
    parameter int          PositionStreaming = 0,     // 1: for a host that sends one line per period
    parameter int          MachineInputs     = 0,     // 1: filters and roles of inputs; limits, drive faults, feed hold
    parameter int          Captures          = 0,     // 0 to 4 units; with any, the probe's first touch is captured
    parameter int          CaptureFifo       = 0,     // 1: a queue of 16 captures
    parameter int          SoftLimits        = 0,     // 1: each axis's position is compared with its range
    parameter int          EmergencyStop     = 0,     // 1: a pin for the emergency stop
    parameter int          Enables           = 0,     // 1: outputs for drive enable, brake, charge pump, card healthy
    parameter int          Pwm               = 0,     // 1: PWM on two channels of outputs
    parameter int          Inputs            = 4,     // 1 to 32; used with path commands
    parameter int          Outputs           = 4,     // 1 to 16
    parameter int          Ports             = 1,     // 1 to 4: host ports in front of the inner port
    parameter logic [31:0] BuildId           = 0,
    parameter int          BuildDirty        = 0,
    parameter logic [31:0] BoardId           = 0
) (
    input wire logic clk_i,
    input wire logic rst_i,
    // inner register port
    input wire logic [register_access_pkg::WIDTH-1:0] access_i,
    output logic [register_answer_pkg::WIDTH-1:0] answer_o,
    // straps
    input wire logic [31:0] clock_hz_i,
    input wire logic [2*Axes-1:0] idle_level_i,  // level before and in reset: {second pins, first pins}
    input wire logic [Outputs-1:0] output_idle_i,  // levels in reset
    input wire logic emergency_stop_level_i,  // level of the pin that means stop
    // pins
    input wire logic [Inputs-1:0] input_i,
    input wire logic emergency_stop_i,
    output logic [Outputs-1:0] output_o,
    output logic [Axes-1:0] step_o,
    output logic [Axes-1:0] dir_o,
    output logic irq_o,
    // for lockstep; a board leaves it open
    output logic [observe_pkg::WIDTH+axis_observe_pkg::WIDTH*Axes-1:0] observe_o
);
  localparam logic [31:0] ENGINES = 32'd1 << card_map_pkg::ENGINE_LINES |
      32'(Accumulator != 0) << card_map_pkg::ENGINE_ACCUMULATOR |
      32'(EightDirections != 0) << card_map_pkg::ENGINE_ACCUMULATOR_8 |
      32'(ArcGenerator != 0) << card_map_pkg::ENGINE_ARC_GENERATOR | 32'd1 << card_map_pkg::ENGINE_JERK |
      32'(DirectMode != 0) << card_map_pkg::ENGINE_DIRECT_MODE |
      32'(UnderrunHold != 0) << card_map_pkg::ENGINE_UNDERRUN_HOLD | 32'(Classes != 0) << card_map_pkg::ENGINE_CLASSES |
      32'(Watermarks != 0) << card_map_pkg::ENGINE_WATERMARKS |
      32'(PathCommands != 0) << card_map_pkg::ENGINE_PATH_COMMANDS |
      32'(PositionStreaming != 0) << card_map_pkg::ENGINE_STREAMING |
      32'(MachineInputs != 0) << card_map_pkg::ENGINE_MACHINE_INPUTS |
      32'(Captures != 0) << card_map_pkg::ENGINE_CAPTURES |
      32'(CaptureFifo != 0) << card_map_pkg::ENGINE_CAPTURE_FIFO |
      32'(EmergencyStop != 0) << card_map_pkg::ENGINE_EMERGENCY_STOP |
      32'(Enables != 0) << card_map_pkg::ENGINE_ENABLES |
      32'(SoftLimits != 0) << card_map_pkg::ENGINE_SOFT_LIMITS | 32'(Pwm != 0) << card_map_pkg::ENGINE_PWM;
  localparam int FLAGS = Accumulator | EightDirections | ArcGenerator | DirectMode | UnderrunHold | Classes |
      Watermarks | PathCommands | PositionStreaming | MachineInputs | CaptureFifo | EmergencyStop | Enables |
      SoftLimits | Pwm | BuildDirty;

  card_parameters #(
      .Axes(Axes),
      .Engines(ENGINES),
      .Flags(FLAGS),
      .GeometryDepth(GeometryDepth),
      .FeedDepth(FeedDepth),
      .Captures(Captures),
      .Inputs(Inputs),
      .Outputs(Outputs),
      .Ports(Ports)
  ) checked ();

  // between registers and command stream
  logic [setting_bus_pkg::WIDTH-1:0] setting;
  logic stream_write;
  logic flush;
  logic [stream_answer_pkg::WIDTH-1:0] stream_answer;
  logic [queue_state_pkg::WIDTH-1:0] queue_state;
  // between registers and motion core
  logic [31:0] clear_fault;
  logic session_gone;
  logic link_lost;
  logic abort;
  logic probe_clear;
  logic [start_pkg::WIDTH-1:0] start;
  logic [start_answer_pkg::WIDTH-1:0] start_answer;
  logic stop;
  logic rest;
  logic mark;
  logic probe;
  logic [snapshot_pkg::WIDTH-1:0] snapshot_far;
  logic [snapshot_pkg::WIDTH-1:0] snapshot_near;
  logic busy;
  logic [time_state_pkg::WIDTH-1:0] time_state;
  logic [geometry_state_pkg::WIDTH-1:0] geometry_state;
  logic [pins_state_pkg::WIDTH-1:0] pins_state;
  // inputs
  logic [input_levels_pkg::WIDTH-1:0] inputs;
  logic [input_roles_pkg::WIDTH-1:0] roles;
  logic [capture_pkg::WIDTH-1:0] capture;
  logic [capture_answer_pkg::WIDTH-1:0] capture_answer;
  logic filling;
  logic emergency;
  logic emergency_latched;
  // between command stream and motion core
  logic cut;
  logic closed;
  logic [arrival_pkg::WIDTH-1:0] arrival;
  logic geometry_empty;
  logic [15:0] geometry_word;
  logic geometry_read;
  logic feed_empty;
  logic [15:0] feed_word;
  logic feed_read;

  register_file #(
      .Axes(Axes),
      .Ports(Ports),
      .Engines(ENGINES),
      .GeometryDepth(GeometryDepth),
      .FeedDepth(FeedDepth),
      .Inputs(Inputs),
      .Outputs(Outputs),
      .Captures(Captures),
      .BuildId(BuildId),
      .BuildDirty(BuildDirty),
      .BoardId(BoardId)
  ) registers (
      .clk_i,
      .rst_i,
      .clock_hz_i,
      .idle_level_i,
      .access_i,
      .answer_o,
      .irq_o,
      .busy_i(busy),
      .time_state_i(time_state),
      .geometry_state_i(geometry_state),
      .pins_state_i(pins_state),
      .queue_state_i(queue_state),
      .inputs_i(inputs),
      .roles_i(roles),
      .status_o(observe_o[observe_pkg::STATUS+:32]),
      .setting_o(setting),
      .clear_fault_o(clear_fault),
      .session_gone_o(session_gone),
      .link_lost_o(link_lost),
      .abort_o(abort),
      .probe_clear_o(probe_clear),
      .flush_o(flush),
      .filling_o(filling),
      .stream_write_o(stream_write),
      .stream_answer_i(stream_answer),
      .start_o(start),
      .start_answer_i(start_answer),
      .stop_i(stop),
      .rest_i(rest),
      .probe_i(probe),
      .mark_i(mark),
      .capture_i(capture),
      .capture_answer_o(capture_answer),
      .snapshot_i(snapshot_near),
      .snapshot_o(snapshot_far)
  );

  command_stream #(
      .Axes(Axes),
      .Engines(ENGINES),
      .GeometryDepth(GeometryDepth),
      .FeedDepth(FeedDepth)
  ) commands (
      .clk_i,
      .rst_i,
      .cut_i(cut),
      .setting_i(setting),
      .write_i(stream_write),
      .flush_i(flush),
      .closed_i(closed),
      .answer_o(stream_answer),
      .queue_state_o(queue_state),
      .arrival_o(arrival),
      .geometry_empty_o(geometry_empty),
      .geometry_word_o(geometry_word),
      .geometry_read_i(geometry_read),
      .feed_empty_o(feed_empty),
      .feed_word_o(feed_word),
      .feed_read_i(feed_read)
  );

  inputs_part #(
      .Axes(Axes),
      .Engines(ENGINES),
      .Captures(Captures),
      .Inputs(Inputs)
  ) from_machine (
      .clk_i,
      .rst_i,
      .setting_i(setting),
      .pin_i(input_i),
      .inputs_o(inputs),
      .roles_o(roles),
      .capture_answer_i(capture_answer),
      .capture_o(capture),
      .emergency_stop_i,
      .emergency_stop_level_i,
      .clear_fault_i(clear_fault),
      .filling_i(filling),
      .latched_o(emergency_latched),
      .emergency_o(emergency)
  );

  motion_core #(
      .Axes(Axes),
      .Engines(ENGINES),
      .Outputs(Outputs)
  ) motion (
      .clk_i,
      .rst_i,
      .idle_level_i,
      .setting_i(setting),
      .geometry_empty_i(geometry_empty),
      .geometry_word_i(geometry_word),
      .geometry_read_o(geometry_read),
      .feed_empty_i(feed_empty),
      .feed_word_i(feed_word),
      .feed_read_o(feed_read),
      .arrival_i(arrival),
      .start_i(start),
      .start_answer_o(start_answer),
      .abort_i(abort),
      .clear_fault_i(clear_fault),
      .session_gone_i(session_gone),
      .link_lost_i(link_lost),
      .cut_o(cut),
      .closed_o(closed),
      .emergency_stop_i(emergency),
      .latched_i(emergency_latched),
      .inputs_i(inputs),
      .roles_i(roles),
      .output_idle_i,
      .output_o,
      .probe_clear_i(probe_clear),
      .stop_o(stop),
      .rest_o(rest),
      .mark_o(mark),
      .probe_o(probe),
      .snapshot_i(snapshot_far),
      .snapshot_o(snapshot_near),
      .busy_o(busy),
      .time_state_o(time_state),
      .geometry_state_o(geometry_state),
      .pins_state_o(pins_state),
      .path_tick_o(observe_o[observe_pkg::PATH_TICK]),
      .observe_o(observe_o[observe_pkg::WIDTH+:axis_observe_pkg::WIDTH*Axes]),
      .step_o,
      .dir_o
  );

  assign observe_o[observe_pkg::TICK] = time_state[time_state_pkg::TICK];
  assign observe_o[observe_pkg::FEED_SWAP] = time_state[time_state_pkg::FEED_SWAP];
  assign observe_o[observe_pkg::RATIO+:17] = time_state_pkg::ratio(time_state);
  assign observe_o[observe_pkg::RATE+:32] = time_state_pkg::rate(time_state);
  assign observe_o[observe_pkg::FEED_BEGUN+:32] = time_state_pkg::feed_begun(time_state);
  assign observe_o[observe_pkg::FAULT+:32] = time_state_pkg::fault(time_state);
  assign observe_o[observe_pkg::PATH_SWAP] = geometry_state[geometry_state_pkg::PATH_SWAP];
  assign observe_o[observe_pkg::GEOMETRY_BEGUN+:32] = geometry_state_pkg::geometry_begun(geometry_state);
  assign observe_o[observe_pkg::FEED_ROOM+:16] = queue_state_pkg::feed_room(queue_state);
  assign observe_o[observe_pkg::GEOMETRY_ROOM+:16] = queue_state_pkg::geometry_room(queue_state);
endmodule
`default_nettype wire
