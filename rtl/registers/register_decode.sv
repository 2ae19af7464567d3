`default_nettype none

// Judges an access by the register map. The access must stand still while judge_i is high: kind_o and what the access
// aims at are valid one clock after it stands, reason_o and good_o two clocks after. direct_i is looked at in the last
// clock of judge_i. All of it is kept until the next one: nothing moves between accesses.
module register_decode #(
    parameter int Axes = 4
) (
    input  wire logic        clk_i,
    input  wire logic        judge_i,
    input  wire logic        write_i,
    input  wire logic        partial_i,
    input  wire logic [11:0] address_i,
    input  wire logic [31:0] data_i,
    input  wire logic        direct_i,
    output logic      [ 2:0] kind_o,
    output logic             control_o,
    output logic             fault_o,
    output logic             refusal_o,
    output logic             stream_o,
    output logic             start_o,
    output logic             good_o,
    output logic      [ 7:0] reason_o
);

  localparam logic [3:0] AXIS_COUNT = 4'(Axes);

  logic [9:0] word;

  assign word = address_i[11:2];

  logic [2:0] kind_q;
  logic       absent_q;
  logic [3:0] stray_q;  // bytes with bits that must be 0
  logic       in_limits_q;
  logic       control_q;
  logic       fault_q;
  logic       refusal_q;
  logic       stream_q;
  logic       start_q;

  always_ff @(posedge clk_i) begin : p_decode
    logic        only_present;
    logic [ 2:0] axis;
    logic [31:0] mask;

    if (judge_i) begin
      mask = card_map_pkg::register_mask(word);
      only_present = card_map_pkg::register_only_present_axes(word);
      axis = card_map_pkg::register_axis(word);
      kind_q   <= card_map_pkg::register_access(word);
      absent_q <= address_i[1:0] != 2'd0 || (only_present && {1'b0, axis} >= AXIS_COUNT);
      for (int b = 0; b < 4; b++) stray_q[b] <= (data_i[8*b+:8] & ~mask[8*b+:8]) != 8'd0;
      in_limits_q <= card_map_pkg::register_in_limits(word, data_i);
      control_q <= word == card_map_pkg::ADDR_CONTROL[11:2];
      fault_q <= word == card_map_pkg::ADDR_FAULT[11:2];
      refusal_q <= word == card_map_pkg::ADDR_REFUSAL[11:2] && data_i != 32'd0;
      stream_q <= word == card_map_pkg::ADDR_STREAM[11:2];
      start_q <= word == card_map_pkg::ADDR_START[11:2];
    end
  end

  logic       read_only;
  logic [7:0] reason_q;
  logic       good_q;

  assign read_only = kind_q == card_map_pkg::ACCESS_CONSTANT || kind_q == card_map_pkg::ACCESS_LIVE ||
      kind_q == card_map_pkg::ACCESS_SNAPSHOT;

  always_ff @(posedge clk_i) begin
    if (judge_i) begin
      good_q <= 1'b0;
      if (kind_q == card_map_pkg::ACCESS_NONE || absent_q) begin
        reason_q <= card_map_pkg::REFUSE_UNKNOWN_ADDRESS;
      end else if (!write_i && kind_q == card_map_pkg::ACCESS_COMMAND) begin
        reason_q <= card_map_pkg::REFUSE_WRITE_ONLY;
      end else if (write_i && read_only) begin
        reason_q <= card_map_pkg::REFUSE_READ_ONLY;
      end else if (write_i && partial_i) begin
        reason_q <= card_map_pkg::REFUSE_PARTIAL_WRITE;
      end else if (write_i && (stray_q != 4'd0 || !in_limits_q)) begin
        reason_q <= card_map_pkg::REFUSE_BAD_VALUE;
      end else if (write_i && stream_q && direct_i) begin
        reason_q <= card_map_pkg::REFUSE_BUSY;
      end else begin
        reason_q <= card_map_pkg::REFUSE_NONE;
        good_q   <= 1'b1;
      end
    end
  end

  assign kind_o = kind_q;
  assign control_o = control_q;
  assign fault_o = fault_q;
  assign refusal_o = refusal_q;
  assign stream_o = stream_q;
  assign start_o = start_q;
  assign good_o = good_q;
  assign reason_o = reason_q;

endmodule

`default_nettype wire
