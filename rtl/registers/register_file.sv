// The card's registers: takes an access, judges it by the register map, acts and answers.
//
// An access is {port, write, partial, address, data} and stands still from request_i to ack_o.
// Latencies: docs/developer/architecture.md.
`default_nettype none
module register_file #(
    parameter int          Axes    = 4,  // 1 to 8
    parameter int          Ports   = 1,  // 1 to 4
    parameter logic [31:0] Engines = '1  // what is built in, as the register ENGINES shows it
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [511:0] constants_i,  // what parameters and straps decide, by address
    input wire logic [2*Axes-1:0] idle_level_i,
    // the access
    input wire logic request_i,
    input wire logic [47:0] access_i,
    output logic ack_o,
    output logic error_o,
    output logic [31:0] data_o,  // combinational
    output logic irq_o,
    // the card's state
    input wire logic [5:0] motion_i,  // {stopping, ended, feed active, path active, direct, busy}
    input wire logic held_i,
    input wire logic [65:0] late_i,  // {a line goes on beyond its period, ticks; held for under-run, how often}
    input wire logic [31:0] fault_i,
    input wire logic [31:0] room_i,  // {geometry, feed}
    input wire logic [1:0] low_i,  // {feed, geometry}: below their watermarks
    input wire logic [63:0] begun_i,  // {geometry, feed}
    input wire logic [66:0] io_i,  // {waiting, probe missed, probed, marks, outputs, inputs}
    output logic [31:0] status_o,  // combinational; refused is any port's
    // what writes do
    output logic [40:0] setting_o,  // {set, address, data}
    output logic [31:0] clear_fault_o,
    output logic abort_o,
    output logic probe_clear_o,
    output logic flush_o,  // combinational
    // the command checker
    output logic stream_write_o,
    input wire logic [18:0] checker_i,  // {partial, ready, refuse, number, reason}
    // the direct loader
    output logic start_o,
    input wire logic [9:0] start_answer_i,  // {done, error, reason}
    input wire logic [7:0] loader_address_i,
    output logic [31:0] loader_data_o,
    // snapshots
    input wire logic stop_i,
    input wire logic probe_i,
    input wire logic mark_i,
    output logic [1:0] snapshot_o,  // {shift, strobe}
    output logic [31:0] chain_o,  // the far end
    input wire logic [31:0] chain_i
);

  logic        live;
  logic        sample;
  logic        read;
  logic        clear_refusal;
  logic        refuse;
  logic [15:0] reason;  // {number, reason}
  logic        snapshot;
  logic        active;
  logic [40:0] store;
  logic [ 7:0] clocks;
  logic        writing;
  logic [31:0] live_data;

  register_access #(
      .Axes(Axes),
      .Engines(Engines)
  ) i_access (
      .clk_i,
      .rst_i,
      .request_i,
      .access_i,
      .ack_o,
      .error_o,
      .writing_i(writing || active),
      .direct_i(motion_i[1]),
      .live_o(live),
      .sample_o(sample),
      .read_o(read),
      .setting_o,
      .clear_fault_o,
      .clear_refusal_o(clear_refusal),
      .snapshot_o(snapshot),
      .abort_o,
      .probe_clear_o,
      .flush_o,
      .stream_write_o,
      .checker_i,
      .start_o,
      .start_answer_i,
      .refuse_o(refuse),
      .reason_o(reason)
  );

  register_live #(
      .Ports  (Ports),
      .Engines(Engines)
  ) i_live (
      .clk_i,
      .rst_i,
      .setting_i(setting_o),
      .snapshot_i(snapshot_o),
      .sample_i(sample),
      .access_i({access_i[47:46], access_i[43:32]}),
      .clear_refusal_i(clear_refusal),
      .refuse_i(refuse),
      .reason_i(reason),
      .motion_i,
      .held_i,
      .late_i,
      .snapshotting_i(active),
      .incomplete_i(checker_i[18]),
      .low_i,
      .fault_i,
      .room_i,
      .begun_i,
      .io_i,
      .status_o,
      .data_o(live_data),
      .chain_o,
      .irq_o
  );

  snapshot_writer #(
      .Axes(Axes)
  ) i_snapshot (
      .clk_i,
      .rst_i,
      .host_i  (snapshot),
      .stop_i,
      .probe_i,
      .mark_i,
      .chain_i,
      .snapshot_o,
      .active_o(active),
      .clocks_o(clocks),
      .store_o (store)
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
      .snapshot_i(store),
      .clocks_i(clocks),
      .address_i(loading_q ? loader_address_i : access_i[41:34]),
      .writing_o(writing),
      .data_o(loader_data_o)
  );

  assign data_o = !read ? '0 : live ? live_data : loader_data_o;

endmodule
`default_nettype wire
