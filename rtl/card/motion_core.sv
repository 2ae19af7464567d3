// The motion of the card, in three parts: the time part decides when a tick comes, the geometry part decides which
// steps it makes, and the motion part makes the pulses at the pins.
`default_nettype none

module motion_core #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1,  // built-in engines: bits card_map_pkg::ENGINE_*
    parameter int          Outputs = 4
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [2*Axes-1:0] idle_level_i,  // level before and in reset: {second pins, first pins}
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    // queues
    input wire logic geometry_empty_i,
    input wire logic [15:0] geometry_word_i,
    output logic geometry_read_o,
    input wire logic feed_empty_i,
    input wire logic [15:0] feed_word_i,
    output logic feed_read_o,
    input wire logic [arrival_pkg::WIDTH-1:0] arrival_i,
    // START
    input wire logic [start_pkg::WIDTH-1:0] start_i,
    output logic [start_answer_pkg::WIDTH-1:0] start_answer_o,
    // stops
    input wire logic abort_i,  // event
    input wire logic [31:0] clear_fault_i,  // ones written to FAULT
    input wire logic session_gone_i,  // the session that wrote the stream has been replaced by another
    input wire logic link_lost_i,
    output logic cut_o,  // event
    output logic closed_o,  // no command and no START is accepted
    // inputs
    input wire logic emergency_stop_i,  // level: emergency stop, with the engine emergency_stop
    input wire logic latched_i,  // latch of the emergency stop (asynchronous)
    input wire logic [input_levels_pkg::WIDTH-1:0] inputs_i,
    input wire logic [input_roles_pkg::WIDTH-1:0] roles_i,  // with the engine machine_inputs
    // pins of path commands
    input wire logic [Outputs-1:0] output_idle_i,  // levels in reset
    output logic [Outputs-1:0] output_o,
    input wire logic probe_clear_i,  // event
    // snapshots: FAULT and STATUS come in, POSITION of the last axis leaves first
    output logic stop_o,  // events: each requests a snapshot
    output logic rest_o,  // combinational
    output logic mark_o,
    output logic probe_o,  // combinational
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o,
    // status
    output logic busy_o,
    output logic [time_state_pkg::WIDTH-1:0] time_state_o,
    output logic [geometry_state_pkg::WIDTH-1:0] geometry_state_o,
    output logic [pins_state_pkg::WIDTH-1:0] pins_state_o,
    // for lockstep
    output logic path_tick_o,
    output logic [axis_observe_pkg::WIDTH*Axes-1:0] observe_o,
    output logic [Axes-1:0] step_o,
    output logic [Axes-1:0] dir_o
);
  logic [feed_pkg::WIDTH-1:0] feed;
  logic [path_pkg::WIDTH-1:0] path;
  logic [load_bus_pkg::WIDTH-1:0] load;
  logic [move_pkg::WIDTH-1:0] move;
  logic [engines_pkg::WIDTH-1:0] engines;
  logic [snapshot_pkg::WIDTH-1:0] behind_time;
  logic [snapshot_pkg::WIDTH-1:0] behind_geometry;
  logic [Axes-1:0] step_fault;
  logic take;
  logic tick;
  logic feed_idle;
  logic geometry_idle;
  logic idle_q;
  logic running_q;

  always_ff @(posedge clk_i) begin
    idle_q    <= (geometry_idle && feed_idle) || rst_i;
    running_q <= (!idle_q || move[move_pkg::DIRECT] || engines[engines_pkg::BUSY]) && !rst_i;
  end

  busy_timer status_busy (
      .clk_i,
      .rst_i,
      .running_i(running_q),
      .busy_o
  );

  time_part #(
      .Axes   (Axes),
      .Engines(Engines)
  ) in_time (
      .clk_i,
      .rst_i,
      .setting_i,
      .empty_i(feed_empty_i),
      .word_i(feed_word_i),
      .read_o(feed_read_o),
      .arrival_i,
      .path_i(path),
      .ready_i(engines[engines_pkg::READY]),
      .finished_i(engines[engines_pkg::DONE]),
      .quiet_i(engines[engines_pkg::QUIET]),
      .pulses_i(engines[engines_pkg::BUSY]),
      .swap_i(move[move_pkg::SWAP]),
      .busy_i(busy_o),
      .feed_o(feed),
      .take_o(take),
      .tick_o(tick),
      .step_fault_i(step_fault),
      .emergency_stop_i,
      .latched_i,
      .roles_i,
      .axes_i(observe_o),
      .path_active_i(geometry_state_o[geometry_state_pkg::PATH_ACTIVE]),
      .direct_active_i(geometry_state_o[geometry_state_pkg::DIRECT]),
      .abort_i,
      .clear_fault_i,
      .session_gone_i,
      .link_lost_i,
      .cut_o,
      .stop_o,
      .rest_o,
      .closed_o,
      .card_idle_i(idle_q),
      .idle_o(feed_idle),
      .time_state_o,
      .snapshot_i,
      .snapshot_o(behind_time)
  );

  geometry_part #(
      .Axes   (Axes),
      .Engines(Engines),
      .Outputs(Outputs)
  ) geometry (
      .clk_i,
      .rst_i,
      .cut_i(cut_o),
      .setting_i,
      .empty_i(geometry_empty_i),
      .word_i(geometry_word_i),
      .read_o(geometry_read_o),
      .arrival_i,
      .feed_i(feed),
      .take_i(take),
      .engines_i(engines),
      .path_o(path),
      .load_o(load),
      .move_o(move),
      .start_i,
      .start_answer_o,
      .closed_i(closed_o),
      .busy_i(busy_o),
      .rest_i(idle_q && !busy_o),
      .inputs_i,
      .output_idle_i,
      .output_o,
      .mark_o,
      .probe_o,
      .probe_clear_i,
      .pins_state_o,
      .idle_o(geometry_idle),
      .geometry_state_o,
      .snapshot_i(behind_time),
      .snapshot_o(behind_geometry)
  );

  motion_part #(
      .Axes   (Axes),
      .Engines(Engines)
  ) motion (
      .clk_i,
      .rst_i,
      .cut_i(cut_o),
      .idle_level_i,
      .setting_i,
      .load_i(load),
      .move_i(move),
      .halt_i(path[path_pkg::HALT]),
      .tick_i(tick),
      .silent_i(feed[feed_pkg::SILENT]),
      .engines_o(engines),
      .step_o,
      .dir_o,
      .fault_o(step_fault),
      .snapshot_i(behind_geometry),
      .snapshot_o,
      .path_tick_o,
      .observe_o
  );
endmodule

`default_nettype wire
