// Judges an access by the register map. The access stands still while judge_i is high: live_o and target_o are valid one
// clock after it stands, verdict_o two clocks after. busy_i is looked at in the last clock of judge_i. All of it is kept
// until the next access: nothing moves in between.
`default_nettype none
module register_decode #(
    parameter int Axes = 4,
    parameter logic [31:0] Engines = '1  // what is built in, as the register ENGINES shows it
) (
    input  wire logic        clk_i,
    input  wire logic        judge_i,
    input  wire logic [45:0] access_i,  // {write, partial, address, data}
    input  wire logic        busy_i,    // the stream is not for this port, or not now
    output logic             live_o,    // reads as the card stands
    output logic      [ 6:0] target_o,  // {flush, start, stream, refusal and ones to clear, fault, control, setting}
    output logic      [ 8:0] verdict_o  // {good, reason}
);

  localparam logic [3:0] AXIS_COUNT = 4'(Axes);

  logic       write;
  logic       partial;
  logic [9:0] word;
  logic [2:0] access_q;
  logic       absent_q;
  logic [3:0] stray_q;  // bytes with bits that must be 0
  logic       in_limits_q;
  logic       flush_q;
  logic       start_q;
  logic       stream_q;
  logic       refusal_q;
  logic       fault_q;
  logic       control_q;

  assign write   = access_i[45];
  assign partial = access_i[44];
  assign word    = access_i[43:34];

  always_ff @(posedge clk_i) begin : p_decode
    logic        only_present;
    logic [ 2:0] axis;
    logic [31:0] mask;
    logic [31:0] data;

    if (judge_i) begin
      data = access_i[31:0];
      mask = card_map_pkg::register_mask(word, Engines);
      only_present = card_map_pkg::register_only_present_axes(word);
      axis = card_map_pkg::register_axis(word);
      access_q <= card_map_pkg::register_access(word, Engines);
      absent_q <= access_i[33:32] != 2'd0 || (only_present && {1'b0, axis} >= AXIS_COUNT);
      for (int b = 0; b < 4; b++) stray_q[b] <= (data[8*b+:8] & ~mask[8*b+:8]) != 8'd0;
      in_limits_q <= card_map_pkg::register_in_limits(word, data);
      control_q <= word == card_map_pkg::ADDR_CONTROL[11:2];
      // An abort beside it does more than a flush.
      flush_q <= word == card_map_pkg::ADDR_CONTROL[11:2] && data[card_map_pkg::BIT_CONTROL_FLUSH] &&
          !data[card_map_pkg::BIT_CONTROL_ABORT];
      fault_q <= word == card_map_pkg::ADDR_FAULT[11:2];
      refusal_q <= word == card_map_pkg::ADDR_REFUSAL[11:2] && data != 32'd0;
      stream_q <= word == card_map_pkg::ADDR_STREAM[11:2];
      start_q <= word == card_map_pkg::ADDR_START[11:2] && Engines[card_map_pkg::ENGINE_DIRECT_MODE];
    end
  end

  assign live_o = !absent_q && (access_q == card_map_pkg::ACCESS_LIVE || access_q == card_map_pkg::ACCESS_CLEAR_ONES);
  assign target_o = {
    flush_q, start_q, stream_q, refusal_q, fault_q, control_q, access_q == card_map_pkg::ACCESS_SETTING
  };

  logic read_only;

  assign read_only = access_q == card_map_pkg::ACCESS_CONSTANT || access_q == card_map_pkg::ACCESS_LIVE ||
      access_q == card_map_pkg::ACCESS_SNAPSHOT;

  always_ff @(posedge clk_i) begin
    if (judge_i) begin
      verdict_o <= {1'b0, card_map_pkg::REFUSE_NONE};
      if (access_q == card_map_pkg::ACCESS_NONE || absent_q) begin
        verdict_o[7:0] <= card_map_pkg::REFUSE_UNKNOWN_ADDRESS;
      end else if (!write && access_q == card_map_pkg::ACCESS_COMMAND) begin
        verdict_o[7:0] <= card_map_pkg::REFUSE_WRITE_ONLY;
      end else if (write && read_only) begin
        verdict_o[7:0] <= card_map_pkg::REFUSE_READ_ONLY;
      end else if (write && partial) begin
        verdict_o[7:0] <= card_map_pkg::REFUSE_PARTIAL_WRITE;
      end else if (write && (stray_q != 4'd0 || !in_limits_q)) begin
        verdict_o[7:0] <= card_map_pkg::REFUSE_BAD_VALUE;
      end else if (write && stream_q && busy_i) begin
        verdict_o[7:0] <= card_map_pkg::REFUSE_BUSY;
      end else begin
        verdict_o[8] <= 1'b1;
      end
    end
  end

endmodule
`default_nettype wire
