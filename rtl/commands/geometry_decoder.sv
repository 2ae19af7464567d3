// Decodes the next geometry command onto the load bus: a line's increments to the axes, an arc's state to the
// prescaler and the deviation accumulator, the count to the count chain.
//
// The accumulator has no second set of registers: an arc's payload waits until no arc runs.
`default_nettype none

module geometry_fetch #(
    parameter int Axes = 4
) (
    input  wire logic            clk_i,
    input  wire logic            rst_i,
    input  wire logic            clear_i,
    input  wire logic            pop_i,
    input  wire logic            arc_busy_i,
    input  wire logic            empty_i,
    input  wire logic [    15:0] word_i,
    output logic                 read_o,
    // direct loader, while nothing is decoded
    input  wire logic [    15:0] direct_word_i,
    input  wire logic [     2:0] direct_axis_i,
    input  wire logic            direct_increment_i,  // the word belongs to the axis's increment
    input  wire logic            direct_steps_i,      // to the axis's count of steps
    input  wire logic            direct_length_i,     // to the count of ticks
    // load bus
    output logic      [    15:0] load_word_o,
    output logic                 load_count_o,
    output logic      [Axes-1:0] load_increment_o,
    output logic      [Axes-1:0] load_steps_o,
    output logic                 load_prescale_o,
    output logic      [     8:0] load_deviation_o,
    // the decoded command
    output logic      [Axes-1:0] mask_o,
    output logic                 line_o,
    output logic                 arc_o,
    output logic                 barrier_o,
    output logic                 end_o,
    output logic                 idle_o,
    output logic                 valid_o
);
  // Fields of an arc in the order of the stream; a line's fields are its axes.
  localparam logic [3:0] PRESCALE = 4'd1;
  localparam logic [3:0] PLANE = 4'd2;
  localparam logic [3:0] QUADRANTS = 4'd3;
  localparam logic [3:0] END_X = 4'd4;
  localparam logic [3:0] END_Y = 4'd5;
  localparam logic [3:0] DEVIATION = 4'd6;
  localparam logic [3:0] GRADIENT_X = 4'd7;
  localparam logic [3:0] GRADIENT_Y = 4'd8;
  localparam logic [3:0] HALF_X = 4'd9;
  localparam logic [3:0] HALF_Y = 4'd10;

  logic       first;
  logic       advance;
  logic [3:0] field;
  logic [3:0] first_field;
  logic [3:0] next_field;
  logic [3:0] lowest;
  logic       header;
  logic [2:0] next_length;
  logic       last_field;
  logic       count_strobe;
  logic       field_strobe;
  logic [3:0] strobe_field;
  logic [7:0] opcode;
  logic [7:0] mask;
  logic       is_arc;
  logic       is_path;
  logic [7:0] rest_q;  // axes of the mask whose increments are still to come

  assign is_arc = opcode == card_map_pkg::OP_ARC;
  assign mask_o = mask[Axes-1:0];

  logic unused;  // absent axes: the door lets no command for them in
  assign unused  = &{1'b0, mask};

  assign is_path = is_arc | (opcode == card_map_pkg::OP_LINE);

  function automatic logic [3:0] lowest_axis(input logic [7:0] axes);
    lowest_axis = 4'd7;
    for (int i = 6; i >= 0; i--) if (axes[i]) lowest_axis = 4'(i);
  endfunction

  // Halfwords of an arc's field, less one.
  function automatic logic [2:0] arc_field_length(input logic [3:0] arc_field);
    case (arc_field)
      PLANE, QUADRANTS: arc_field_length = 3'd0;
      END_X, END_Y: arc_field_length = 3'd1;
      DEVIATION, GRADIENT_X, GRADIENT_Y: arc_field_length = 3'd4;
      default: arc_field_length = 3'd2;
    endcase
  endfunction

  // Lines and arcs both begin with a field of three halfwords: the first increment, or the path ticks.
  assign lowest      = lowest_axis(rest_q);
  assign first_field = is_arc ? 4'd0 : lowest;
  assign next_field  = is_arc ? field + 4'd1 : lowest;
  assign next_length = is_arc ? arc_field_length(field + 4'd1) : 3'd2;
  assign last_field  = is_arc ? field == HALF_Y : rest_q == 8'd0;

  always_ff @(posedge clk_i) begin
    if (header) rest_q <= word_i[15:8];
    else if (first | advance) rest_q <= rest_q & (rest_q - 8'd1);
  end

  command_fetch fetch (
      .clk_i,
      .rst_i,
      .clear_i,
      .pop_i,
      .empty_i,
      .word_i,
      .read_o,
      .has_payload_i  (is_path),
      .payload_ready_i(~(is_arc & arc_busy_i)),
      .first_field_i  (first_field),
      .first_length_i (3'd2),
      .next_field_i   (next_field),
      .next_length_i  (next_length),
      .last_field_i   (last_field),
      .header_o       (header),
      .first_o        (first),
      .advance_o      (advance),
      .field_o        (field),
      .count_strobe_o (count_strobe),
      .field_strobe_o (field_strobe),
      .strobe_field_o (strobe_field),
      .opcode_o       (opcode),
      .mask_o         (mask),
      .idle_o,
      .valid_o
  );

  // The path ticks (field 0 of an arc) go nowhere: the prescaler makes exactly as many from its increment.
  always_ff @(posedge clk_i) begin
    load_word_o      <= (direct_increment_i | direct_steps_i | direct_length_i) ? direct_word_i : word_i;
    load_count_o     <= count_strobe | direct_length_i;
    load_increment_o <= '0;
    load_steps_o     <= '0;
    load_prescale_o  <= 1'b0;
    load_deviation_o <= '0;
    if (direct_increment_i | direct_steps_i) begin
      for (int i = 0; i < Axes; i++) begin
        load_increment_o[i] <= direct_increment_i & (direct_axis_i == 3'(i));
        load_steps_o[i] <= direct_steps_i & (direct_axis_i == 3'(i));
      end
    end
    if (field_strobe) begin
      if (~is_arc) begin
        for (int i = 0; i < Axes; i++) load_increment_o[i] <= strobe_field == 4'(i);
      end else begin
        case (strobe_field)
          PRESCALE: load_prescale_o <= 1'b1;
          DEVIATION: load_deviation_o[0] <= 1'b1;
          GRADIENT_X: load_deviation_o[1] <= 1'b1;
          GRADIENT_Y: load_deviation_o[2] <= 1'b1;
          HALF_X: load_deviation_o[3] <= 1'b1;
          HALF_Y: load_deviation_o[4] <= 1'b1;
          END_X: load_deviation_o[5] <= 1'b1;
          END_Y: load_deviation_o[6] <= 1'b1;
          QUADRANTS: load_deviation_o[7] <= 1'b1;
          PLANE: load_deviation_o[8] <= 1'b1;
          default: ;
        endcase
      end
    end

    line_o    <= opcode == card_map_pkg::OP_LINE;
    arc_o     <= is_arc;
    barrier_o <= ~is_path;
    end_o     <= opcode == card_map_pkg::OP_END;
  end
endmodule

`default_nettype wire
