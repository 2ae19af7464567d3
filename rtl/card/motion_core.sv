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
  logic hold_o, underrun_hold_o;
  logic mismatch_o, incomplete_o, missing_o;
  logic            stopping_o;
  logic [Axes-1:0] step_fault;
  // ticks
  logic take_o, tick_o, feed_swap, feed_active, moving_o, fixed_o, streaming_o;
  logic runs_o, at_barrier_o, feed_idle;
  logic [16:0] ratio_o;
  logic [31:0] rate_o;
  // geometry
  logic [21:0] load;
  logic taking_o, swap, over_o;
  logic [Axes-1:0] active;
  logic [     4:0] engine_o;
  logic [     1:0] instant_o;
  logic [2:0] barrier_o, probe_at_o, probe_says_o;
  logic [1:0] drop_o;
  logic probe_hold_o, probing_o;
  logic path_active_o, ended_o, geometry_idle, direct_o, go_o;
  logic [Axes-1:0] mask_o;
  logic [    21:0] direct_load;
  // path engines
  logic path_tick_o, ready_o, payload_ready_o, shadows_free_o, engine_taken_o, engine_done, elsewhere_o;
  // axes
  logic live_o, axes_busy;
  logic [34*Axes-1:0] axes_observe;
  // status
  logic idle_q, running_q, busy;
  logic [31:0] feed_chain, geometry_chain;

  assign held_o    = ratio_o == 17'd0;
  assign status_o  = {stopping_o, ended_o, feed_active, path_active_o, direct_o, busy};
  assign observe_o = {rate_o, ratio_o, axes_observe, feed_swap, swap, path_tick_o, tick_o};

  stop_control #(
      .Axes   (Axes),
      .Engines(Engines)
  ) stops (
      .*,
      .step_fault_i(step_fault),
      .mismatch_i  (mismatch_o),
      .incomplete_i(incomplete_o),
      .missing_i   (missing_o),
      .clear_i     (clear_fault_i),
      .at_rest_i   (held_o),
      .moving_i    (moving_o),
      .fixed_i     (fixed_o),
      .underrun_i  (underrun_hold_o),
      .probe_i     (probe_hold_o)
  );

  tick_source #(
      .Engines(Engines)
  ) ticks (
      .*,
      .cut_i      (cut_o),
      .hold_i     (hold_o),
      .empty_i    (feed_empty_i),
      .word_i     (feed_word_i),
      .read_o     (feed_read_o),
      .direct_i   (direct_o),
      .streaming_i(streaming_o),
      .taking_i   (taking_o),
      .ready_i    (ready_o),
      .swap_o     (feed_swap),
      .drop_i     (drop_o),
      .card_idle_i(idle_q),
      .barrier_i  (barrier_o),
      .active_o   (feed_active),
      .idle_o     (feed_idle),
      .begun_o    (feed_begun_o),
      .chain_o    (feed_chain)
  );

  geometry_sequencer #(
      .Axes   (Axes),
      .Engines(Engines)
  ) geometry (
      .*,
      .cut_i          (cut_o),
      .empty_i        (geometry_empty_i),
      .word_i         (geometry_word_i),
      .read_o         (geometry_read_o),
      .direct_load_i  (direct_load),
      .direct_go_i    (go_o),
      .direct_mask_i  (mask_o),
      .load_o         (load),
      .take_i         (take_o),
      .swap_o         (swap),
      .active_o       (active),
      .payload_ready_i(payload_ready_o),
      .shadows_free_i (shadows_free_o),
      .done_i         (engine_done),
      .elsewhere_i    (elsewhere_o),
      .axes_live_i    (live_o),
      .rest_i         (idle_q && !busy),
      .probe_says_i   (probe_says_o),
      .drop_i         (drop_o),
      .feed_at_i      (at_barrier_o),
      .feed_runs_i    (runs_o),
      .idle_o         (geometry_idle),
      .chain_i        (feed_chain),
      .chain_o        (geometry_chain),
      .begun_o        (geometry_begun_o)
  );

  path_to_pins #(
      .Axes   (Axes),
      .Engines(Engines)
  ) moves (
      .*,
      .cut_i         (cut_o || drop_o[0]),
      .load_i        (load),
      .tick_i        (tick_o),
      .swap_i        (swap),
      .active_i      (active),
      .engine_i      (engine_o),
      .engine_taken_i(engine_taken_o),
      .direct_i      (direct_o),
      .done_o        (engine_done),
      .busy_o        (axes_busy),
      .fault_o       (step_fault),
      .chain_i       (geometry_chain),
      .observe_o     (axes_observe)
  );

  path_commands #(
      .Engines(Engines),
      .Inputs (Inputs),
      .Outputs(Outputs)
  ) commands (
      .*,
      .cut_i     (cut_o),
      .load_i    (load),
      .taken_i   (instant_o),
      .over_i    (over_o),
      .runs_i    (path_active_o),
      .at_rest_i (held_o),
      .stopping_i(stopping_o),
      .probe_at_i(probe_at_o)
  );

  if (Engines[card_map_pkg::ENGINE_DIRECT_MODE]) begin : gen_direct_mode
    direct_loader #(
        .Axes(Axes)
    ) loader (
        .*,
        .busy_i   (busy),
        .closed_i (closed_o),
        .mask_i   (start_mask_i),
        .address_o(loader_address_o),
        .data_i   (loader_data_i),
        .done_o   (start_done_o),
        .error_o  (start_error_o),
        .reason_o (start_reason_o),
        .load_o   (direct_load)
    );
  end else begin : gen_no_direct_mode
    assign {loader_address_o, start_done_o, start_error_o, start_reason_o} = '0;
    assign {direct_load, go_o, mask_o} = '0;

    logic unused;
    assign unused = &{1'b0, start_i, start_mask_i, loader_data_i};
  end

  always_ff @(posedge clk_i) begin
    idle_q    <= (geometry_idle && feed_idle && !probing_o) || rst_i;
    running_q <= (!idle_q || direct_o || axes_busy) && !rst_i;
  end

  busy_timer status_busy (
      .*,
      .running_i(running_q),
      .busy_o   (busy)
  );
endmodule

`default_nettype wire
