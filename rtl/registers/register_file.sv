// The card's registers: takes an access, judges it by the register map, acts and answers.
//
// An access is {port, write, partial, address, data} and stands still from request_i to ack_o. What a write does goes
// out in the clock of its ack_o; a flush a clock before, so that its refusal finds the access that asked for it.
// Latencies: docs/developer/architecture.md.
`default_nettype none
module register_file #(
    parameter int          Axes    = 4,  // 1 to 8
    parameter int          Ports   = 1,  // 1 to 4
    parameter logic [31:0] Engines = '1  // what is built in, as the register ENGINES shows it
) (
    input  wire logic              clk_i,
    input  wire logic              rst_i,
    input  wire logic [     511:0] constants_i,       // what parameters and straps decide, by address
    input  wire logic [2*Axes-1:0] idle_level_i,
    // the access
    input  wire logic              request_i,
    input  wire logic [      47:0] access_i,
    output logic                   ack_o,
    output logic                   error_o,
    output logic      [      31:0] data_o,            // combinational
    output logic                   irq_o,
    // the card's state
    input  wire logic [       5:0] motion_i,          // {stopping, ended, feed active, path active, direct, busy}
    input  wire logic              held_i,
    input  wire logic [      31:0] fault_i,
    input  wire logic [      31:0] room_i,            // {geometry, feed}
    input  wire logic [      63:0] begun_i,           // {geometry, feed}
    output logic      [      31:0] status_o,          // combinational; refused is any port's
    // what writes do
    output logic      [      40:0] setting_o,         // {set, address, data}
    output logic      [      31:0] clear_fault_o,
    output logic                   abort_o,
    output logic                   flush_o,           // combinational
    // the command checker
    output logic                   stream_write_o,
    input  wire logic [      18:0] checker_i,         // {partial, ready, refuse, number, reason}
    // the direct loader
    output logic                   start_o,
    input  wire logic [       9:0] start_answer_i,    // {done, error, reason}
    input  wire logic [       7:0] loader_address_i,
    output logic      [      31:0] loader_data_o,
    // snapshots
    input  wire logic              stop_i,
    output logic      [       1:0] snapshot_o,        // {shift, strobe}
    output logic      [      31:0] chain_o,           // the far end
    input  wire logic [      31:0] chain_i
);

  logic [ 1:0] asking;
  logic [31:0] data;
  logic        judge;
  logic        act;
  logic        sample;
  logic        read;
  logic        refuse;
  logic [ 7:0] refuse_reason;
  logic        live;
  logic [ 6:0] target;  // {flush, start, stream, refusal, fault, control, setting}
  logic [ 8:0] verdict;  // {good, reason}
  logic        writing;
  logic        snapshotting;

  assign asking = access_i[47:46];
  assign data   = access_i[31:0];

  register_access i_access (
      .clk_i,
      .rst_i,
      .request_i,
      .write_i(access_i[45]),
      .ack_o,
      .error_o,
      .read_o(read),
      .judge_o(judge),
      .wait_i((writing || snapshotting) && (access_i[45] || !live)),
      .verdict_i(verdict),
      .stream_i(target[4]),
      .start_i(target[5]),
      .act_o(act),
      .sample_o(sample),
      .stream_write_o,
      .checker_ready_i(checker_i[17]),
      .checker_refuse_i(checker_i[16]),
      .start_o,
      .start_answer_i,
      .refuse_o(refuse),
      .reason_o(refuse_reason)
  );

  // The stream belongs to a port from a command's first word to its last.
  logic [1:0] owner_q;

  always_ff @(posedge clk_i) begin
    if (stream_write_o) owner_q <= asking;
    if (rst_i) owner_q <= 2'd0;
  end

  register_decode #(
      .Axes(Axes),
      .Engines(Engines)
  ) i_decode (
      .clk_i,
      .judge_i(judge),
      .access_i(access_i[45:0]),
      .busy_i(motion_i[1] || (checker_i[18] && owner_q != asking)),
      .live_o(live),
      .target_o(target),
      .verdict_o(verdict)
  );

  // What a write does, in the clock of its answer.
  logic set_q;
  logic snapshot_q;
  logic control;

  assign control = act && target[1];

  always_ff @(posedge clk_i) begin
    set_q <= act && target[0];
    snapshot_q <= control && data[card_map_pkg::BIT_CONTROL_SNAPSHOT];
    abort_o <= control && data[card_map_pkg::BIT_CONTROL_ABORT];
    clear_fault_o <= act && target[2] ? data : '0;
    if (rst_i) begin
      set_q <= 1'b0;
      snapshot_q <= 1'b0;
      abort_o <= 1'b0;
      clear_fault_o <= '0;
    end
  end

  assign setting_o = {set_q, access_i[41:34], data};
  assign flush_o   = act && target[6];

  logic        any_refused;
  logic        refused;
  logic [27:0] refused_what;
  logic [31:0] live_data;

  refusal_latch #(
      .Ports(Ports)
  ) i_refusal (
      .clk_i,
      .rst_i,
      .port_i(asking),
      .address_i(access_i[43:32]),
      .clear_i(act && target[3]),
      .refuse_i(refuse),
      .reason_i(refuse_reason),
      .checker_refuse_i(checker_i[16]),
      .checker_reason_i(checker_i[15:0]),
      .any_refused_o(any_refused),
      .refused_o(refused),
      .refusal_o(refused_what)
  );

  register_live i_live (
      .clk_i,
      .rst_i,
      .setting_i(setting_o),
      .snapshot_i(snapshot_o),
      .sample_i(sample),
      .word_i(access_i[36:34]),
      .motion_i,
      .held_i,
      .any_refused_i(any_refused),
      .refused_i(refused),
      .snapshotting_i(snapshotting),
      .incomplete_i(checker_i[18]),
      .fault_i,
      .refusal_i(refused_what),
      .room_i,
      .begun_i,
      .status_o,
      .data_o(live_data),
      .chain_o,
      .irq_o
  );

  logic [40:0] latched;
  logic [63:0] now;

  time_counter i_time (
      .clk_i,
      .rst_i,
      .time_o(now)
  );

  snapshot_writer #(
      .Axes(Axes)
  ) i_snapshot (
      .clk_i,
      .rst_i,
      .host_i  (snapshot_q),
      .stop_i,
      .chain_i,
      .snapshot_o,
      .active_o(snapshotting),
      .time_i  (now),
      .store_o (latched)
  );

  // The direct loader owns the RAM's read side from its start to its end; the START write waits all the while.
  logic loading_q;

  always_ff @(posedge clk_i) begin
    loading_q <= (loading_q || start_o) && !start_answer_i[9];
    if (rst_i) loading_q <= 1'b0;
  end

  register_ram #(
      .Axes(Axes)
  ) i_ram (
      .clk_i,
      .rst_i,
      .constants_i,
      .idle_level_i,
      .setting_i(setting_o),
      .snapshot_i(latched),
      .sweep_i(now[7:0]),
      .address_i(loading_q ? loader_address_i : access_i[41:34]),
      .writing_o(writing),
      .data_o(loader_data_o)
  );

  assign data_o = !read ? '0 : live ? live_data : loader_data_o;

endmodule
`default_nettype wire
