// The card: host port, registers, command queues, time base, sequencer, axes and the deviation accumulator.
//
// The ports behind the interrupt show what goes on inside, for lockstep; a board leaves them open.
`default_nettype none

module trammel_card #(
    parameter int Axes          = 4,     // 1 to 8
    parameter int GeometryDepth = 4096,  // halfwords, even, 2 to 32,768
    parameter int FeedDepth     = 2560   // likewise
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [31:0] clock_hz_i,
    // AXI4-Lite
    input wire logic awvalid_i,
    output logic awready_o,
    input wire logic [11:0] awaddr_i,
    input wire logic wvalid_i,
    output logic wready_o,
    input wire logic [31:0] wdata_i,
    input wire logic [3:0] wstrb_i,
    output logic bvalid_o,
    input wire logic bready_i,
    output logic [1:0] bresp_o,
    input wire logic arvalid_i,
    output logic arready_o,
    input wire logic [11:0] araddr_i,
    output logic rvalid_o,
    input wire logic rready_i,
    output logic [31:0] rdata_o,
    output logic [1:0] rresp_o,
    // pins
    output logic [Axes-1:0] step_o,
    output logic [Axes-1:0] dir_o,
    output logic irq_o,
    // observation
    output logic tick_o,
    output logic path_tick_o,
    output logic path_swap_o,
    output logic feed_swap_o,
    output logic [Axes-1:0] path_step_o,
    output logic [Axes-1:0] path_dir_o,
    output logic [32*Axes-1:0] position_o,
    output logic [15:0] geometry_room_o,
    output logic [15:0] feed_room_o,
    output logic [5:0] status_o,  // {door incomplete, ended, feed active, path active, direct, busy}
    output logic [9:0] fault_o,
    output logic [15:0] running_o,  // {feed, geometry}
    output logic [16:0] ratio_o,
    output logic [31:0] rate_o
);
  // A parameter out of its range stops every reader here: there is no module of this name, and the name says why.
  if (Axes < 1 || Axes > 8) begin : gen_wrong_axes
    ERROR_Axes_must_be_1_to_8 error ();
  end
  if (GeometryDepth % 2 != 0 || FeedDepth % 2 != 0) begin : gen_odd_depth
    ERROR_GeometryDepth_and_FeedDepth_must_be_even error ();
  end

  // The reset is registered once for all blocks: it takes effect a clock later, and nothing combinational hangs on the
  // pin.
  logic rst_q;
  always_ff @(posedge clk_i) rst_q <= rst_i;

  // Host side.
  logic        request;
  logic        write;
  logic        partial;
  logic [11:0] address;
  logic [31:0] data;
  logic        ack;
  logic        error;
  logic [31:0] read_data;

  axi4_lite_port host (
      .clk_i,
      .rst_i    (rst_q),
      .awvalid_i,
      .awready_o,
      .awaddr_i,
      .wvalid_i,
      .wready_o,
      .wdata_i,
      .wstrb_i,
      .bvalid_o,
      .bready_i,
      .bresp_o,
      .arvalid_i,
      .arready_o,
      .araddr_i,
      .rvalid_o,
      .rready_i,
      .rdata_o,
      .rresp_o,
      .request_o(request),
      .write_o  (write),
      .partial_o(partial),
      .address_o(address),
      .data_o   (data),
      .ack_i    (ack),
      .error_i  (error),
      .data_i   (read_data)
  );

  // Registers.
  logic               stream_write;
  logic [       31:0] stream_word;
  logic               door_ready;
  logic               door_refuse;
  logic [        7:0] door_reason;
  logic [        7:0] door_number;
  logic               door_partial;
  logic               abort;
  logic               flush;
  logic               start;
  logic [        7:0] start_mask;
  logic               start_done;
  logic               start_error;
  logic [        7:0] start_reason;
  logic [        7:0] loader_address;
  logic [       31:0] loader_data;
  logic               hold;
  logic [       16:0] target;
  logic [       27:0] slew;
  logic [       15:0] hold_limit;
  logic [16*Axes-1:0] step_length;
  logic [16*Axes-1:0] step_space;
  logic [16*Axes-1:0] dir_setup;
  logic [16*Axes-1:0] dir_hold;
  logic [ 4*Axes-1:0] mode;
  logic [   Axes-1:0] step_fault;
  logic [        1:0] sequencer_fault;
  logic [        9:0] clear_fault;
  logic               busy;
  logic               direct;
  logic               path_active;
  logic               feed_active;
  logic               ended;

  register_file #(
      .Axes         (Axes),
      .GeometryDepth(GeometryDepth),
      .FeedDepth    (FeedDepth)
  ) registers (
      .clk_i,
      .rst_i             (rst_q),
      .clock_hz_i,
      .request_i         (request),
      .write_i           (write),
      .partial_i         (partial),
      .address_i         (address),
      .data_i            (data),
      .ack_o             (ack),
      .error_o           (error),
      .data_o            (read_data),
      .busy_i            (busy),
      .direct_i          (direct),
      .path_active_i     (path_active),
      .feed_active_i     (feed_active),
      .ended_i           (ended),
      .incomplete_i      (door_partial),
      .geometry_room_i   (geometry_room_o),
      .feed_room_i       (feed_room_o),
      .running_geometry_i(running_o[7:0]),
      .running_feed_i    (running_o[15:8]),
      .rate_i            (rate_o),
      .ratio_i           (ratio_o),
      .position_i        (position_o),
      .fault_i           ({sequencer_fault, 8'(step_fault)}),
      .clear_fault_o     (clear_fault),
      .fault_o,
      .irq_o,
      .stream_write_o    (stream_write),
      .stream_word_o     (stream_word),
      .door_ready_i      (door_ready),
      .door_refuse_i     (door_refuse),
      .door_reason_i     (door_reason),
      .door_number_i     (door_number),
      .abort_o           (abort),
      .flush_o           (flush),
      .start_o           (start),
      .start_mask_o      (start_mask),
      .start_done_i      (start_done),
      .start_error_i     (start_error),
      .start_reason_i    (start_reason),
      .loader_address_i  (loader_address),
      .loader_data_o     (loader_data),
      .hold_o            (hold),
      .ratio_o           (target),
      .slew_o            (slew),
      .hold_limit_o      (hold_limit),
      .step_length_o     (step_length),
      .step_space_o      (step_space),
      .dir_setup_o       (dir_setup),
      .dir_hold_o        (dir_hold),
      .mode_o            (mode)
  );

  // The bits of absent axes and of the sequencer's own faults, which are pulses.
  logic unused;
  assign unused   = &{1'b0, clear_fault[9:Axes]};

  assign status_o = {door_partial, ended, feed_active, path_active, direct, busy};

  // Commands.
  logic [15:0] halfword;
  logic        geometry_write;
  logic        geometry_commit;
  logic        geometry_read;
  logic        geometry_empty;
  logic [15:0] geometry_word;
  logic        feed_write;
  logic        feed_commit;
  logic        feed_read;
  logic        feed_empty;
  logic [15:0] feed_word;
  logic        drop;

  command_door #(
      .Axes(Axes)
  ) door (
      .clk_i,
      .rst_i            (rst_q),
      .write_i          (stream_write),
      .word_i           (stream_word),
      .flush_i          (flush),
      .clear_i          (abort),
      .geometry_room_i  (geometry_room_o),
      .feed_room_i      (feed_room_o),
      .ready_o          (door_ready),
      .done_o           (),
      .error_o          (),
      .halfword_o       (halfword),
      .geometry_write_o (geometry_write),
      .feed_write_o     (feed_write),
      .geometry_commit_o(geometry_commit),
      .feed_commit_o    (feed_commit),
      .drop_o           (drop),
      .refuse_o         (door_refuse),
      .reason_o         (door_reason),
      .number_o         (door_number),
      .partial_o        (door_partial)
  );

  halfword_queue #(
      .Depth(GeometryDepth)
  ) geometry_queue (
      .clk_i,
      .rst_i(rst_q),
      .clear_i(abort),
      .write_i(geometry_write),
      .word_i(halfword),
      .commit_i(geometry_commit),
      .drop_i(drop),
      .read_i(geometry_read),
      .word_o(geometry_word),
      .empty_o(geometry_empty),
      .room_o(geometry_room_o)
  );

  halfword_queue #(
      .Depth(FeedDepth)
  ) feed_queue (
      .clk_i,
      .rst_i(rst_q),
      .clear_i(abort),
      .write_i(feed_write),
      .word_i(halfword),
      .commit_i(feed_commit),
      .drop_i(drop),
      .read_i(feed_read),
      .word_o(feed_word),
      .empty_o(feed_empty),
      .room_o(feed_room_o)
  );

  motion_core #(
      .Axes(Axes)
  ) motion (
      .clk_i,
      .rst_i           (rst_q),
      .abort_i         (abort),
      .geometry_empty_i(geometry_empty),
      .geometry_word_i (geometry_word),
      .geometry_read_o (geometry_read),
      .feed_empty_i    (feed_empty),
      .feed_word_i     (feed_word),
      .feed_read_o     (feed_read),
      .start_i         (start),
      .start_mask_i    (start_mask),
      .start_done_o    (start_done),
      .start_error_o   (start_error),
      .start_reason_o  (start_reason),
      .loader_address_o(loader_address),
      .loader_data_i   (loader_data),
      .hold_i          (hold),
      .target_i        (target),
      .slew_i          (slew),
      .hold_limit_i    (hold_limit),
      .step_length_i   (step_length),
      .step_space_i    (step_space),
      .dir_setup_i     (dir_setup),
      .dir_hold_i      (dir_hold),
      .mode_i          (mode),
      .fault_i         (fault_o),
      .clear_fault_i   (clear_fault[Axes-1:0]),
      .step_fault_o    (step_fault),
      .fault_o         (sequencer_fault),
      .busy_o          (busy),
      .direct_o        (direct),
      .path_active_o   (path_active),
      .feed_active_o   (feed_active),
      .ended_o         (ended),
      .running_o,
      .ratio_o,
      .rate_o,
      .tick_o,
      .path_tick_o,
      .path_swap_o,
      .feed_swap_o,
      .path_step_o,
      .path_dir_o,
      .position_o,
      .step_o,
      .dir_o
  );
endmodule
`default_nettype wire
