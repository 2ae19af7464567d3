// The geometry side of the sequencer: decodes one command ahead, runs paths, holds barriers.
`default_nettype none

module geometry_sequencer #(
    parameter int Axes = 4
) (
    input  wire logic            clk_i,
    input  wire logic            rst_i,
    input  wire logic            clear_i,
    input  wire logic            go_i,                // no fault
    // queue
    input  wire logic            empty_i,
    input  wire logic [    15:0] word_i,
    output logic                 read_o,
    // direct move
    input  wire logic [    15:0] direct_word_i,
    input  wire logic [     2:0] direct_axis_i,
    input  wire logic            direct_increment_i,
    input  wire logic            direct_steps_i,
    input  wire logic            direct_length_i,
    input  wire logic            direct_go_i,
    input  wire logic [Axes-1:0] direct_mask_i,
    output logic                 direct_o,
    // load bus
    output logic      [    15:0] load_word_o,
    output logic      [Axes-1:0] load_increment_o,
    output logic      [Axes-1:0] load_steps_o,
    output logic                 load_prescale_o,
    output logic      [     8:0] load_deviation_o,
    // ticks
    input  wire logic            take_i,
    output logic                 taking_o,
    output logic                 swap_o,
    output logic      [Axes-1:0] active_o,
    output logic                 prescaler_o,
    output logic                 arc_start_o,
    // ends
    input  wire logic            axes_live_i,
    input  wire logic            engine_empty_i,
    input  wire logic            engine_at_end_i,
    input  wire logic            feed_at_barrier_i,
    output logic                 at_barrier_o,
    output logic                 barrier_done_o,
    // status
    output logic                 incomplete_o,
    output logic                 path_waits_o,        // a decoded path waits
    output logic                 path_active_o,
    output logic                 ended_o,
    output logic                 idle_o,
    output logic      [     7:0] number_o             // of the command under way
);
  logic [Axes-1:0] mask;
  logic            line;
  logic            arc;
  logic            is_barrier;
  logic            is_end;
  logic            valid;
  logic            pop;
  logic            fetch_idle;
  logic            load_length;
  logic            load_path;
  logic            arc_busy;
  logic [    39:0] count;
  logic [     7:0] next_number;
  logic            mid_zero;
  logic            top_zero;
  logic            zero;
  logic            last;
  logic            barrier_load;
  logic            barrier_counting;
  logic            barrier_ended;
  logic            barrier_idle;

  assign path_waits_o = valid & ~is_barrier;

  geometry_fetch #(
      .Axes(Axes)
  ) fetch (
      .clk_i,
      .rst_i,
      .clear_i,
      .pop_i       (pop),
      .arc_busy_i  (arc_busy),
      .empty_i,
      .word_i,
      .read_o,
      .direct_word_i,
      .direct_axis_i,
      .direct_increment_i,
      .direct_steps_i,
      .direct_length_i,
      .load_word_o,
      .load_count_o(load_length),
      .load_increment_o,
      .load_steps_o,
      .load_prescale_o,
      .load_deviation_o,
      .mask_o      (mask),
      .line_o      (line),
      .arc_o       (arc),
      .barrier_o   (is_barrier),
      .end_o       (is_end),
      .idle_o      (fetch_idle),
      .valid_o     (valid)
  );

  count_chain next_count (
      .clk_i,
      .load_i    (load_length),
      .word_i    (load_word_o),
      .count_o   (count),
      .number_o  (next_number),
      .mid_zero_o(mid_zero),
      .top_zero_o(top_zero),
      .zero_o    (zero)
  );

  tick_counter ticks (
      .clk_i,
      .rst_i,
      .load_i    (load_path | barrier_load),
      .count_i   (count),
      .mid_zero_i(mid_zero),
      .top_zero_i(top_zero),
      .take_i    (take_i | barrier_counting),
      .last_o    (last)
  );

  path_sequencer #(
      .Axes(Axes)
  ) path (
      .clk_i,
      .rst_i,
      .clear_i,
      .go_i,
      .valid_i       (valid),
      .line_i        (line),
      .arc_i         (arc),
      .barrier_i     (is_barrier),
      .mask_i        (mask),
      .pop_o         (pop),
      .direct_go_i,
      .direct_mask_i,
      .take_i,
      .last_i        (last),
      .taking_o,
      .swap_o,
      .load_count_o  (load_path),
      .active_o,
      .prescaler_o,
      .arc_start_o,
      .direct_o,
      .arc_busy_o    (arc_busy),
      .axes_live_i,
      .engine_empty_i,
      .engine_at_end_i,
      .incomplete_o,
      .barrier_done_i(barrier_done_o),
      .at_barrier_o,
      .active_path_o (path_active_o)
  );

  barrier meeting (
      .clk_i,
      .rst_i,
      .clear_i,
      .go_i,
      .geometry_at_i(at_barrier_o),
      .feed_at_i    (feed_at_barrier_i),
      .zero_i       (zero),
      .end_i        (is_end),
      .last_i       (last),
      .load_o       (barrier_load),
      .counting_o   (barrier_counting),
      .done_o       (barrier_done_o),
      .ended_o      (barrier_ended),
      .idle_o       (barrier_idle)
  );

  always_ff @(posedge clk_i) begin
    idle_o <= fetch_idle & empty_i & ~path_active_o & barrier_idle;
    if (rst_i | clear_i) number_o <= 8'd0;
    else if ((load_path & ~direct_go_i) | barrier_load) number_o <= next_number;
    if (rst_i | clear_i | load_path | barrier_load) ended_o <= 1'b0;
    else if (barrier_ended) ended_o <= 1'b1;
  end
endmodule

`default_nettype wire
