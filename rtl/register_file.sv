`default_nettype none

// The card's registers behind one inner port: takes an access, judges it by the register map, acts and answers.
// Ports and latencies: docs/developer/architecture.md.
module register_file #(
    parameter int Axes = 4,
    parameter int GeometryDepth = 4096,
    parameter int FeedDepth = 2560
) (
    input  wire logic               clk_i,
    input  wire logic               rst_i,
    input  wire logic [       31:0] clock_hz_i,
    // the access
    input  wire logic               request_i,
    input  wire logic               write_i,
    input  wire logic               partial_i,
    input  wire logic [       11:0] address_i,
    input  wire logic [       31:0] data_i,
    output logic                    ack_o,
    output logic                    error_o,
    output logic      [       31:0] data_o,
    // the card's state
    input  wire logic               busy_i,
    input  wire logic               direct_i,
    input  wire logic               path_active_i,
    input  wire logic               feed_active_i,
    input  wire logic               ended_i,
    input  wire logic               incomplete_i,
    input  wire logic [       15:0] geometry_room_i,
    input  wire logic [       15:0] feed_room_i,
    input  wire logic [        7:0] running_geometry_i,
    input  wire logic [        7:0] running_feed_i,
    input  wire logic [       31:0] rate_i,
    input  wire logic [       16:0] ratio_i,
    input  wire logic [32*Axes-1:0] position_i,
    input  wire logic [        9:0] fault_i,
    output logic      [        9:0] clear_fault_o,
    output logic      [        9:0] fault_o,
    output logic                    irq_o,
    // the stream's door
    output logic                    stream_write_o,
    output logic      [       31:0] stream_word_o,
    input  wire logic               door_ready_i,
    input  wire logic               door_refuse_i,
    input  wire logic [        7:0] door_reason_i,
    input  wire logic [        7:0] door_number_i,
    output logic                    abort_o,
    output logic                    flush_o,
    // the direct loader
    output logic                    start_o,
    output logic      [        7:0] start_mask_o,
    input  wire logic               start_done_i,
    input  wire logic               start_error_i,
    input  wire logic [        7:0] start_reason_i,
    input  wire logic [        7:0] loader_address_i,
    output logic      [       31:0] loader_data_o,
    // settings
    output logic                    hold_o,
    output logic      [       16:0] ratio_o,
    output logic      [       27:0] slew_o,
    output logic      [       15:0] hold_limit_o,
    output logic      [16*Axes-1:0] step_length_o,
    output logic      [16*Axes-1:0] step_space_o,
    output logic      [16*Axes-1:0] dir_setup_o,
    output logic      [16*Axes-1:0] dir_hold_o,
    output logic      [ 4*Axes-1:0] mode_o
);

  logic        judge;
  logic        sample;
  logic        respond;
  logic        write;
  logic        partial;
  logic [11:0] address;
  logic [31:0] word;
  logic [ 2:0] kind;
  logic        control;
  logic        fault_write;
  logic        refusal_write;
  logic        stream_write;
  logic        start_write;
  logic        good;
  logic [ 7:0] reason;
  logic        walking;
  logic        act;
  logic        refuse;
  logic [ 7:0] refuse_reason;
  logic        start;

  register_control i_control (
      .clk_i,
      .rst_i,
      .request_i,
      .write_i,
      .partial_i,
      .address_i,
      .data_i,
      .ack_o,
      .error_o,
      .respond_o(respond),
      .write_o(write),
      .partial_o(partial),
      .address_o(address),
      .word_o(word),
      .judge_o(judge),
      .sample_o(sample),
      .kind_i(kind),
      .stream_i(stream_write),
      .start_i(start_write),
      .good_i(good),
      .reason_i(reason),
      .walking_i(walking),
      .act_o(act),
      .refuse_o(refuse),
      .refuse_reason_o(refuse_reason),
      .stream_write_o,
      .start_o(start),
      .door_ready_i,
      .door_refuse_i,
      .start_done_i,
      .start_error_i,
      .start_reason_i
  );

  register_decode #(
      .Axes(Axes)
  ) i_decode (
      .clk_i,
      .judge_i(judge),
      .write_i(write),
      .partial_i(partial),
      .address_i(address),
      .data_i(word),
      .direct_i,
      .kind_o(kind),
      .control_o(control),
      .fault_o(fault_write),
      .refusal_o(refusal_write),
      .stream_o(stream_write),
      .start_o(start_write),
      .good_o(good),
      .reason_o(reason)
  );

  assign stream_word_o = word;
  assign start_o = start;
  assign start_mask_o = word[7:0];

  // CONTROL: single pulses.
  logic snapshot_q;
  logic abort_q;
  logic flush_q;

  always_ff @(posedge clk_i) begin
    snapshot_q <= 1'b0;
    abort_q <= 1'b0;
    flush_q <= 1'b0;
    if (act && control) begin
      snapshot_q <= word[card_map_pkg::BIT_CONTROL_SNAPSHOT];
      abort_q <= word[card_map_pkg::BIT_CONTROL_ABORT];
      flush_q <= word[card_map_pkg::BIT_CONTROL_FLUSH];
    end
    if (rst_i) begin
      snapshot_q <= 1'b0;
      abort_q <= 1'b0;
      flush_q <= 1'b0;
    end
  end

  assign abort_o = abort_q;
  assign flush_o = flush_q;

  logic [ 9:0] fault;
  logic        refused;
  logic [27:0] refusal;

  refusal_latch i_latch (
      .clk_i,
      .rst_i,
      .fault_i,
      .clear_fault_i(act && fault_write ? word[9:0] : 10'd0),
      .clear_refusal_i(act && refusal_write),
      .refuse_i(refuse),
      .reason_i(refuse_reason),
      .address_i(address),
      .door_refuse_i,
      .door_reason_i,
      .door_number_i,
      .fault_o(fault),
      .clear_fault_o,
      .refused_o(refused),
      .refusal_o(refusal)
  );

  assign fault_o = fault;

  logic       set;
  logic [7:0] irq_enable;

  assign set = act && kind == card_map_pkg::ACCESS_SETTING;

  register_settings #(
      .Axes(Axes)
  ) i_settings (
      .clk_i,
      .rst_i,
      .write_i(set),
      .word_i(address[11:2]),
      .data_i(word[27:0]),
      .hold_o,
      .ratio_o,
      .slew_o,
      .hold_limit_o,
      .irq_enable_o(irq_enable),
      .step_length_o,
      .step_space_o,
      .dir_setup_o,
      .dir_hold_o,
      .mode_o
  );

  logic [ 9:0] status;
  logic [27:0] live;

  register_live i_live (
      .clk_i,
      .rst_i,
      .sample_i(sample),
      .word_i(address[5:2]),
      .busy_i,
      .direct_i,
      .path_active_i,
      .feed_active_i,
      .ended_i,
      .incomplete_i,
      .walking_i(walking),
      .ratio_i,
      .fault_i(fault),
      .refused_i(refused),
      .refusal_i(refusal),
      .geometry_room_i,
      .feed_room_i,
      .running_i({running_feed_i, running_geometry_i}),
      .irq_enable_i(irq_enable),
      .status_o(status),
      .data_o(live),
      .irq_o
  );

  // The direct loader owns the RAM's read side from its start to its end; the START write waits all the while.
  logic        loading_q;
  logic [31:0] stored;

  always_ff @(posedge clk_i) begin
    loading_q <= (loading_q || start) && !start_done_i;
    if (rst_i) loading_q <= 1'b0;
  end

  register_ram #(
      .Axes(Axes),
      .GeometryDepth(GeometryDepth),
      .FeedDepth(FeedDepth)
  ) i_ram (
      .clk_i,
      .rst_i,
      .clock_hz_i,
      .write_i(set),
      .write_address_i(address[9:2]),
      .write_data_i(word),
      .snapshot_i(snapshot_q),
      .position_i,
      .rate_i,
      .ratio_i,
      .running_i({running_feed_i, running_geometry_i}),
      .status_i(status),
      .address_i(loading_q ? loader_address_i : address[9:2]),
      .walking_o(walking),
      .data_o(stored)
  );

  assign loader_data_o = stored;

  logic        from_live;
  logic [31:0] data_q;

  assign from_live = kind == card_map_pkg::ACCESS_LIVE || kind == card_map_pkg::ACCESS_CLEAR_ONES;

  always_ff @(posedge clk_i) begin
    data_q <= '0;
    if (respond) data_q <= from_live ? {4'd0, live} : stored;
    if (rst_i) data_q <= '0;
  end

  assign data_o = data_q;

endmodule

`default_nettype wire
