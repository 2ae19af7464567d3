// From feed ticks to pins: the path engines, and the axes that they move.
`default_nettype none

module path_to_pins #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1  // what is built in, as the register ENGINES shows it
) (
    input  wire logic               clk_i,
    input  wire logic               rst_i,
    input  wire logic               cut_i,
    input  wire logic [ 2*Axes-1:0] idle_level_i,     // {second pins, first pins}
    input  wire logic [       40:0] setting_i,        // {set, address[9:2], data}
    // the path
    input  wire logic [       21:0] load_i,
    input  wire logic               tick_i,
    input  wire logic               swap_i,
    input  wire logic [   Axes-1:0] active_i,
    input  wire logic [        4:0] engine_i,
    input  wire logic               engine_taken_i,
    input  wire logic               direct_i,
    // engines
    output logic                    ready_o,
    output logic                    payload_ready_o,
    output logic                    shadows_free_o,
    output logic                    done_o,
    output logic                    elsewhere_o,
    output logic                    path_tick_o,
    // axes
    output logic                    live_o,
    output logic                    busy_o,
    output logic      [   Axes-1:0] fault_o,
    input  wire logic [        1:0] snapshot_i,       // {shift, strobe}
    input  wire logic [       31:0] chain_i,
    output logic      [       31:0] chain_o,
    output logic      [34*Axes-1:0] observe_o,
    output logic      [   Axes-1:0] step_o,
    output logic      [   Axes-1:0] dir_o
);
  logic            path_tick;
  logic            path_swap;
  logic [Axes-1:0] engine_step;
  logic [Axes-1:0] engine_dir;
  logic [    15:0] chord_word;
  logic [Axes-1:0] chord_load;
  logic [Axes-1:0] chord_swap;

  path_engines #(
      .Axes   (Axes),
      .Engines(Engines)
  ) engines (
      .clk_i,
      .rst_i,
      .cut_i,
      .tick_i,
      .swap_i,
      .engine_i,
      .engine_taken_i,
      .load_i,
      .tick_o(path_tick),
      .swap_o(path_swap),
      .path_tick_o,
      .step_o(engine_step),
      .dir_o(engine_dir),
      .chord_word_o(chord_word),
      .chord_load_o(chord_load),
      .chord_swap_o(chord_swap),
      .ready_o,
      .payload_ready_o,
      .shadows_free_o,
      .done_o,
      .elsewhere_o
  );

  axes #(
      .Axes   (Axes),
      .Counted(Engines[card_map_pkg::ENGINE_DIRECT_MODE])
  ) all_axes (
      .clk_i,
      .rst_i,
      .cut_i,
      .idle_level_i,
      .setting_i,
      .load_i,
      .tick_i(path_tick),
      .swap_i(path_swap),
      .active_i,
      .direct_i,
      .chord_word_i(chord_word),
      .chord_load_i(chord_load),
      .chord_swap_i(chord_swap),
      .engine_step_i(engine_step),
      .engine_dir_i(engine_dir),
      .snapshot_i,
      .chain_i,
      .chain_o,
      .live_o,
      .busy_o,
      .fault_o,
      .observe_o,
      .step_o,
      .dir_o
  );
endmodule

`default_nettype wire
