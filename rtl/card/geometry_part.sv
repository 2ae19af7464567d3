// The geometry part: decides which steps each tick makes. It decodes geometry commands and direct moves, runs one path
// after the other, and carries out commands that are not motion at their place on the path.
`default_nettype none

module geometry_part #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1,  // built-in engines: bits card_map_pkg::ENGINE_*
    parameter int          Outputs = 4
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    // the geometry queue, and arrivals of both queues
    input wire logic empty_i,
    input wire logic [15:0] word_i,
    output logic read_o,
    input wire logic [arrival_pkg::WIDTH-1:0] arrival_i,
    // the other parts
    input wire logic [feed_pkg::WIDTH-1:0] feed_i,
    input wire logic take_i,  // a tick is taken in this clock (combinational)
    input wire logic [engines_pkg::WIDTH-1:0] engines_i,
    output logic [path_pkg::WIDTH-1:0] path_o,
    output logic [load_bus_pkg::WIDTH-1:0] load_o,
    output logic [move_pkg::WIDTH-1:0] move_o,
    // START
    input wire logic [start_pkg::WIDTH-1:0] start_i,
    output logic [start_answer_pkg::WIDTH-1:0] start_answer_o,
    input wire logic closed_i,  // no command and no START is accepted
    input wire logic busy_i,  // something runs, is decoded or queued
    input wire logic rest_i,  // nothing runs, is decoded or queued
    // pins, MARK and probe
    input wire logic [input_levels_pkg::WIDTH-1:0] inputs_i,
    input wire logic [Outputs-1:0] output_idle_i,  // levels in reset
    output logic [Outputs-1:0] output_o,
    output logic mark_o,  // event: requests a snapshot
    output logic probe_o,  // event: requests a snapshot (combinational)
    input wire logic probe_clear_i,  // event
    // status
    output logic [pins_state_pkg::WIDTH-1:0] pins_state_o,
    output logic idle_o,  // nothing is decoded or queued, no path runs, no probe is armed (combinational)
    output logic [geometry_state_pkg::WIDTH-1:0] geometry_state_o,
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o
);
  logic [load_bus_pkg::WIDTH-1:0] direct_load;
  logic direct_go;
  logic [Axes-1:0] direct_mask;
  logic [commands_pkg::WIDTH-1:0] commands;
  logic [probe_pkg::WIDTH-1:0] probe;
  logic drop;
  logic halt;
  logic sequencer_idle;

  assign idle_o = sequencer_idle && !probe[probe_pkg::BUSY];

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
      .take_i,
      .engines_i,
      .load_o,
      .move_o,
      .path_o,
      .setting_i,
      .arrival_i,
      .rest_i,
      .commands_o(commands),
      .probe_i(probe),
      .drop_i(drop),
      .halt_i(halt),
      .idle_o(sequencer_idle),
      .geometry_state_o,
      .snapshot_i,
      .snapshot_o
  );

  path_commands #(
      .Engines(Engines),
      .Outputs(Outputs)
  ) commands_of_path (
      .clk_i,
      .rst_i,
      .cut_i,
      .setting_i,
      .inputs_i,
      .output_idle_i,
      .output_o,
      .load_i(load_o),
      .commands_i(commands),
      .mark_o,
      .feed_i,
      .probe_clear_i,
      .probe_o(probe),
      .drop_o(drop),
      .halt_o(halt),
      .probe_snapshot_o(probe_o),
      .pins_state_o
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
