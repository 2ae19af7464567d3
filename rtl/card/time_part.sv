// The time part: when a tick comes. The feed's pieces and the time base make ticks; stop_control holds the time base and
// cuts.
`default_nettype none

module time_part #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1  // what is built in: bits card_map_pkg::ENGINE_*
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    // the feed's queue, and what arrives in both
    input wire logic empty_i,
    input wire logic [15:0] word_i,
    output logic read_o,
    input wire logic [arrival_pkg::WIDTH-1:0] arrival_i,
    // the other parts
    input wire logic [path_pkg::WIDTH-1:0] path_i,
    input wire logic ready_i,  // the path's engine takes ticks
    input wire logic finished_i,  // and has finished all that were given
    output logic [feed_pkg::WIDTH-1:0] feed_o,
    output logic take_o,  // the tick is taken in this clock (combinational)
    output logic tick_o,
    // stops
    input wire logic [Axes-1:0] step_fault_i,  // events
    input wire logic [input_roles_pkg::WIDTH-1:0] roles_i,
    input wire logic [Axes-1:0] step_i,  // steps on the path
    input wire logic [Axes-1:0] dir_i,  // of each axis's last one: 1 backwards, 0 forwards
    input wire logic path_active_i,
    input wire logic direct_active_i,
    input wire logic abort_i,  // event
    input wire logic [31:0] clear_fault_i,  // ones written to FAULT
    output logic cut_o,  // event
    output logic stop_o,  // event: a snapshot is wanted
    output logic closed_o,  // no command and no START is taken
    // status
    input wire logic card_idle_i,  // nothing runs, is decoded or queued; up to four clocks late
    output logic idle_o,  // the feed is (combinational)
    output logic [time_state_pkg::WIDTH-1:0] time_state_o,
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o
);
  logic [16:0] ratio;
  logic at_rest;
  logic hold;
  logic underrun_hold;
  logic active;
  logic moving;
  logic fixed;
  logic stopping;
  logic expired;
  logic button;
  logic [stop_causes_pkg::WIDTH-1:0] causes;

  assign at_rest = ratio == 17'd0;
  assign feed_o[feed_pkg::AT_REST] = at_rest;
  assign feed_o[feed_pkg::STOPPING] = stopping;
  assign time_state_o[time_state_pkg::RATIO+:17] = ratio;
  assign time_state_o[time_state_pkg::TICK] = tick_o;
  assign time_state_o[time_state_pkg::HELD] = at_rest;
  assign time_state_o[time_state_pkg::FEED_ACTIVE] = active;
  assign time_state_o[time_state_pkg::STOPPING] = stopping;

  watchdog over_host (
      .clk_i,
      .rst_i,
      .setting_i,
      .expired_o(expired)
  );

  assign time_state_o[time_state_pkg::BUTTON_HOLD] = button;

  if (Engines[card_map_pkg::ENGINE_MACHINE_INPUTS]) begin : gen_machine_inputs
    limit_check #(
        .Axes(Axes)
    ) limits (
        .clk_i,
        .rst_i,
        .setting_i,
        .roles_i,
        .step_i,
        .dir_i,
        .runs_i(path_active_i || direct_active_i),
        .probing_i(path_i[path_pkg::PROBING]),
        .stopping_i(stopping),
        .clear_i(clear_fault_i),
        .causes_o(causes),
        .state_o(time_state_o[time_state_pkg::LIMIT_STATE+:24])
    );

    button_hold buttons (
        .clk_i,
        .rst_i,
        .roles_i,
        .hold_o(button)
    );
  end else begin : gen_no_machine_inputs
    assign causes = '0;
    assign button = 1'b0;
    assign time_state_o[time_state_pkg::LIMIT_STATE+:24] = '0;

    logic unused;
    assign unused = &{1'b0, roles_i, step_i, dir_i, path_active_i, direct_active_i};
  end

  stop_control #(
      .Axes   (Axes),
      .Engines(Engines)
  ) stops (
      .clk_i,
      .rst_i,
      .setting_i,
      .step_fault_i,
      .mismatch_i(path_i[path_pkg::MISMATCH]),
      .incomplete_i(path_i[path_pkg::INCOMPLETE]),
      .missing_i(path_i[path_pkg::MISSING]),
      .expired_i(expired),
      .causes_i(causes),
      .abort_i,
      .clear_i(clear_fault_i),
      .at_rest_i(at_rest),
      .moving_i(moving),
      .fixed_i(fixed),
      .underrun_i(underrun_hold),
      .probe_i(path_i[path_pkg::HOLD]),
      .button_i(button),
      .fault_o(time_state_o[time_state_pkg::FAULT+:32]),
      .hold_o(hold),
      .cut_o,
      .stop_o,
      .stopping_o(stopping),
      .closed_o
  );

  tick_source #(
      .Engines(Engines)
  ) ticks (
      .clk_i,
      .rst_i,
      .cut_i(cut_o),
      .hold_i(hold),
      .setting_i,
      .empty_i,
      .word_i,
      .read_o,
      .arrival_i,
      .path_i,
      .ready_i,
      .finished_i,
      .take_o,
      .tick_o,
      .swap_o(time_state_o[time_state_pkg::FEED_SWAP]),
      .card_idle_i,
      .at_barrier_o(feed_o[feed_pkg::AT_BARRIER]),
      .runs_o(feed_o[feed_pkg::RUNS]),
      .underrun_hold_o(underrun_hold),
      .underrun_o(time_state_o[time_state_pkg::UNDERRUN]),
      .underruns_o(time_state_o[time_state_pkg::UNDERRUNS+:32]),
      .active_o(active),
      .moving_o(moving),
      .fixed_o(fixed),
      .silent_o(feed_o[feed_pkg::SILENT]),
      .idle_o,
      .ratio_o(ratio),
      .rate_o(time_state_o[time_state_pkg::RATE+:32]),
      .begun_o(time_state_o[time_state_pkg::FEED_BEGUN+:32]),
      .snapshot_i,
      .snapshot_o
  );
endmodule

`default_nettype wire
