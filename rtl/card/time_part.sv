// The time part: decides when a tick comes. Feed pieces and the time base make the ticks; stop_control holds the time
// base and cuts.
`default_nettype none

module time_part #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1  // built-in engines: bits card_map_pkg::ENGINE_*
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    // the feed queue, and arrivals of both queues
    input wire logic empty_i,
    input wire logic [15:0] word_i,
    output logic read_o,
    input wire logic [arrival_pkg::WIDTH-1:0] arrival_i,
    // the other parts
    input wire logic [path_pkg::WIDTH-1:0] path_i,
    input wire logic ready_i,  // the path's engine accepts ticks
    input wire logic finished_i,  // the path's engine has finished all ticks given so far
    input wire logic quiet_i,  // no path tick waits or makes a step
    input wire logic pulses_i,  // an axis is busy
    input wire logic swap_i,  // a path begins
    input wire logic busy_i,  // something runs or is queued
    output logic [feed_pkg::WIDTH-1:0] feed_o,
    output logic take_o,  // a tick is taken in this clock (combinational)
    output logic tick_o,
    // stops
    input wire logic [Axes-1:0] step_fault_i,  // events
    input wire logic emergency_stop_i,  // level: emergency stop
    input wire logic latched_i,  // latch of the emergency stop (asynchronous)
    input wire logic [input_roles_pkg::WIDTH-1:0] roles_i,
    input wire logic [axis_observe_pkg::WIDTH*Axes-1:0] axes_i,
    input wire logic path_active_i,  // also throughout a direct move
    input wire logic direct_active_i,
    input wire logic abort_i,  // event
    input wire logic [31:0] clear_fault_i,  // ones written to FAULT
    input wire logic session_gone_i,  // the session that wrote the stream has been replaced by another
    input wire logic link_lost_i,
    output logic cut_o,  // event
    output logic stop_o,  // event: requests a snapshot
    output logic rest_o,  // event: requests a snapshot for the area REST (combinational)
    output logic closed_o,  // no command and no START is accepted
    // status
    input wire logic card_idle_i,  // nothing runs, is decoded or queued; delayed by up to four clocks
    output logic idle_o,  // the feed is idle (combinational)
    output logic [time_state_pkg::WIDTH-1:0] time_state_o,
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o
);
  logic [16:0] ratio;
  logic [31:0] rate;
  logic at_rest;
  logic hold;
  logic underrun_hold;
  logic active;
  logic moving;
  logic fixed;
  logic stopping;
  logic closing;
  logic shut;
  logic fed;
  logic expired;
  logic enable_wait;
  logic [Axes-1:0] disabled;
  logic button;
  logic soft_limit;
  logic [stop_causes_pkg::WIDTH-1:0] causes;
  logic [Axes-1:0] step;  // steps on the path
  logic [Axes-1:0] dir;  // direction of each axis's last step: 1 backwards, 0 forwards

  assign at_rest = ratio == 17'd0;
  assign feed_o[feed_pkg::AT_REST] = at_rest;
  assign feed_o[feed_pkg::STOPPING] = stopping;
  assign feed_o[feed_pkg::CLOSING] = closing;
  assign feed_o[feed_pkg::LATCHED] = latched_i;
  assign feed_o[feed_pkg::GIVES] = active && !enable_wait;
  assign feed_o[feed_pkg::RATIO+:17] = ratio;
  assign feed_o[feed_pkg::RATE+:32] = rate;
  assign time_state_o[time_state_pkg::RATIO+:17] = ratio;
  assign time_state_o[time_state_pkg::RATE+:32] = rate;
  assign time_state_o[time_state_pkg::TICK] = tick_o;
  assign time_state_o[time_state_pkg::HELD] = at_rest;
  assign time_state_o[time_state_pkg::FEED_ACTIVE] = active;
  assign time_state_o[time_state_pkg::STOPPING] = stopping;

  for (genvar n = 0; n < Axes; n++) begin : gen_path_step
    assign step[n] = axes_i[n*axis_observe_pkg::WIDTH+axis_observe_pkg::STEP];
    assign dir[n]  = axes_i[n*axis_observe_pkg::WIDTH+axis_observe_pkg::DIR];
  end

  watchdog over_host (
      .clk_i,
      .rst_i,
      .setting_i,
      .running_o(fed),
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
        .step_i(step),
        .dir_i(dir),
        .runs_i(path_active_i),
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
    assign unused = &{1'b0, roles_i, dir, path_active_i};
  end

  if (Engines[card_map_pkg::ENGINE_SOFT_LIMITS]) begin : gen_soft_limits
    soft_limits #(
        .Axes(Axes)
    ) ranges (
        .clk_i,
        .rst_i,
        .setting_i,
        .axes_i,
        .clear_i(clear_fault_i[card_map_pkg::BIT_FAULT_SOFT_LIMIT]),
        .cause_o(soft_limit),
        .state_o(time_state_o[time_state_pkg::LIMIT_STATE+24+:4])
    );
  end else begin : gen_no_soft_limits
    assign soft_limit = 1'b0;
    assign time_state_o[time_state_pkg::LIMIT_STATE+24+:4] = '0;

    logic unused;
    assign unused = &{1'b0, axes_i};
  end

  drives_part #(
      .Axes   (Axes),
      .Engines(Engines)
  ) drives (
      .clk_i,
      .rst_i,
      .setting_i,
      .moves_i(path_i[path_pkg::TAKING]),  // also throughout a direct move
      .busy_i,
      .emergency_i(emergency_stop_i),
      .fault_i(time_state_o[time_state_pkg::FAULT+:32]),
      .fed_i(fed),
      .enabled_o(feed_o[feed_pkg::ENABLED]),
      .released_o(feed_o[feed_pkg::RELEASED]),
      .healthy_o(feed_o[feed_pkg::HEALTHY]),
      .pump_o(feed_o[feed_pkg::PUMP]),
      .wait_o(enable_wait),
      .waiting_o(time_state_o[time_state_pkg::ENABLE_WAITS]),
      .disabled_o(disabled)
  );

  assign time_state_o[time_state_pkg::ENABLED] = feed_o[feed_pkg::ENABLED];

  machine_place #(
      .Axes(Axes)
  ) place (
      .clk_i,
      .rst_i,
      .setting_i,
      .cut_i(cut_o || closing),
      .at_rest_i(at_rest),
      .runs_i(active || direct_active_i),
      .step_i(step),
      .drive_fault_i(roles_i[input_roles_pkg::DRIVE_FAULT+:Axes]),
      .disabled_i(disabled),
      .place_o(time_state_o[time_state_pkg::PLACE+:16])
  );

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
      .link_lost_i,
      .emergency_i(emergency_stop_i),
      .causes_i(causes),
      .soft_limit_i(soft_limit),
      .abort_i,
      .clear_i(clear_fault_i),
      .at_rest_i(at_rest),
      .moving_i(moving),
      .fixed_i(fixed),
      .underrun_i(underrun_hold),
      .probe_i(path_i[path_pkg::HOLD]),
      .button_i(button),
      .take_i(take_o),
      .swap_i,
      .quiet_i,
      .pulses_i,
      .busy_i,
      .fault_o(time_state_o[time_state_pkg::FAULT+:32]),
      .hold_o(hold),
      .cut_o,
      .stop_o,
      .rest_o,
      .caused_o(feed_o[feed_pkg::CAUSED]),
      .stopping_o(stopping),
      .closing_o(closing),
      .shut_o(shut),
      .settled_o(time_state_o[time_state_pkg::SETTLED]),
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
      .shut_i(shut),
      .wait_i(enable_wait),
      .settled_i(time_state_o[time_state_pkg::SETTLED]),
      .take_o,
      .tick_o,
      .swap_o(time_state_o[time_state_pkg::FEED_SWAP]),
      .card_idle_i,
      .session_gone_i,
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
      .rate_o(rate),
      .begun_o(time_state_o[time_state_pkg::FEED_BEGUN+:32]),
      .snapshot_i,
      .snapshot_o
  );
endmodule

`default_nettype wire
