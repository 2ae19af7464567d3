// Decodes the next geometry command onto the load bus: a line's increments to the axes, an arc's state to the path
// engines, the count to the count chain. The direct loader's halfwords go through the same register.
//
// The accumulator has no second set of registers: what follows an arc's prescaler waits until the engine takes it.
`default_nettype none

module geometry_decoder #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1  // what is built in, as the register ENGINES shows it
) (
    input  wire logic            clk_i,
    input  wire logic            rst_i,
    input  wire logic            cut_i,
    input  wire logic            pop_i,
    input  wire logic            payload_ready_i,  // the engine's state may be loaded
    input  wire logic            empty_i,
    input  wire logic [    15:0] word_i,
    output logic                 read_o,
    input  wire logic [    21:0] direct_load_i,    // only while nothing is decoded
    output logic      [    21:0] load_o,
    // the decoded command
    output logic      [Axes-1:0] mask_o,
    output logic      [     4:0] engine_o,         // what a path runs on, by its bit of ENGINES
    output logic                 barrier_o,
    output logic                 end_o,
    output logic                 idle_o,
    output logic                 valid_o
);
  logic       first;
  logic       advance;
  logic [4:0] field;
  logic [4:0] next_arc;
  logic [2:0] next_arc_length;
  logic [4:0] lowest;
  logic       header;
  logic [6:0] strobe;  // {of the count, of a field, which one}
  logic [7:0] opcode;
  logic [7:0] mask;
  logic       is_arc;
  logic       is_line;
  logic       at_prescaler;
  logic [7:0] rest_q;  // axes of the mask whose increments are still to come

  assign is_arc  = Engines[card_map_pkg::ENGINE_ACCUMULATOR] && opcode == card_map_pkg::OP_ARC;
  assign is_line = opcode == card_map_pkg::OP_LINE;
  assign mask_o  = mask[Axes-1:0];

  logic unused;  // absent axes: the checker lets no command for them in
  assign unused = &{1'b0, mask};

  function automatic logic [4:0] lowest_axis(input logic [7:0] axes);
    lowest_axis = 5'd7;
    for (int i = 6; i >= 0; i--) if (axes[i]) lowest_axis = 5'(i);
  endfunction

  // An arc's fields in the order of the stream. The path ticks go nowhere: the prescaler makes exactly as many.
  always_comb begin
    next_arc        = field + 5'd1;
    next_arc_length = 3'd4;
    case (field)
      load_target_pkg::NOWHERE: {next_arc, next_arc_length} = {load_target_pkg::PRESCALE, 3'd2};
      load_target_pkg::PRESCALE: {next_arc, next_arc_length} = {load_target_pkg::PLANE, 3'd0};
      load_target_pkg::PLANE: {next_arc, next_arc_length} = {load_target_pkg::QUADRANTS, 3'd0};
      load_target_pkg::QUADRANTS: {next_arc, next_arc_length} = {load_target_pkg::END_X, 3'd1};
      load_target_pkg::END_X: next_arc_length = 3'd1;
      load_target_pkg::END_Y: next_arc = load_target_pkg::DEVIATION;
      load_target_pkg::DEVIATION: next_arc = load_target_pkg::GRADIENT_X;
      load_target_pkg::GRADIENT_X: next_arc = load_target_pkg::GRADIENT_Y;
      load_target_pkg::GRADIENT_Y, load_target_pkg::HALF_X: next_arc_length = 3'd2;
      default: ;
    endcase
  end

  // Lines and arcs both begin with a field of three halfwords. A line's fields are its axes.
  assign lowest = lowest_axis(rest_q);
  assign at_prescaler = field == load_target_pkg::PRESCALE || field == load_target_pkg::PLANE;

  always_ff @(posedge clk_i) begin
    if (header) rest_q <= word_i[15:8];
    else if (first || advance) rest_q <= rest_q & (rest_q - 8'd1);
  end

  command_fetch fetch (
      .*,
      .has_payload_i(is_line || is_arc),
      .first_i      ({is_arc ? load_target_pkg::NOWHERE : lowest, 3'd2}),
      .next_i       (is_arc ? {next_arc, next_arc_length} : {lowest, 3'd2}),
      .last_field_i (is_arc ? field == load_target_pkg::HALF_Y : rest_q == 8'd0),
      .rest_i       (1'b0),
      .wait_i       (is_arc && at_prescaler && !payload_ready_i),
      .header_o     (header),
      .first_o      (first),
      .advance_o    (advance),
      .field_o      (field),
      .strobe_o     (strobe),
      .opcode_o     (opcode),
      .mask_o       (mask)
  );

  always_ff @(posedge clk_i) begin
    load_o[21]    <= (strobe[6:5] != 2'd0 || direct_load_i[21]) && !rst_i;
    load_o[20:16] <= direct_load_i[21] ? direct_load_i[20:16] : strobe[6] ? load_target_pkg::TICKS : strobe[4:0];
    load_o[15:0]  <= direct_load_i[21] ? direct_load_i[15:0] : word_i;

    engine_o      <= 5'(is_arc ? card_map_pkg::ENGINE_ACCUMULATOR : card_map_pkg::ENGINE_LINES);
    barrier_o     <= !is_line && !is_arc;
    end_o         <= opcode == card_map_pkg::OP_END;
  end
endmodule

`default_nettype wire
