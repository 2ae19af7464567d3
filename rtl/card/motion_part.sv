// The motion part: turns ticks into pulses at the pins, by the path engines and the axes that they move.
`default_nettype none

module motion_part #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1  // built-in engines: bits card_map_pkg::ENGINE_*
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic [2*Axes-1:0] idle_level_i,  // level before and in reset: {second pins, first pins}
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    // the path
    input wire logic [load_bus_pkg::WIDTH-1:0] load_i,
    input wire logic [move_pkg::WIDTH-1:0] move_i,
    input wire logic halt_i,  // event: the path under way ends here
    input wire logic tick_i,
    input wire logic silent_i,  // ticks make no steps
    output logic [engines_pkg::WIDTH-1:0] engines_o,
    // pins and status
    output logic [Axes-1:0] step_o,
    output logic [Axes-1:0] dir_o,
    output logic [Axes-1:0] fault_o,  // events
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o,
    // for lockstep
    output logic path_tick_o,
    output logic [axis_observe_pkg::WIDTH*Axes-1:0] observe_o
);
  logic [axis_drive_pkg::WIDTH-1:0] drive;
  logic ends;

  assign ends = cut_i || halt_i;

  path_engines #(
      .Axes   (Axes),
      .Engines(Engines)
  ) engines (
      .clk_i,
      .rst_i,
      .cut_i(ends),
      .tick_i,
      .move_i,
      .load_i,
      .drive_o(drive),
      .path_tick_o,
      .ready_o(engines_o[engines_pkg::READY]),
      .payload_ready_o(engines_o[engines_pkg::PAYLOAD_READY]),
      .quiet_o(engines_o[engines_pkg::QUIET]),
      .shadows_free_o(engines_o[engines_pkg::SHADOWS_FREE]),
      .done_o(engines_o[engines_pkg::DONE]),
      .missed_end_o(engines_o[engines_pkg::MISSED_END])
  );

  axes #(
      .Axes   (Axes),
      .Counted(Engines[card_map_pkg::ENGINE_DIRECT_MODE])
  ) all_axes (
      .clk_i,
      .rst_i,
      .cut_i  (ends),
      .idle_level_i,
      .setting_i,
      .load_i,
      .move_i,
      .drive_i(drive),
      .silent_i,
      .snapshot_i,
      .snapshot_o,
      .live_o (engines_o[engines_pkg::LIVE]),
      .busy_o (engines_o[engines_pkg::BUSY]),
      .fault_o,
      .observe_o,
      .step_o,
      .dir_o
  );
endmodule

`default_nettype wire
