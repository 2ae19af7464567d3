// Decodes the next feed piece onto the feed generator's load bus, and its ticks into the count chain.
`default_nettype none

module feed_fetch (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic        clear_i,
    input  wire logic        pop_i,
    input  wire logic        empty_i,
    input  wire logic [15:0] word_i,
    output logic             read_o,
    output logic      [15:0] load_word_o,
    output logic             load_count_o,
    output logic      [ 3:0] load_o,        // {floor, jerk, acceleration, rate}
    output logic             piece_o,
    output logic             barrier_o,
    output logic             idle_o,
    output logic             valid_o
);
  // Fields in the order of the stream. The stop distance is 0 until the under-run hold is built.
  localparam logic [3:0] RATE = 4'd0;
  localparam logic [3:0] ACCELERATION = 4'd1;
  localparam logic [3:0] JERK = 4'd2;
  localparam logic [3:0] FLOOR = 4'd3;
  localparam logic [3:0] STOP_DISTANCE = 4'd4;

  logic [3:0] field;
  logic       count_strobe;
  logic       field_strobe;
  logic [3:0] strobe_field;
  logic [7:0] opcode;
  logic       is_feed;

  assign is_feed = opcode == card_map_pkg::OP_FEED;

  command_fetch fetch (
      .clk_i,
      .rst_i,
      .clear_i,
      .pop_i,
      .empty_i,
      .word_i,
      .read_o,
      .has_payload_i  (is_feed),
      .payload_ready_i(1'b1),
      .first_field_i  (RATE),
      .first_length_i (3'd3),
      .next_field_i   (field + 4'd1),
      .next_length_i  ((field == RATE || field == ACCELERATION) ? 3'd3 : 3'd1),
      .last_field_i   (field == STOP_DISTANCE),
      .header_o       (),
      .first_o        (),
      .advance_o      (),
      .field_o        (field),
      .count_strobe_o (count_strobe),
      .field_strobe_o (field_strobe),
      .strobe_field_o (strobe_field),
      .opcode_o       (opcode),
      .mask_o         (),
      .idle_o,
      .valid_o
  );

  always_ff @(posedge clk_i) begin
    load_word_o  <= word_i;
    load_count_o <= count_strobe;
    load_o[0]    <= field_strobe & (strobe_field == RATE);
    load_o[1]    <= field_strobe & (strobe_field == ACCELERATION);
    load_o[2]    <= field_strobe & (strobe_field == JERK);
    load_o[3]    <= field_strobe & (strobe_field == FLOOR);
    piece_o      <= is_feed;
    barrier_o    <= ~is_feed;
  end
endmodule

`default_nettype wire
