// Decodes the next feed piece onto the feed load. Acceleration and jerk have no shadow in the generator: while a piece
// runs, they follow when the next one has begun. The condition of WAIT_INPUT goes to a target that no block reads,
// since the geometry decoder has it, too.
`default_nettype none

module feed_decoder #(
    parameter logic [31:0] Engines = '1  // built-in engines: bits card_map_pkg::ENGINE_*
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic pop_i,
    input wire logic active_i,  // a piece runs
    input wire logic empty_i,
    input wire logic [15:0] word_i,
    output logic read_o,
    output logic [feed_load_pkg::WIDTH-1:0] load_o,
    output logic piece_o,
    output logic [1:0] class_o,  // class of the piece
    output logic silent_o,  // the ticks of the piece make no steps
    output logic [1:0] slew_shift_o,  // doublings of SLEW in the piece
    output logic barrier_o,
    output logic probe_end_o,
    output logic idle_o,
    output logic valid_o
);
  logic [4:0] field;
  logic       of_count;  // word_i is of the count
  logic       of_field;  // word_i is of a field
  logic [4:0] which;  // the field of word_i
  logic [7:0] opcode;
  logic [7:0] mask;
  logic       is_feed;
  logic       is_wait;
  logic       pause;

  assign is_feed = opcode == card_map_pkg::OP_FEED;
  assign is_wait = Engines[card_map_pkg::ENGINE_PATH_COMMANDS] && opcode == card_map_pkg::OP_WAIT_INPUT;
  assign class_o = mask[1:0];
  assign slew_shift_o = mask[4:3];
  assign silent_o = (mask & 8'(card_map_pkg::PIECE_SILENT)) != 8'd0;

  assign pause = active_i && field[2:0] == load_target_pkg::FEED_STOP_DISTANCE;

  // Fields have the numbers of the feed load's targets, in the same order.
  function automatic logic [2:0] length_of(input logic [2:0] target);  // halfwords, less one
    length_of = (target == load_target_pkg::FEED_FLOOR || target == load_target_pkg::FEED_STOP_DISTANCE) ? 3'd1 : 3'd3;
  endfunction

  command_fetch fetch (
      .clk_i,
      .rst_i,
      .cut_i,
      .pop_i,
      .empty_i,
      .word_i,
      .read_o,
      .has_payload_i(is_feed || is_wait),
      .first_field_i({2'd0, is_wait ? load_target_pkg::FEED_NOWHERE : load_target_pkg::FEED_RATE}),
      .first_length_i(is_wait ? 3'd0 : 3'd3),
      .next_field_i(field + 5'd1),
      .next_length_i(length_of(field[2:0] + 3'd1)),
      .last_field_i(pause || is_wait || field[2:0] == load_target_pkg::FEED_JERK),
      .rest_i(is_feed && field[2:0] == load_target_pkg::FEED_ACCELERATION),
      .wait_i(1'b0),
      .header_o(),
      .first_o(),
      .advance_o(),
      .field_o(field),
      .of_count_o(of_count),
      .of_field_o(of_field),
      .which_o(which),
      .opcode_o(opcode),
      .mask_o(mask),
      .idle_o,
      .valid_o
  );

  always_ff @(posedge clk_i) begin
    load_o <= feed_load_pkg::pack(
        (of_count || of_field) && !rst_i, of_count ? load_target_pkg::FEED_TICKS : which[2:0], word_i
    );
    piece_o <= is_feed;
    barrier_o <= !is_feed;
    probe_end_o <= Engines[card_map_pkg::ENGINE_PATH_COMMANDS] && opcode == card_map_pkg::OP_PROBE_END;
  end

  logic unused;
  assign unused = &{1'b0, which[4:3], mask[7:5]};
endmodule

`default_nettype wire
