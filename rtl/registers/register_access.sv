// Carries out one access at a time: judges it by the register map, acts, answers.
//
// The access keeps its values from the request until ack_o. The effects of a write go out in the clock of its ack_o. A
// flush goes out one clock earlier, so that its refusal meets the access that requested it. The decoded properties of
// an access are kept until the next one, since they do not change in between.
`default_nettype none
module register_access #(
    parameter int          Axes    = 4,  // 1 to 8
    parameter logic [31:0] Engines = '1  // built-in engines: bits card_map_pkg::ENGINE_*
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [register_access_pkg::WIDTH-1:0] access_i,
    output logic ack_o,
    output logic error_o,
    input wire logic writing_i,  // the RAM is being written
    input wire logic direct_i,  // a direct move is under way
    // reads
    output logic live_o,  // the register shows the present state of the card
    output logic sample_o,  // combinational: a live register is sampled
    output logic read_o,  // with ack_o: the answer carries the data that was read
    // writes
    output logic [setting_bus_pkg::WIDTH-1:0] setting_o,
    output logic [31:0] clear_fault_o,
    output logic snapshot_o,
    output logic abort_o,
    output logic probe_clear_o,
    output logic flush_o,  // combinational
    // the units that answer a word of the stream and START
    output logic stream_write_o,
    input wire logic [stream_answer_pkg::WIDTH-1:0] stream_answer_i,
    output logic start_o,
    input wire logic [start_answer_pkg::WIDTH-1:0] start_answer_i,
    output logic [refusal_pkg::WIDTH-1:0] refusal_o  // combinational
);

  localparam logic [3:0] AXIS_COUNT = 4'(Axes);

  typedef enum logic [2:0] {
    IDLE,
    DECODE,   // the properties of the register are looked up
    WAIT,     // the access is judged; other writers of the RAM go first
    ACT,      // the access is refused or acts; the RAM's word is in its first register
    RESPOND,  // the RAM's word moves into its second register
    STREAM,   // waits for the command checker
    START     // waits for the direct loader
  } state_e;

  state_e        state_q;
  logic          acting_q;  // ACT
  logic          judging;
  logic          waiting;
  logic          write;
  logic   [ 9:0] word;
  logic   [31:0] data;

  assign judging = state_q == DECODE || state_q == WAIT;
  assign write   = access_i[register_access_pkg::WRITE];
  assign word    = register_access_pkg::word(access_i);
  assign data    = register_access_pkg::data(access_i);

  // Properties of the register that the access addresses.
  logic [2:0] kind_q;
  logic       absent_q;
  logic [3:0] stray_q;  // by byte: a bit that must be 0 is 1
  logic       in_limits_q;
  logic       sets_q;  // a write goes to the setting bus
  logic       control_q;
  logic       flush_q;
  logic       fault_q;
  logic       refusal_q;
  logic       stream_q;
  logic       start_q;

  always_ff @(posedge clk_i) begin : p_decode
    logic        only_present;
    logic [ 2:0] axis;
    logic [31:0] mask;

    if (judging) begin
      mask = card_map_pkg::register_mask(word, Engines);
      only_present = card_map_pkg::register_only_present_axes(word);
      axis = card_map_pkg::register_axis(word);
      kind_q   <= card_map_pkg::register_access(word, Engines);
      absent_q <= !register_access_pkg::aligned(access_i) || (only_present && {1'b0, axis} >= AXIS_COUNT);
      for (int b = 0; b < 4; b++) stray_q[b] <= (data[8*b+:8] & ~mask[8*b+:8]) != 8'd0;
      in_limits_q <= card_map_pkg::register_in_limits(word, data);
      // SET_PLACE, CAPTURE_CLEAR and CAPTURE_NEXT go to the setting bus, too, though they cannot be read back.
      sets_q <= card_map_pkg::register_access(
          word, Engines
      ) == card_map_pkg::ACCESS_SETTING || word == card_map_pkg::ADDR_SET_PLACE[11:2] ||
          word == card_map_pkg::ADDR_CAPTURE_CLEAR[11:2] || word == card_map_pkg::ADDR_CAPTURE_NEXT[11:2];
      control_q <= word == card_map_pkg::ADDR_CONTROL[11:2];
      // An abort in the same write does more than a flush, so it replaces the flush.
      flush_q <= word == card_map_pkg::ADDR_CONTROL[11:2] && data[card_map_pkg::BIT_CONTROL_FLUSH] &&
          !data[card_map_pkg::BIT_CONTROL_ABORT];
      fault_q <= word == card_map_pkg::ADDR_FAULT[11:2];
      refusal_q <= word == card_map_pkg::ADDR_REFUSAL[11:2] && data != 32'd0;
      stream_q <= word == card_map_pkg::ADDR_STREAM[11:2];
      start_q <= word == card_map_pkg::ADDR_START[11:2] && Engines[card_map_pkg::ENGINE_DIRECT_MODE];
    end
  end

  // A port owns the stream from the first word of a command to its last.
  logic [1:0] owner_q;
  logic       stream_busy;

  assign stream_busy = direct_i || (stream_answer_i[stream_answer_pkg::PARTIAL] && owner_q != register_access_pkg::port(
      access_i
  ));

  always_ff @(posedge clk_i) begin
    if (stream_write_o) owner_q <= register_access_pkg::port(access_i);
  end

  logic       read_only;
  logic       good_q;
  logic [7:0] reason_q;

  assign live_o = !absent_q && (kind_q == card_map_pkg::ACCESS_LIVE || kind_q == card_map_pkg::ACCESS_CLEAR_ONES);
  assign read_only = kind_q == card_map_pkg::ACCESS_CONSTANT || kind_q == card_map_pkg::ACCESS_LIVE ||
      kind_q == card_map_pkg::ACCESS_SNAPSHOT;

  always_ff @(posedge clk_i) begin
    if (judging) begin
      good_q <= 1'b0;
      if (kind_q == card_map_pkg::ACCESS_NONE || absent_q) begin
        reason_q <= card_map_pkg::REFUSE_UNKNOWN_ADDRESS;
      end else if (!write && kind_q == card_map_pkg::ACCESS_COMMAND) begin
        reason_q <= card_map_pkg::REFUSE_WRITE_ONLY;
      end else if (write && read_only) begin
        reason_q <= card_map_pkg::REFUSE_READ_ONLY;
      end else if (write && access_i[register_access_pkg::PARTIAL]) begin
        reason_q <= card_map_pkg::REFUSE_PARTIAL_WRITE;
      end else if (write && (stray_q != 4'd0 || !in_limits_q)) begin
        reason_q <= card_map_pkg::REFUSE_BAD_VALUE;
      end else if (stream_q && stream_busy) begin
        reason_q <= card_map_pkg::REFUSE_BUSY;
      end else begin
        good_q <= 1'b1;
      end
    end
  end

  always_ff @(posedge clk_i) begin
    ack_o <= 1'b0;
    error_o <= 1'b0;
    read_o <= 1'b0;
    stream_write_o <= 1'b0;
    start_o <= 1'b0;
    acting_q <= state_q == WAIT && !waiting;
    case (state_q)
      IDLE:   if (access_i[register_access_pkg::REQUEST]) state_q <= DECODE;
      DECODE: state_q <= WAIT;
      WAIT:   if (!waiting) state_q <= ACT;
      ACT: begin
        state_q <= IDLE;
        if (good_q && !write) begin
          state_q <= RESPOND;
        end else if (good_q && stream_q) begin
          state_q <= STREAM;
          stream_write_o <= 1'b1;
        end else if (good_q && start_q) begin
          state_q <= START;
          start_o <= 1'b1;
        end else begin
          ack_o   <= 1'b1;
          error_o <= !good_q;
        end
      end
      STREAM: begin
        // The checker is still ready in the clock of the write.
        if (stream_answer_i[stream_answer_pkg::READY] && !stream_write_o) begin
          state_q <= IDLE;
          ack_o   <= 1'b1;
          error_o <= stream_answer_i[stream_answer_pkg::REFUSE];
        end
      end
      START: begin
        if (start_answer_i[start_answer_pkg::DONE]) begin
          state_q <= IDLE;
          ack_o   <= 1'b1;
          error_o <= start_answer_i[start_answer_pkg::ERROR];
        end
      end
      default: begin  // RESPOND
        state_q <= IDLE;
        ack_o   <= 1'b1;
        read_o  <= 1'b1;
      end
    endcase
    if (rst_i) begin
      state_q <= IDLE;
      ack_o <= 1'b0;
      error_o <= 1'b0;
      read_o <= 1'b0;
      stream_write_o <= 1'b0;
      start_o <= 1'b0;
      acting_q <= 1'b0;
    end
  end

  logic        refuse;
  logic [15:0] why;  // {number, reason}
  logic        start_refused;
  logic        act;

  assign act = acting_q && good_q && write;
  assign waiting = writing_i && (write || !live_o);
  assign sample_o = acting_q;
  // The map, the direct loader or the checker refuses. The checker does so while its access waits, or in the clock
  // after a flush.
  assign start_refused = start_answer_i[start_answer_pkg::DONE] && start_answer_i[start_answer_pkg::ERROR];

  assign refuse = acting_q ? !good_q : state_q == START ? start_refused : stream_answer_i[stream_answer_pkg::REFUSE];
  assign why = acting_q ? {8'd0, reason_q} : state_q == START ? {8'd0, start_answer_pkg::reason(
      start_answer_i
  )} : stream_answer_pkg::why(
      stream_answer_i
  );
  assign refusal_o = refusal_pkg::pack(act && refusal_q, refuse, why);

  logic set_q;

  assign setting_o = setting_bus_pkg::pack(set_q, word, data);
  assign flush_o   = acting_q && good_q && flush_q;  // CONTROL is write-only, so good_q implies a write

  always_ff @(posedge clk_i) begin
    set_q <= act && sets_q;
    clear_fault_o <= act && fault_q ? data : '0;
    snapshot_o <= act && control_q && data[card_map_pkg::BIT_CONTROL_SNAPSHOT];
    abort_o <= act && control_q && data[card_map_pkg::BIT_CONTROL_ABORT];
    probe_clear_o <= act && control_q && data[card_map_pkg::BIT_CONTROL_PROBE_CLEAR] &&
        Engines[card_map_pkg::ENGINE_PATH_COMMANDS];
    if (rst_i) begin
      set_q <= 1'b0;
      clear_fault_o <= '0;
      snapshot_o <= 1'b0;
      abort_o <= 1'b0;
      probe_clear_o <= 1'b0;
    end
  end

endmodule
`default_nettype wire
