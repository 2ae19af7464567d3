// The geometry part: which way a tick goes. Decodes the geometry's commands and direct moves, runs one path after the other,
// and carries out at their place on the path what is no motion.
`default_nettype none

module geometry_part #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1,  // what is built in, as the register ENGINES shows it
    parameter int          Inputs  = 4,
    parameter int          Outputs = 4
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    // the geometry's queue, and what arrives in both
    input wire logic empty_i,
    input wire logic [15:0] word_i,
    output logic read_o,
    input wire logic [arrival_pkg::WIDTH-1:0] arrival_i,
    // the other parts
    input wire logic [feed_pkg::WIDTH-1:0] feed_i,
    input wire logic [engines_pkg::WIDTH-1:0] engines_i,
    output logic [path_pkg::WIDTH-1:0] path_o,
    output logic [load_bus_pkg::WIDTH-1:0] load_o,
    output logic [move_pkg::WIDTH-1:0] move_o,
    // START
    input wire logic [start_pkg::WIDTH-1:0] start_i,
    output logic [start_answer_pkg::WIDTH-1:0] start_answer_o,
    input wire logic closed_i,  // a fault stands
    input wire logic busy_i,  // anything runs, is decoded or queued
    input wire logic rest_i,  // nothing does
    // pins, MARK and probe
    input wire logic [Inputs-1:0] input_i,
    input wire logic [Outputs-1:0] output_idle_i,  // levels in reset
    output logic [Outputs-1:0] output_o,
    output logic mark_o,  // event: a snapshot is wanted
    output logic probe_o,  // event: a snapshot is wanted (combinational)
    input wire logic probe_clear_i,  // event
    // status
    output logic idle_o,  // nothing is decoded or queued, no path runs, no probe is armed (combinational)
    output logic [geometry_state_pkg::WIDTH-1:0] geometry_state_o,
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o
);
  logic [load_bus_pkg::WIDTH-1:0] direct_load;
  logic direct_go;
  logic [Axes-1:0] direct_mask;
  logic take_output;
  logic take_mark;
  logic over;
  logic probe_waits;
  logic probe_ends;
  logic probe_taken;
  logic probe_stays;
  logic met;
  logic probing;
  logic sequencer_idle;

  assign idle_o = sequencer_idle && !probing;
  assign path_o[path_pkg::DIRECT] = move_o[move_pkg::DIRECT];
  assign geometry_state_o[geometry_state_pkg::DIRECT] = move_o[move_pkg::DIRECT];
  assign geometry_state_o[geometry_state_pkg::PATH_SWAP] = move_o[move_pkg::SWAP];

  geometry_sequencer #(
      .Axes   (Axes),
      .Engines(Engines)
  ) sequencer (
      .clk_i,
      .rst_i,
      .cut_i,
      .empty_i,
      .word_i,
      .read_o,
      .direct_load_i(direct_load),
      .direct_go_i(direct_go),
      .direct_mask_i(direct_mask),
      .feed_i,
      .engines_i,
      .load_o,
      .move_o,
      .taking_o(path_o[path_pkg::TAKING]),
      .setting_i,
      .arrival_i,
      .rest_i,
      .streaming_o(path_o[path_pkg::STREAMING]),
      .missing_o(path_o[path_pkg::MISSING]),
      .stale_o(geometry_state_o[geometry_state_pkg::STALE]),
      .stale_ticks_o(geometry_state_o[geometry_state_pkg::STALE_TICKS+:32]),
      .take_output_o(take_output),
      .take_mark_o(take_mark),
      .over_o(over),
      .probe_waits_o(probe_waits),
      .probe_ends_o(probe_ends),
      .waits_for_input_o(geometry_state_o[geometry_state_pkg::WAITING]),
      .met_i(met),
      .probe_taken_i(probe_taken),
      .probe_stays_i(probe_stays),
      .drop_i(path_o[path_pkg::DROP]),
      .halt_i(path_o[path_pkg::HALT]),
      .barrier_begins_o(path_o[path_pkg::BARRIER_BEGINS]),
      .barrier_counts_o(path_o[path_pkg::BARRIER_COUNTS]),
      .barrier_done_o(path_o[path_pkg::BARRIER_DONE]),
      .mismatch_o(path_o[path_pkg::MISMATCH]),
      .incomplete_o(path_o[path_pkg::INCOMPLETE]),
      .path_active_o(geometry_state_o[geometry_state_pkg::PATH_ACTIVE]),
      .ended_o(geometry_state_o[geometry_state_pkg::ENDED]),
      .idle_o(sequencer_idle),
      .snapshot_i,
      .snapshot_o,
      .begun_o(geometry_state_o[geometry_state_pkg::GEOMETRY_BEGUN+:32])
  );

  path_commands #(
      .Engines(Engines),
      .Inputs (Inputs),
      .Outputs(Outputs)
  ) commands (
      .clk_i,
      .rst_i,
      .cut_i,
      .setting_i,
      .input_i,
      .output_idle_i,
      .output_o,
      .load_i(load_o),
      .take_output_i(take_output),
      .take_mark_i(take_mark),
      .over_i(over),
      .runs_i(geometry_state_o[geometry_state_pkg::PATH_ACTIVE]),
      .mark_o,
      .at_rest_i(feed_i[feed_pkg::AT_REST]),
      .stopping_i(feed_i[feed_pkg::STOPPING]),
      .probe_clear_i,
      .probe_waits_i(probe_waits),
      .probe_ends_i(probe_ends),
      .met_o(met),
      .probe_taken_o(probe_taken),
      .probe_stays_o(probe_stays),
      .probe_o,
      .probe_hold_o(path_o[path_pkg::HOLD]),
      .drop_o(path_o[path_pkg::DROP]),
      .halt_o(path_o[path_pkg::HALT]),
      .probing_o(probing),
      .inputs_o(geometry_state_o[geometry_state_pkg::INPUTS+:16]),
      .outputs_o(geometry_state_o[geometry_state_pkg::OUTPUTS+:16]),
      .marks_o(geometry_state_o[geometry_state_pkg::MARKS+:32]),
      .probed_o(geometry_state_o[geometry_state_pkg::PROBED]),
      .probe_missed_o(geometry_state_o[geometry_state_pkg::PROBE_MISSED])
  );

  if (Engines[card_map_pkg::ENGINE_DIRECT_MODE]) begin : gen_direct_mode
    direct_loader #(
        .Axes(Axes)
    ) loader (
        .clk_i,
        .rst_i,
        .busy_i,
        .closed_i,
        .start_i,
        .answer_o(start_answer_o),
        .load_o(direct_load),
        .go_o(direct_go),
        .mask_o(direct_mask)
    );
  end else begin : gen_no_direct_mode
    assign {start_answer_o, direct_load, direct_go, direct_mask} = '0;

    logic unused;
    assign unused = &{1'b0, start_i, closed_i, busy_i};
  end
endmodule

`default_nettype wire
