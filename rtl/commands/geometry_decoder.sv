// Decodes the next geometry command onto the load bus: a line's increments go to the axes, an arc's state to the path
// engines, the count to the count chain. The direct loader's halfwords go through the same register.
//
// OUTPUT's masks, the fields of PWM and the conditions of PROBE and WAIT_INPUT go to the path commands.
//
// The engines have no second set of registers: the fields after an arc's prescaler wait until the engine accepts them.
// A line's increments wait while the arc generator uses the axes' shadows.
`default_nettype none

module geometry_decoder #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1  // built-in engines: bits card_map_pkg::ENGINE_*
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic pop_i,
    input wire logic payload_ready_i,  // the engine's state may be loaded
    input wire logic shadows_free_i,  // increments may be loaded
    input wire logic empty_i,
    input wire logic [15:0] word_i,
    output logic read_o,
    input wire logic [load_bus_pkg::WIDTH-1:0] direct_load_i,  // only while nothing is decoded
    output logic [load_bus_pkg::WIDTH-1:0] load_o,
    // the decoded command
    output logic [Axes-1:0] mask_o,
    output logic [4:0] engine_o,  // number of the path's engine, card_map_pkg::ENGINE_*
    output logic barrier_o,  // the command is not a path
    output logic output_o,
    output logic mark_o,
    output logic pwm_o,
    output logic probe_o,
    output logic end_o,
    output logic wait_o,  // WAIT_INPUT
    output logic probe_end_o,
    output logic idle_o,
    output logic valid_o
);
  logic       first;
  logic       advance;
  logic [4:0] field;
  logic [4:0] next_q;  // the field after this one, if fields go by number
  logic [2:0] numbered_length;
  logic [2:0] next_length;
  logic [4:0] lowest;
  logic [4:0] first_field;
  logic [2:0] first_length;  // halfwords, less one
  logic [4:0] next_field;
  logic       last_field;
  logic       header;
  logic       of_count;  // word_i is of the count
  logic       of_field;  // word_i is of a field
  logic [4:0] which;  // the field of word_i
  logic [8:0] place;  // its destination: unit and target of the load bus
  logic [8:0] of_line;
  logic [8:0] of_arc;
  logic [8:0] of_chord;
  logic [7:0] opcode;
  logic [7:0] mask;
  logic       is_line_q;
  logic       is_arc_q;
  logic       is_chord_q;
  logic       is_output_q;
  logic       is_mark_q;
  logic       is_pwm_q;
  logic       is_probe_q;
  logic       is_wait_q;
  logic       has_words;  // the command has words for the path commands
  logic       at_axes;  // arc in chords: only increments of further axes are left
  logic       to_axis;  // the next field is an axis's increment
  logic       on_engine;
  logic       at_prescaler;
  logic [7:0] rest_q;  // axes of the mask whose increments are still to come
  logic [2:0] axis_x_q;  // axes of an arc's plane
  logic [2:0] axis_y_q;
  logic       plane;  // the plane is on word_i

  // Taken from the header together with the opcode: from the opcode, the path to the next field would be the card's
  // longest.
  always_ff @(posedge clk_i) begin
    if (header) begin
      is_line_q   <= word_i[7:0] == card_map_pkg::OP_LINE;
      is_arc_q    <= Engines[card_map_pkg::ENGINE_ACCUMULATOR] && word_i[7:0] == card_map_pkg::OP_ARC;
      is_chord_q  <= Engines[card_map_pkg::ENGINE_ARC_GENERATOR] && word_i[7:0] == card_map_pkg::OP_ARC_CHORD;
      is_output_q <= Engines[card_map_pkg::ENGINE_PATH_COMMANDS] && word_i[7:0] == card_map_pkg::OP_OUTPUT;
      is_mark_q   <= Engines[card_map_pkg::ENGINE_PATH_COMMANDS] && word_i[7:0] == card_map_pkg::OP_MARK;
      is_pwm_q    <= Engines[card_map_pkg::ENGINE_PWM] && word_i[7:0] == card_map_pkg::OP_PWM;
      is_probe_q  <= Engines[card_map_pkg::ENGINE_PATH_COMMANDS] && word_i[7:0] == card_map_pkg::OP_PROBE;
      is_wait_q   <= Engines[card_map_pkg::ENGINE_PATH_COMMANDS] && word_i[7:0] == card_map_pkg::OP_WAIT_INPUT;
    end
  end
  assign has_words = is_output_q || is_pwm_q || is_probe_q || is_wait_q;
  assign on_engine = is_arc_q || is_chord_q;  // not on lines: fields go by number
  assign mask_o    = mask[Axes-1:0];

  logic unused;  // bits of absent axes: the checker accepts no command for them
  assign unused = &{1'b0, mask};

  function automatic logic [4:0] lowest_axis(input logic [7:0] axes);
    lowest_axis = 5'd7;
    for (int i = 6; i >= 0; i--) if (axes[i]) lowest_axis = 5'(i);
  endfunction

  // Destinations of an arc's fields. The path ticks go nowhere: the prescaler makes exactly as many.
  function automatic logic [8:0] arc_target(input logic [4:0] number);
    case (number)
      card_map_pkg::FIELD_ARC_PRESCALE: arc_target = load_target_pkg::PRESCALE;
      card_map_pkg::FIELD_ARC_PLANE: arc_target = load_target_pkg::PLANE;
      card_map_pkg::FIELD_ARC_QUADRANTS: arc_target = load_target_pkg::QUADRANTS;
      card_map_pkg::FIELD_ARC_END_X: arc_target = load_target_pkg::END_X;
      card_map_pkg::FIELD_ARC_END_Y: arc_target = load_target_pkg::END_Y;
      card_map_pkg::FIELD_ARC_DEVIATION: arc_target = load_target_pkg::DEVIATION;
      card_map_pkg::FIELD_ARC_GRADIENT_X: arc_target = load_target_pkg::GRADIENT_X;
      card_map_pkg::FIELD_ARC_GRADIENT_Y: arc_target = load_target_pkg::GRADIENT_Y;
      card_map_pkg::FIELD_ARC_HALF_X: arc_target = load_target_pkg::HALF_X;
      card_map_pkg::FIELD_ARC_HALF_Y: arc_target = load_target_pkg::HALF_Y;
      default: arc_target = load_target_pkg::NOWHERE;
    endcase
  endfunction

  // Destinations of the fields of an arc in chords. An axis's increment is the field AXIS + axis, and goes to that
  // axis.
  localparam logic [4:0] AXIS = 5'd16;
  function automatic logic [8:0] chord_target(input logic [4:0] number, input logic [2:0] x, input logic [2:0] y);
    case (number)
      card_map_pkg::FIELD_ARC_CHORD_PRESCALE: chord_target = load_target_pkg::PRESCALE;
      card_map_pkg::FIELD_ARC_CHORD_PLANE: chord_target = load_target_pkg::CHORD_PLANE;
      card_map_pkg::FIELD_ARC_CHORD_SHIFTS: chord_target = load_target_pkg::CHORD_SHIFTS;
      card_map_pkg::FIELD_ARC_CHORD_X, card_map_pkg::FIELD_ARC_CHORD_Y: chord_target = load_target_pkg::CHORD_STATE;
      card_map_pkg::FIELD_ARC_CHORD_FIRST_X: chord_target = load_target_pkg::of_axis(x, load_target_pkg::INCREMENT);
      card_map_pkg::FIELD_ARC_CHORD_FIRST_Y: chord_target = load_target_pkg::of_axis(y, load_target_pkg::INCREMENT);
      card_map_pkg::FIELD_ARC_CHORD_CLOSING_X, card_map_pkg::FIELD_ARC_CHORD_CLOSING_Y:
      chord_target = load_target_pkg::CHORD_CLOSING;
      default:
      chord_target = number[4] ? load_target_pkg::of_axis(number[2:0], load_target_pkg::INCREMENT) :
          load_target_pkg::NOWHERE;
    endcase
  endfunction

  // The fields of a command that is not a path have numbers up to this one; no field that waits has such a number.
  localparam logic [4:0] LAST_OF_COMMAND = 5'd11;

  // All paths begin with a field of three halfwords; paths on an engine begin with path ticks, prescale, plane. A
  // line's fields are its axes. The last fields of an arc in chords are the axes outside its plane.
  assign lowest = lowest_axis(rest_q);
  assign numbered_length = card_map_pkg::field_halfwords_less_one(opcode, next_q);
  assign at_prescaler = field == card_map_pkg::FIELD_ARC_PRESCALE || field == card_map_pkg::FIELD_ARC_PLANE;

  assign plane = of_field && is_chord_q && which == card_map_pkg::FIELD_ARC_CHORD_PLANE;
  assign at_axes = is_chord_q && (field[4] || field == card_map_pkg::FIELD_ARC_CHORD_CLOSING_Y);
  assign to_axis = is_line_q || at_axes;

  always_ff @(posedge clk_i) begin
    if (first || advance) next_q <= (advance ? next_q : first_field) + 5'd1;
    if (plane) {axis_y_q, axis_x_q} <= {word_i[10:8], word_i[6:4]};
    if (header) rest_q <= word_i[15:8];
    else if (plane) rest_q <= rest_q & ~(8'd1 << word_i[6:4]) & ~(8'd1 << word_i[10:8]);
    else if ((first && is_line_q) || (advance && to_axis)) rest_q <= rest_q & (rest_q - 8'd1);
  end

  always_comb begin
    first_field  = on_engine ? 5'd0 : lowest;
    first_length = 3'd2;
    next_field   = !to_axis ? next_q : is_chord_q ? AXIS | lowest : lowest;
    next_length  = to_axis ? 3'd2 : numbered_length;
    last_field   = is_arc_q ? field == card_map_pkg::FIELD_ARC_HALF_Y : to_axis && rest_q == 8'd0;
    // One condition, two masks, or three fields of PWM.
    if (has_words) begin
      first_field  = LAST_OF_COMMAND - 5'(is_output_q) - {3'd0, is_pwm_q, 1'b0};
      first_length = 3'd0;
      last_field   = field[1:0] == LAST_OF_COMMAND[1:0];
    end
  end

  command_fetch fetch (
      .clk_i,
      .rst_i,
      .cut_i,
      .pop_i,
      .empty_i,
      .word_i,
      .read_o,
      .has_payload_i(is_line_q || on_engine || has_words),
      .first_field_i(first_field),
      .first_length_i(first_length),
      .next_field_i(next_field),
      .next_length_i(next_length),
      .last_field_i(last_field),
      .rest_i(1'b0),
      // At an engine's first field `field` is still the last one of the command before. Nothing waits then: the last
      // field of an engine is neither of the two that wait, and after a path on lines the engine is free.
      .wait_i(is_line_q ? !shadows_free_i : at_prescaler && !payload_ready_i),
      .header_o(header),
      .first_o(first),
      .advance_o(advance),
      .field_o(field),
      .of_count_o(of_count),
      .of_field_o(of_field),
      .which_o(which),
      .opcode_o(opcode),
      .mask_o(mask),
      .idle_o,
      .valid_o
  );

  assign of_line  = load_target_pkg::of_axis(which[2:0], load_target_pkg::INCREMENT);
  assign of_arc   = arc_target(which);
  assign of_chord = chord_target(which, axis_x_q, axis_y_q);

  always_comb begin
    place = is_arc_q ? of_arc : is_chord_q ? of_chord : has_words ? load_target_pkg::COMMAND : of_line;
    if (of_count) place = load_target_pkg::TICKS;
  end

  always_ff @(posedge clk_i) begin
    load_o <= load_bus_pkg::pack(of_count || of_field, place, word_i);
    if (direct_load_i[load_bus_pkg::VALID]) load_o <= direct_load_i;
    if (rst_i) load_o[load_bus_pkg::VALID] <= 1'b0;
  end

  always_ff @(posedge clk_i) begin
    engine_o <= 5'(card_map_pkg::ENGINE_LINES);
    if (is_arc_q) engine_o <= 5'(card_map_pkg::ENGINE_ACCUMULATOR);
    if (is_chord_q) engine_o <= 5'(card_map_pkg::ENGINE_ARC_GENERATOR);
    barrier_o   <= !is_line_q && !on_engine;
    output_o    <= is_output_q;
    mark_o      <= is_mark_q;
    pwm_o       <= is_pwm_q;
    probe_o     <= is_probe_q;
    end_o       <= opcode == card_map_pkg::OP_END;
    wait_o      <= is_wait_q;
    probe_end_o <= Engines[card_map_pkg::ENGINE_PATH_COMMANDS] && opcode == card_map_pkg::OP_PROBE_END;
  end
endmodule

`default_nettype wire
