// What moves: time base, feed generator, sequencer, axes, prescaler and deviation accumulator.
`default_nettype none

module motion_core #(
    parameter int Axes = 4
) (
    input  wire logic               clk_i,
    input  wire logic               rst_i,
    input  wire logic               abort_i,
    // queues
    input  wire logic               geometry_empty_i,
    input  wire logic [       15:0] geometry_word_i,
    output logic                    geometry_read_o,
    input  wire logic               feed_empty_i,
    input  wire logic [       15:0] feed_word_i,
    output logic                    feed_read_o,
    // START
    input  wire logic               start_i,
    input  wire logic [        7:0] start_mask_i,
    output logic                    start_done_o,
    output logic                    start_error_o,
    output logic      [        7:0] start_reason_o,
    output logic      [        7:0] loader_address_o,
    input  wire logic [       31:0] loader_data_i,
    // settings
    input  wire logic               hold_i,
    input  wire logic [       16:0] target_i,
    input  wire logic [       27:0] slew_i,
    input  wire logic [       15:0] hold_limit_i,
    input  wire logic [16*Axes-1:0] step_length_i,
    input  wire logic [16*Axes-1:0] step_space_i,
    input  wire logic [16*Axes-1:0] dir_setup_i,
    input  wire logic [16*Axes-1:0] dir_hold_i,
    input  wire logic [ 4*Axes-1:0] mode_i,
    // faults
    input  wire logic [        9:0] fault_i,           // FAULT
    input  wire logic [   Axes-1:0] clear_fault_i,
    output logic      [   Axes-1:0] step_fault_o,
    output logic      [        1:0] fault_o,
    // status
    output logic                    busy_o,
    output logic                    direct_o,
    output logic                    path_active_o,
    output logic                    feed_active_o,
    output logic                    ended_o,
    output logic      [       15:0] running_o,         // {feed, geometry}
    output logic      [       16:0] ratio_o,
    output logic      [       31:0] rate_o,
    output logic                    tick_o,
    output logic                    path_tick_o,
    output logic                    path_swap_o,
    output logic                    feed_swap_o,
    output logic      [   Axes-1:0] path_step_o,
    output logic      [   Axes-1:0] path_dir_o,
    output logic      [32*Axes-1:0] position_o,
    // pins
    output logic      [   Axes-1:0] step_o,
    output logic      [   Axes-1:0] dir_o
);
  logic            enable;
  logic            feed_tick;
  logic            feed_enable;
  logic            feed_clear;
  logic [     3:0] feed_load;
  logic [    15:0] feed_load_word;
  logic [    15:0] load_word;
  logic [Axes-1:0] load_increment;
  logic [Axes-1:0] load_steps;
  logic            load_prescale;
  logic [     8:0] load_deviation;
  logic [Axes-1:0] active;
  logic            prescaler_active;
  logic            prescaler_step;
  logic            arc_start;
  logic            engine_ready;
  logic            engine_at_end;
  logic            step_x;
  logic            dir_x;
  logic            step_y;
  logic            dir_y;
  logic [Axes-1:0] arc_step;
  logic [Axes-1:0] arc_dir;
  logic [Axes-1:0] axis_busy;
  logic [Axes-1:0] axis_live;
  logic            any_live_q;
  logic            faulted_q;
  logic            running_q;
  logic            sequencer_idle;
  logic            go;
  logic            hold_tick;
  logic [    15:0] direct_word;
  logic [     2:0] direct_axis;
  logic            direct_increment;
  logic            direct_steps;
  logic            direct_length;
  logic            direct_go;
  logic [Axes-1:0] direct_mask;

  time_base base (
      .clk_i,
      .rst_i,
      .target_i,
      .slew_i,
      .hold_i,
      .enable_o(enable),
      .ratio_o
  );

  feed_generator feed (
      .clk_i,
      .rst_i,
      .clear_i (feed_clear),
      .enable_i(feed_enable),
      .load_i  (feed_load),
      .word_i  (feed_load_word),
      .swap_i  (feed_swap_o),
      .tick_o  (feed_tick),
      .rate_o
  );

  direct_loader #(
      .Axes(Axes)
  ) loader (
      .clk_i,
      .rst_i,
      .busy_i     (busy_o | ~go),
      .start_i,
      .mask_i     (start_mask_i),
      .address_o  (loader_address_o),
      .data_i     (loader_data_i),
      .done_o     (start_done_o),
      .error_o    (start_error_o),
      .reason_o   (start_reason_o),
      .word_o     (direct_word),
      .axis_o     (direct_axis),
      .increment_o(direct_increment),
      .steps_o    (direct_steps),
      .length_o   (direct_length),
      .go_o       (direct_go),
      .mask_o     (direct_mask)
  );

  sequencer #(
      .Axes(Axes)
  ) sequence_control (
      .clk_i,
      .rst_i,
      .abort_i,
      .geometry_empty_i,
      .geometry_word_i,
      .geometry_read_o,
      .feed_empty_i,
      .feed_word_i,
      .feed_read_o,
      .direct_word_i     (direct_word),
      .direct_axis_i     (direct_axis),
      .direct_increment_i(direct_increment),
      .direct_steps_i    (direct_steps),
      .direct_length_i   (direct_length),
      .direct_go_i       (direct_go),
      .direct_mask_i     (direct_mask),
      .direct_o,
      .enable_i          (enable),
      .feed_tick_i       (feed_tick),
      .feed_enable_o     (feed_enable),
      .feed_clear_o      (feed_clear),
      .feed_swap_o,
      .feed_load_o       (feed_load),
      .feed_word_o       (feed_load_word),
      .load_word_o       (load_word),
      .load_increment_o  (load_increment),
      .load_steps_o      (load_steps),
      .load_prescale_o   (load_prescale),
      .load_deviation_o  (load_deviation),
      .tick_o,
      .swap_o            (path_swap_o),
      .active_o          (active),
      .axes_live_i       (any_live_q),
      .prescaler_o       (prescaler_active),
      .arc_start_o       (arc_start),
      .prescaler_step_i  (prescaler_step),
      .engine_ready_i    (engine_ready),
      .engine_at_end_i   (engine_at_end),
      .path_tick_o,
      .faulted_i         (faulted_q),
      .go_o              (go),
      .fault_o,
      .path_active_o,
      .feed_active_o,
      .ended_o,
      .idle_o            (sequencer_idle),
      .geometry_number_o (running_o[7:0]),
      .feed_number_o     (running_o[15:8])
  );

  // Arcs: path ticks from feed ticks, unit steps from path ticks.
  pulse_generator #(
      .Counted(0)
  ) prescaler (
      .clk_i,
      .rst_i,
      .clear_i         (abort_i),
      .tick_i          (tick_o),
      .swap_i          (path_swap_o),
      .active_i        (prescaler_active),
      .counted_i       (1'b0),
      .mirror_i        (1'b0),
      .load_increment_i(load_prescale),
      .load_count_i    (1'b0),
      .word_i          (load_word),
      .step_o          (prescaler_step),
      .dir_o           (),
      .live_o          ()
  );

  deviation_accumulator accumulator (
      .clk_i,
      .rst_i,
      .load_i  (load_deviation),
      .word_i  (load_word),
      .start_i (arc_start),
      .tick_i  (path_tick_o),
      .clear_i (abort_i),
      .step_x_o(step_x),
      .dir_x_o (dir_x),
      .step_y_o(step_y),
      .dir_y_o (dir_y),
      .ready_o (engine_ready),
      .at_end_o(engine_at_end)
  );

  arc_router #(
      .Axes(Axes)
  ) router (
      .clk_i,
      .rst_i,
      .load_plane_i(load_deviation[8]),
      .word_i      (load_word),
      .step_x_i    (step_x),
      .dir_x_i     (dir_x),
      .step_y_i    (step_y),
      .dir_y_i     (dir_y),
      .step_o      (arc_step),
      .dir_o       (arc_dir)
  );

  hold_timer hold_beat (
      .clk_i,
      .rst_i,
      .limit_i(hold_limit_i),
      .tick_o (hold_tick)
  );

  // A direct move mirrors lines drawn backwards and ends each axis at its count.
  genvar n;
  generate
    for (n = 0; n < Axes; n++) begin : gen_axis
      axis one (
          .clk_i,
          .rst_i,
          .clear_i         (abort_i),
          .tick_i          (tick_o),
          .swap_i          (path_swap_o),
          .active_i        (active[n]),
          .counted_i       (direct_o),
          .mirror_i        (direct_o),
          .load_increment_i(load_increment[n]),
          .load_count_i    (load_steps[n]),
          .word_i          (load_word),
          .ext_step_i      (arc_step[n]),
          .ext_dir_i       (arc_dir[n]),
          .step_length_i   (step_length_i[16*n+:16]),
          .step_space_i    (step_space_i[16*n+:16]),
          .dir_setup_i     (dir_setup_i[16*n+:16]),
          .dir_hold_i      (dir_hold_i[16*n+:16]),
          .mode_i          (mode_i[4*n+:4]),
          .hold_tick_i     (hold_tick),
          .clear_fault_i   (clear_fault_i[n]),
          .path_step_o     (path_step_o[n]),
          .path_dir_o      (path_dir_o[n]),
          .live_o          (axis_live[n]),
          .step_o          (step_o[n]),
          .dir_o           (dir_o[n]),
          .position_o      (position_o[32*n+:32]),
          .busy_o          (axis_busy[n]),
          .fault_o         (step_fault_o[n])
      );
    end
  endgenerate

  always_ff @(posedge clk_i) begin
    any_live_q <= axis_live != '0;
    faulted_q  <= (fault_i != '0) | (step_fault_o != '0);
    running_q  <= ~sequencer_idle | direct_o | (axis_busy != '0);
    if (rst_i) begin
      any_live_q <= 1'b0;
      faulted_q  <= 1'b0;
      running_q  <= 1'b0;
    end
  end

  busy_timer busy (
      .clk_i,
      .rst_i,
      .running_i(running_q),
      .busy_o
  );
endmodule

`default_nettype wire
