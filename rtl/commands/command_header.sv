// Judges a command's first word, and keeps the values that the rest of the command needs: opcode, mask, number, size.
//
// The bits of phase_i are high in turn, one clock each, with the header's halfword 0 (phases 0 and 1) and 1 (2 and 3)
// on halfword_i. The verdict is valid from the clock after the last phase to the next header. If several checks fail,
// the reason is that of the first in this order: opcode, mask, length, number, room.
`default_nettype none
module command_header #(
    parameter int Axes = 4,  // 1 to 8
    parameter logic [31:0] Engines = '1
) (
    input wire logic clk_i,
    input wire logic restart_i,
    input wire logic [3:0] phase_i,
    input wire logic accept_i,  // the command is committed: the next number is expected
    input wire logic [15:0] halfword_i,
    input wire logic [15:0] geometry_room_i,
    input wire logic [15:0] feed_room_i,
    output logic [7:0] op_o,
    output logic [7:0] mask_o,
    output logic [7:0] number_o,
    output logic to_geometry_o,
    output logic to_feed_o,
    output logic [5:0] stored_o,  // halfwords in the queue: at most 50, for ARC_CHORD
    output logic bad_o,
    output logic [7:0] reason_o
);

  localparam logic [7:0] ABSENT_AXES = 8'(9'h1FE << (Axes - 1));

  logic [3:0] moving_q;
  logic [5:0] base_q;
  logic [5:0] per_axis_q;
  logic [7:0] expected_q;
  logic unknown_q;
  logic mask_bad_q;
  logic length_bad_q;
  logic number_bad_q;
  logic geometry_full_q;
  logic feed_full_q;

  function automatic logic [3:0] ones(input logic [7:0] mask);
    ones = {3'b0, mask[0]};
    for (int i = 1; i < 8; i++) ones = ones + {3'b0, mask[i]};
  endfunction

  always_ff @(posedge clk_i) begin : p_header
    logic mask_bad;
    logic [5:0] base;
    logic [1:0] axes_in_base;
    logic [5:0] per_axis;

    if (phase_i[0]) {mask_o, op_o} <= halfword_i;
    if (phase_i[1]) begin
      unknown_q <= !card_map_pkg::command_known(op_o, Engines);
      to_geometry_o <= card_map_pkg::command_to_geometry(op_o, Engines);
      to_feed_o <= card_map_pkg::command_to_feed(op_o, Engines);
      // The fixed part of the command contains some of the axes in the mask.
      base = card_map_pkg::command_base_halfwords(op_o, Engines);
      axes_in_base = card_map_pkg::command_axes_in_base(op_o, Engines);
      per_axis = card_map_pkg::command_halfwords_per_axis(op_o, Engines);
      base_q <= base - 6'd1 - 6'(axes_in_base * per_axis);
      per_axis_q <= per_axis;
      moving_q <= ones(mask_o);
    end
    if (phase_i[2]) begin
      mask_bad = (mask_o & ABSENT_AXES) != 8'd0;
      case (card_map_pkg::command_mask_rule(
          op_o, Engines
      ))
        card_map_pkg::MASK_RULE_ANY: mask_bad = mask_bad || moving_q == 4'd0;
        card_map_pkg::MASK_RULE_PLANE: mask_bad = mask_bad || moving_q != 4'd2;
        card_map_pkg::MASK_RULE_PLANE_AND_AXES: mask_bad = mask_bad || moving_q < 4'd2;
        card_map_pkg::MASK_RULE_FLAGS: mask_bad = !card_map_pkg::command_flags_good(op_o, mask_o, Engines);
        default: mask_bad = moving_q != 4'd0;
      endcase
      mask_bad_q <= mask_bad;
      // Halfword 1 is not stored, which also rounds: the words after the first are stored / 2, rounded down.
      stored_o   <= base_q + 6'(per_axis_q * moving_q);
    end
    if (phase_i[3]) begin
      length_bad_q <= halfword_i[7:0] != {3'b0, stored_o[5:1]} + 8'd1;
      number_bad_q <= number_o != expected_q;
      geometry_full_q <= to_geometry_o && geometry_room_i < {10'b0, stored_o};
      feed_full_q <= to_feed_o && feed_room_i < {10'b0, stored_o};
    end
  end

  always_ff @(posedge clk_i) begin
    if (restart_i) begin
      number_o   <= 8'd0;
      expected_q <= 8'd0;
    end else begin
      if (phase_i[2]) number_o <= halfword_i[15:8];
      if (accept_i) expected_q <= expected_q + 8'd1;
    end
  end

  always_comb begin
    bad_o = 1'b1;
    if (unknown_q) reason_o = card_map_pkg::REFUSE_UNKNOWN_OPCODE;
    else if (mask_bad_q) reason_o = card_map_pkg::REFUSE_BAD_MASK;
    else if (length_bad_q) reason_o = card_map_pkg::REFUSE_BAD_LENGTH;
    else if (number_bad_q) reason_o = card_map_pkg::REFUSE_BAD_NUMBER;
    else begin
      reason_o = card_map_pkg::REFUSE_NO_ROOM;
      bad_o = geometry_full_q || feed_full_q;
    end
  end

endmodule
`default_nettype wire
