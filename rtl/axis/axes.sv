// All axes, what they share, and whether any of them still moves.
`default_nettype none

module axes #(
    parameter int Axes    = 4,
    parameter bit Counted = 1
) (
    input  wire logic               clk_i,
    input  wire logic               rst_i,
    input  wire logic               cut_i,
    input  wire logic [ 2*Axes-1:0] idle_level_i,
    input  wire logic [       40:0] setting_i,
    input  wire logic [       21:0] load_i,
    // path domain
    input  wire logic               tick_i,
    input  wire logic               swap_i,
    input  wire logic [   Axes-1:0] active_i,
    input  wire logic               direct_i,
    input  wire logic [       15:0] chord_word_i,
    input  wire logic [   Axes-1:0] chord_load_i,
    input  wire logic [   Axes-1:0] chord_swap_i,
    input  wire logic [   Axes-1:0] engine_step_i,
    input  wire logic [   Axes-1:0] engine_dir_i,
    input  wire logic [        1:0] snapshot_i,
    input  wire logic [       31:0] chain_i,
    output logic      [       31:0] chain_o,
    output logic                    live_o,         // a counted axis has not made its count
    output logic                    busy_o,         // combinational
    output logic      [   Axes-1:0] fault_o,        // events
    output logic      [34*Axes-1:0] observe_o,      // {position, path dir, path step}
    output logic      [   Axes-1:0] step_o,
    output logic      [   Axes-1:0] dir_o
);
  logic                wait_tick;
  logic [    Axes-1:0] live;
  logic [    Axes-1:0] busy;
  logic [    Axes-1:0] path_step;
  logic [    Axes-1:0] path_dir;
  logic [ 32*Axes-1:0] position;
  logic [32*Axes+31:0] chain;  // the word that comes in, and each axis's

  assign chain[31:0] = chain_i;
  assign chain_o = chain[32*Axes+:32];
  assign busy_o    = busy != '0;
  assign observe_o = {position, path_dir, path_step};

  always_ff @(posedge clk_i) live_o <= live != '0 && !rst_i;

  wait_timer timer (
      .clk_i,
      .rst_i,
      .setting_i,
      .tick_o(wait_tick)
  );

  for (genvar n = 0; n < Axes; n++) begin : gen_axis
    axis #(
        .Axis   (n),
        .Counted(Counted)
    ) motor (
        .clk_i,
        .rst_i,
        .cut_i,
        .idle_level_i({idle_level_i[Axes+n], idle_level_i[n]}),
        .setting_i,
        .load_i,
        .tick_i,
        .swap_i,
        .active_i(active_i[n]),
        .direct_i,
        .chord_word_i,
        .chord_load_i(chord_load_i[n]),
        .chord_swap_i(chord_swap_i[n]),
        .engine_step_i(engine_step_i[n]),
        .engine_dir_i(engine_dir_i[n]),
        .wait_tick_i(wait_tick),
        .snapshot_i,
        .chain_i(chain[32*n+:32]),
        .chain_o(chain[32*n+32+:32]),
        .path_step_o(path_step[n]),
        .path_dir_o(path_dir[n]),
        .live_o(live[n]),
        .busy_o(busy[n]),
        .fault_o(fault_o[n]),
        .position_o(position[32*n+:32]),
        .step_o(step_o[n]),
        .dir_o(dir_o[n])
    );
  end
endmodule

`default_nettype wire
