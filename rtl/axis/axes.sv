// All axes, the signals that they share, and whether any of them still moves.
`default_nettype none

module axes #(
    parameter int Axes    = 4,
    parameter bit Counted = 1
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic [2*Axes-1:0] idle_level_i,  // level before and in reset: {second pins, first pins}
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [load_bus_pkg::WIDTH-1:0] load_i,
    input wire logic [move_pkg::WIDTH-1:0] move_i,
    input wire logic [axis_drive_pkg::WIDTH-1:0] drive_i,
    input wire logic silent_i,  // steps are dropped
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o,
    output logic live_o,  // an axis of a counted line has not yet made its count
    output logic busy_o,  // combinational
    output logic [Axes-1:0] fault_o,  // events
    output logic [axis_observe_pkg::WIDTH*Axes-1:0] observe_o,
    output logic [Axes-1:0] step_o,
    output logic [Axes-1:0] dir_o
);
  localparam int SNAPSHOT = snapshot_pkg::WIDTH;

  logic                              wait_tick;
  logic [                  Axes-1:0] live;
  logic [                  Axes-1:0] busy;
  logic [SNAPSHOT*Axes+SNAPSHOT-1:0] chain;  // the input of the chain, then the output of each axis

  assign chain[SNAPSHOT-1:0] = snapshot_i;
  assign snapshot_o = chain[SNAPSHOT*Axes+:SNAPSHOT];
  assign busy_o = busy != '0;

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
        .tick_i(drive_i[axis_drive_pkg::TICK]),
        .swap_i(drive_i[axis_drive_pkg::SWAP]),
        .active_i(move_i[move_pkg::AXES+n]),
        .direct_i(move_i[move_pkg::DIRECT]),
        .chord_word_i(axis_drive_pkg::chord_word(drive_i)),
        .chord_load_i(drive_i[axis_drive_pkg::CHORD_LOAD+n]),
        .chord_swap_i(drive_i[axis_drive_pkg::CHORD_SWAP+n]),
        .silent_i,
        .engine_step_i(drive_i[axis_drive_pkg::STEP+n]),
        .engine_dir_i(drive_i[axis_drive_pkg::DIR+n]),
        .wait_tick_i(wait_tick),
        .snapshot_i(chain[SNAPSHOT*n+:SNAPSHOT]),
        .snapshot_o(chain[SNAPSHOT*(n+1)+:SNAPSHOT]),
        .live_o(live[n]),
        .busy_o(busy[n]),
        .fault_o(fault_o[n]),
        .observe_o(observe_o[axis_observe_pkg::WIDTH*n+:axis_observe_pkg::WIDTH]),
        .step_o(step_o[n]),
        .dir_o(dir_o[n])
    );
  end

  logic unused;  // absent axes
  assign unused = &{1'b0, move_i, drive_i};
endmodule

`default_nettype wire
