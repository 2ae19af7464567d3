// What moves: time base, feed, geometry, path engines and axes, with what stops them.
`default_nettype none

module motion_core #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1,  // what is built in, as the register ENGINES shows it
    parameter int          Inputs  = 4,
    parameter int          Outputs = 4
) (
    input  wire logic                clk_i,
    input  wire logic                rst_i,
    input  wire logic [  2*Axes-1:0] idle_level_i,      // {second pins, first pins}
    input  wire logic [        40:0] setting_i,         // {set, address[9:2], data}
    input  wire logic                abort_i,
    input  wire logic [        31:0] clear_fault_i,
    // pins of path commands
    input  wire logic [  Inputs-1:0] input_i,
    input  wire logic [ Outputs-1:0] output_idle_i,     // levels in reset
    output logic      [ Outputs-1:0] output_o,
    output logic                     mark_o,
    output logic                     probe_o,           // event: a snapshot is wanted (combinational)
    input  wire logic                probe_clear_i,
    output logic      [        66:0] io_o,              // {waiting, probe missed, probed, marks, outputs, inputs}
    // queues
    input  wire logic                geometry_empty_i,
    input  wire logic [        15:0] geometry_word_i,
    output logic                     geometry_read_o,
    input  wire logic                feed_empty_i,
    input  wire logic [        15:0] feed_word_i,
    output logic                     feed_read_o,
    input  wire logic [        21:0] arrive_i,          // as tick_source has it
    // START
    input  wire logic                start_i,
    input  wire logic [         7:0] start_mask_i,
    output logic                     start_done_o,
    output logic                     start_error_o,
    output logic      [         7:0] start_reason_o,
    output logic      [         7:0] loader_address_o,
    input  wire logic [        31:0] loader_data_i,
    // snapshot chain: FAULT and STATUS come in, POSITION of the last axis goes out first
    input  wire logic [         1:0] snapshot_i,        // {shift, strobe}
    input  wire logic [        31:0] chain_i,
    output logic      [        31:0] chain_o,
    // stops
    output logic      [        31:0] fault_o,
    output logic                     cut_o,
    output logic                     closed_o,
    output logic                     stop_o,
    // status
    output logic      [         5:0] status_o,          // {stopping, ended, feed active, path active, direct, busy}
    output logic                     held_o,            // the ratio is 0 (combinational)
    output logic      [        32:0] underrun_o,        // {held by it, or a piece waits for more; how often}
    output logic      [        32:0] stale_o,           // {a line goes on beyond its period, ticks}
    output logic      [        31:0] geometry_begun_o,
    output logic      [        31:0] feed_begun_o,
    // {rate, ratio, position, path dir, path step, feed swap, path swap, path tick, tick}
    output logic      [34*Axes+52:0] observe_o,
    output logic      [    Axes-1:0] step_o,
    output logic      [    Axes-1:0] dir_o
);
  // stops
  logic hold, underrun_hold;
  logic mismatch, incomplete, missing;
  logic            stopping;
  logic [Axes-1:0] step_fault;
  // ticks
  logic take, tick, feed_swap, feed_active, moving, fixed, streaming;
  logic runs, at_barrier, feed_idle;
  logic [16:0] ratio;
  logic [31:0] rate;
  // geometry
  logic [21:0] load;
  logic taking, swap, over;
  logic [Axes-1:0] active;
  logic [     4:0] engine;
  logic [     1:0] instant;
  logic [2:0] barrier, probe_at, probe_says;
  logic [1:0] drop;
  logic probe_hold, probing;
  logic path_active, ended, geometry_idle, direct, go;
  logic [Axes-1:0] mask;
  logic [    21:0] direct_load;
  // path engines
  logic path_tick, ready, payload_ready, shadows_free, engine_taken, engine_done, elsewhere;
  // axes
  logic live, axes_busy;
  logic [34*Axes-1:0] axes_observe;
  // status
  logic idle_q, running_q, busy;
  logic [31:0] feed_chain, geometry_chain;

  assign held_o    = ratio == 17'd0;
  assign status_o  = {stopping, ended, feed_active, path_active, direct, busy};
  assign observe_o = {rate, ratio, axes_observe, feed_swap, swap, path_tick, tick};

  stop_control #(
      .Axes   (Axes),
      .Engines(Engines)
  ) stops (
      .clk_i,
      .rst_i,
      .setting_i,
      .step_fault_i(step_fault),
      .mismatch_i(mismatch),
      .incomplete_i(incomplete),
      .missing_i(missing),
      .abort_i,
      .clear_i(clear_fault_i),
      .at_rest_i(held_o),
      .moving_i(moving),
      .fixed_i(fixed),
      .underrun_i(underrun_hold),
      .probe_i(probe_hold),
      .fault_o,
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
      .empty_i(feed_empty_i),
      .word_i(feed_word_i),
      .read_o(feed_read_o),
      .arrive_i,
      .direct_i(direct),
      .taking_i(taking),
      .ready_i(ready),
      .take_o(take),
      .tick_o(tick),
      .swap_o(feed_swap),
      .streaming_i(streaming),
      .drop_i(drop),
      .card_idle_i(idle_q),
      .barrier_i(barrier),
      .at_barrier_o(at_barrier),
      .runs_o(runs),
      .underrun_hold_o(underrun_hold),
      .underrun_o,
      .active_o(feed_active),
      .moving_o(moving),
      .fixed_o(fixed),
      .idle_o(feed_idle),
      .ratio_o(ratio),
      .rate_o(rate),
      .begun_o(feed_begun_o),
      .snapshot_i,
      .chain_i,
      .chain_o(feed_chain)
  );

  geometry_sequencer #(
      .Axes   (Axes),
      .Engines(Engines)
  ) geometry (
      .clk_i,
      .rst_i,
      .cut_i(cut_o),
      .empty_i(geometry_empty_i),
      .word_i(geometry_word_i),
      .read_o(geometry_read_o),
      .direct_load_i(direct_load),
      .direct_go_i(go),
      .direct_mask_i(mask),
      .direct_o(direct),
      .load_o(load),
      .take_i(take),
      .taking_o(taking),
      .swap_o(swap),
      .active_o(active),
      .engine_o(engine),
      .engine_taken_o(engine_taken),
      .setting_i,
      .arrive_i,
      .rest_i(idle_q && !busy),
      .streaming_o(streaming),
      .missing_o(missing),
      .stale_o,
      .payload_ready_i(payload_ready),
      .shadows_free_i(shadows_free),
      .done_i(engine_done),
      .elsewhere_i(elsewhere),
      .axes_live_i(live),
      .instant_o(instant),
      .over_o(over),
      .probe_at_o(probe_at),
      .probe_says_i(probe_says),
      .drop_i(drop),
      .feed_at_i(at_barrier),
      .feed_runs_i(runs),
      .barrier_o(barrier),
      .mismatch_o(mismatch),
      .incomplete_o(incomplete),
      .path_active_o(path_active),
      .ended_o(ended),
      .idle_o(geometry_idle),
      .snapshot_i,
      .chain_i(feed_chain),
      .chain_o(geometry_chain),
      .begun_o(geometry_begun_o)
  );

  path_to_pins #(
      .Axes   (Axes),
      .Engines(Engines)
  ) moves (
      .clk_i,
      .rst_i,
      .cut_i(cut_o || drop[0]),
      .idle_level_i,
      .setting_i,
      .load_i(load),
      .tick_i(tick),
      .swap_i(swap),
      .active_i(active),
      .engine_i(engine),
      .engine_taken_i(engine_taken),
      .direct_i(direct),
      .ready_o(ready),
      .payload_ready_o(payload_ready),
      .shadows_free_o(shadows_free),
      .done_o(engine_done),
      .elsewhere_o(elsewhere),
      .path_tick_o(path_tick),
      .live_o(live),
      .busy_o(axes_busy),
      .fault_o(step_fault),
      .snapshot_i,
      .chain_i(geometry_chain),
      .chain_o,
      .observe_o(axes_observe),
      .step_o,
      .dir_o
  );

  path_commands #(
      .Engines(Engines),
      .Inputs (Inputs),
      .Outputs(Outputs)
  ) commands (
      .clk_i,
      .rst_i,
      .cut_i(cut_o),
      .setting_i,
      .input_i,
      .output_idle_i,
      .output_o,
      .load_i(load),
      .taken_i(instant),
      .over_i(over),
      .runs_i(path_active),
      .mark_o,
      .at_rest_i(held_o),
      .stopping_i(stopping),
      .probe_clear_i,
      .probe_at_i(probe_at),
      .probe_says_o(probe_says),
      .probe_o,
      .probe_hold_o(probe_hold),
      .drop_o(drop),
      .probing_o(probing),
      .io_o
  );

  if (Engines[card_map_pkg::ENGINE_DIRECT_MODE]) begin : gen_direct_mode
    direct_loader #(
        .Axes(Axes)
    ) loader (
        .clk_i,
        .rst_i,
        .busy_i(busy),
        .closed_i(closed_o),
        .start_i,
        .mask_i(start_mask_i),
        .address_o(loader_address_o),
        .data_i(loader_data_i),
        .done_o(start_done_o),
        .error_o(start_error_o),
        .reason_o(start_reason_o),
        .load_o(direct_load),
        .go_o(go),
        .mask_o(mask)
    );
  end else begin : gen_no_direct_mode
    assign {loader_address_o, start_done_o, start_error_o, start_reason_o} = '0;
    assign {direct_load, go, mask} = '0;

    logic unused;
    assign unused = &{1'b0, start_i, start_mask_i, loader_data_i};
  end

  always_ff @(posedge clk_i) begin
    idle_q    <= (geometry_idle && feed_idle && !probing) || rst_i;
    running_q <= (!idle_q || direct || axes_busy) && !rst_i;
  end

  busy_timer status_busy (
      .clk_i,
      .rst_i,
      .running_i(running_q),
      .busy_o(busy)
  );
endmodule

`default_nettype wire
