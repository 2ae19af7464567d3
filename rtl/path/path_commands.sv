// The card's outputs, and the actions of commands on outputs and inputs at their place on the path. Without the engine
// path_commands the outputs keep the strap's levels.
`default_nettype none

module path_commands #(
    parameter logic [31:0] Engines = '1,  // built-in engines: bits card_map_pkg::ENGINE_*
    parameter int          Outputs = 4    // 1 to 16
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    // pins
    input wire logic [input_levels_pkg::WIDTH-1:0] inputs_i,
    input wire logic [Outputs-1:0] output_idle_i,  // strap
    output logic [Outputs-1:0] output_o,
    // commands
    input wire logic [load_bus_pkg::WIDTH-1:0] load_i,
    input wire logic [commands_pkg::WIDTH-1:0] commands_i,
    output logic mark_o,  // event: requests a snapshot
    // probe
    input wire logic [feed_pkg::WIDTH-1:0] feed_i,
    input wire logic probe_clear_i,  // event
    output logic [probe_pkg::WIDTH-1:0] probe_o,
    output logic drop_o,  // commands up to PROBE_END are dropped
    output logic halt_o,  // event: the path and the piece under way end here
    output logic probe_snapshot_o,  // event: requests a snapshot (combinational)
    // registers
    output logic [pins_state_pkg::WIDTH-1:0] pins_state_o
);
  if (Engines[card_map_pkg::ENGINE_PATH_COMMANDS]) begin : gen_built
    logic [31:0] levels;
    logic [31:0] marks;
    logic safe;  // outputs take their safe levels: from the end of ticks to the cut
    logic change;
    logic [Outputs-1:0] set;
    logic [Outputs-1:0] level;
    logic [Outputs-1:0] clear;
    logic [Outputs-1:0] plain;  // levels without the pulses of PWM

    assign levels = input_levels_pkg::levels(inputs_i);
    assign safe   = cut_i || feed_i[feed_pkg::CLOSING];

    instant_commands #(
        .Outputs(Outputs)
    ) instants (
        .clk_i,
        .rst_i,
        .cut_i(safe || halt_o),
        .load_i,
        .take_output_i(commands_i[commands_pkg::TAKE_OUTPUT]),
        .take_mark_i(commands_i[commands_pkg::TAKE_MARK]),
        .take_pwm_i(commands_i[commands_pkg::TAKE_PWM]),
        .over_i(commands_i[commands_pkg::OVER]),
        .runs_i(commands_i[commands_pkg::RUNS]),
        .mark_o,
        .marks_o(marks),
        .change_o(change),
        .set_o(set),
        .clear_o(clear)
    );

    output_pins #(
        .Outputs(Outputs)
    ) outputs (
        .clk_i,
        .rst_i,
        .cut_i(safe),
        .caused_i(feed_i[feed_pkg::CAUSED]),
        .latched_i(feed_i[feed_pkg::LATCHED]),
        .setting_i,
        .idle_i(output_idle_i),
        .change_i(change),
        .set_i(set),
        .clear_i(clear),
        .pin_o(level)
    );

    if (Engines[card_map_pkg::ENGINE_ENABLES]) begin : gen_roles
      output_roles #(
          .Outputs(Outputs)
      ) roles (
          .clk_i,
          .rst_i,
          .setting_i,
          .idle_i(output_idle_i),
          .latched_i(feed_i[feed_pkg::LATCHED]),
          .enabled_i(feed_i[feed_pkg::ENABLED]),
          .released_i(feed_i[feed_pkg::RELEASED]),
          .pump_i(feed_i[feed_pkg::PUMP]),
          .healthy_i(feed_i[feed_pkg::HEALTHY]),
          .level_i(level),
          .pin_o(plain)
      );
    end else begin : gen_no_roles
      assign plain = level;
    end

    if (Engines[card_map_pkg::ENGINE_PWM]) begin : gen_pwm
      pwm #(
          .Outputs(Outputs)
      ) pulses (
          .clk_i,
          .rst_i,
          .setting_i,
          .load_i,
          .take_i (commands_i[commands_pkg::TAKE_PWM]),
          .apply_i(change),
          .drop_i (safe || halt_o),
          .feed_i,
          .runs_i (commands_i[commands_pkg::RUNS]),
          .level_i(plain),
          .idle_i (output_idle_i),
          .pin_o  (output_o)
      );
    end else begin : gen_no_pwm
      assign output_o = plain;
    end

    probe #(
        .FirstTouch(32'(Engines[card_map_pkg::ENGINE_CAPTURES]))
    ) edges (
        .clk_i,
        .rst_i,
        .cut_i,
        .level_i(levels),
        .raw_i(input_levels_pkg::raw(inputs_i)),
        .quiet_i(input_levels_pkg::quiet(inputs_i)),
        .load_i,
        .waits_i(commands_i[commands_pkg::PROBE_WAITS]),
        .ends_i(commands_i[commands_pkg::PROBE_ENDS]),
        .at_rest_i(feed_i[feed_pkg::AT_REST]),
        .stopping_i(feed_i[feed_pkg::STOPPING]),
        .clear_i(probe_clear_i),
        .met_o(probe_o[probe_pkg::MET]),
        .taken_o(probe_o[probe_pkg::TAKEN]),
        .stays_o(probe_o[probe_pkg::STAYS]),
        .snapshot_o(probe_snapshot_o),
        .hold_o(probe_o[probe_pkg::HOLD]),
        .halt_o,
        .drop_o,
        .busy_o(probe_o[probe_pkg::BUSY]),
        .probed_o(pins_state_o[pins_state_pkg::PROBED]),
        .missed_o(pins_state_o[pins_state_pkg::PROBE_MISSED])
    );

    assign pins_state_o[pins_state_pkg::INPUTS+:32]  = levels;
    assign pins_state_o[pins_state_pkg::OUTPUTS+:16] = 16'(plain);
    assign pins_state_o[pins_state_pkg::MARKS+:32]   = marks;

    logic unused;
    assign unused = &{1'b0, feed_i};
  end else begin : gen_without
    assign output_o = output_idle_i;
    assign {mark_o, probe_snapshot_o, probe_o, drop_o, halt_o, pins_state_o} = '0;

    logic unused;
    assign unused = &{1'b0, clk_i, rst_i, cut_i, setting_i, inputs_i, load_i, commands_i, feed_i, probe_clear_i};
  end
endmodule

`default_nettype wire
