// Judges the halfwords of a command after its header: count, payload fields, padding.
//
// Each halfword takes two clocks with halfword_i held: examine_i, then judge_i. restart_i (high until a header has
// passed) begins a command. op_i must be valid in the judge_i before the first halfword, in which the table is read
// ahead. After a bad halfword the verdict is valid from the clock after its judge_i to the next restart_i.
`default_nettype none
module command_fields #(
    parameter logic [31:0] Engines = '1
) (
    input wire logic clk_i,
    input wire logic restart_i,
    input wire logic examine_i,
    input wire logic judge_i,
    input wire logic read_ahead_i,  // read the table for the next halfword
    input wire logic padding_i,     // the next halfword is padding
    input wire logic [15:0] halfword_i,
    input wire logic [7:0] op_i,
    input wire logic [7:0] mask_i,
    output logic bad_o,
    output logic bad_mask_o    // with bad_o: the plane is bad, it differs from the mask
);

  localparam int FIELD_END = card_map_pkg::CHECK_FIELD_END;
  localparam int NOT_ZERO = card_map_pkg::CHECK_NOT_ZERO;
  localparam int AT_MOST_COUNT = card_map_pkg::CHECK_AT_MOST_COUNT;
  localparam int UNSIGNED_LIMIT = card_map_pkg::CHECK_UNSIGNED_LIMIT;
  localparam int SIGNED_LIMIT = card_map_pkg::CHECK_SIGNED_LIMIT;
  localparam int PLANE = card_map_pkg::CHECK_PLANE;

  // Position of the next halfword, and the table's entry for the present one.
  logic in_count_q;
  logic [5:0] index_q;
  // The part of the payload that is repeated per axis. It is set by the count's halfwords, long before it is used.
  logic [5:0] repeat_from_q;
  logic [5:0] repeat_after_q;
  logic [15:0] allowed_q;
  logic [5:0] checks_q;
  // Findings in the present halfword and, for the same field, in the halfwords below it.
  logic not_allowed_q;
  logic not_zero_q;
  logic below_not_zero_q;
  logic over_limit_q;
  logic over_count_q;
  logic off_plane_q;
  logic [47:0] count_q;

  always_ff @(posedge clk_i) begin
    if (restart_i) begin
      in_count_q <= 1'b1;
      index_q <= 6'd0;
    end else if (examine_i) begin
      index_q <= index_q + 6'd1;
      if (in_count_q && index_q == 6'd2) begin
        in_count_q <= 1'b0;
        index_q <= 6'd0;
      end
      if (!in_count_q && index_q == repeat_after_q) index_q <= repeat_from_q;
    end
    if (examine_i) begin
      repeat_from_q  <= card_map_pkg::command_base_halfwords(op_i, Engines) - 6'd5;
      repeat_after_q <= repeat_from_q + card_map_pkg::command_halfwords_per_axis(op_i, Engines) - 6'd1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (read_ahead_i) begin
      if (padding_i) begin
        allowed_q <= 16'd0;
        checks_q  <= 6'd0;
      end else if (in_count_q) begin
        allowed_q <= {index_q != 6'd2 ? 8'hFF : 8'h00, 8'hFF};
        if (card_map_pkg::command_count_zero(op_i, Engines)) allowed_q <= 16'd0;
        checks_q <= 6'd0;
        checks_q[FIELD_END] <= index_q == 6'd2;
        checks_q[NOT_ZERO] <= index_q == 6'd2 && card_map_pkg::command_count_not_zero(op_i, Engines);
      end else begin
        allowed_q <= card_map_pkg::payload_bits(op_i, index_q, Engines);
        checks_q  <= card_map_pkg::payload_checks(op_i, index_q, Engines);
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (examine_i) begin
      not_allowed_q <= (halfword_i & ~allowed_q) != 16'd0;
      not_zero_q <= halfword_i != 16'd0;
      // For the highest halfword of a field whose limits are +-2^40; the result is not used for other halfwords.
      over_limit_q <= halfword_i[15:8] != 8'h00 && halfword_i[15:8] != 8'hFF &&
                      (halfword_i != 16'h0100 || below_not_zero_q);
      off_plane_q <= !mask_i[halfword_i[6:4]] || !mask_i[halfword_i[10:8]] || halfword_i[6:4] == halfword_i[10:8];
      // Only a first field can have the count as its limit: the count is shifted out beside it, lowest halfword first.
      count_q <= {halfword_i, count_q[47:16]};
    end
  end

  always_ff @(posedge clk_i) begin
    if (restart_i) begin
      below_not_zero_q <= 1'b0;
      over_count_q <= 1'b0;
    end else begin
      if (examine_i) over_count_q <= {count_q[15:0], 1'b0} < {halfword_i, over_count_q};
      if (judge_i) begin
        below_not_zero_q <= (below_not_zero_q || not_zero_q) && !checks_q[FIELD_END];
        if (checks_q[FIELD_END]) over_count_q <= 1'b0;
      end
    end
  end

  always_ff @(posedge clk_i) begin : p_verdict
    logic violated;
    logic violated_mask;

    if (restart_i) begin
      bad_o <= 1'b0;
    end else if (judge_i && !bad_o) begin
      violated = not_allowed_q || (checks_q[NOT_ZERO] && !not_zero_q && !below_not_zero_q) ||
                 (checks_q[FIELD_END] && checks_q[AT_MOST_COUNT] && over_count_q) ||
                 (checks_q[FIELD_END] && (checks_q[UNSIGNED_LIMIT] || checks_q[SIGNED_LIMIT]) && over_limit_q);
      violated_mask = checks_q[PLANE] && off_plane_q;
      bad_o <= violated || violated_mask;
      bad_mask_o <= !violated;
    end
  end

endmodule
`default_nettype wire
