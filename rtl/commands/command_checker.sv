// Takes the words of the stream, judges them halfword by halfword against the layouts of rtl/regs/commands.toml, and
// passes good commands on in their stored form, without halfword 1 and padding.
//
// A word written at c stays on word_i until it is answered, at c+6, when the checker is ready again; refuse says
// whether the word is refused. A refusal drops the whole command and closes the stream until clear_i; a closed stream
// answers at c+2. During a fault (closed_i) the answer also comes at c+2; this refusal changes nothing else, since the
// cut that comes with the fault clears everything. A write while the checker is not ready is ignored. flush_i waits for
// a word under way, and goes before a word in the same clock. A word under way at clear_i is dropped without a refusal.
// number is that of the last header, reason that of the last refusal.
`default_nettype none
module command_checker #(
    parameter int Axes = 4,  // 1 to 8
    parameter logic [31:0] Engines = '1  // built-in engines: bits card_map_pkg::ENGINE_*
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic write_i,
    input wire logic [31:0] word_i,
    input wire logic flush_i,
    input wire logic clear_i,
    input wire logic closed_i,
    input wire logic [15:0] geometry_room_i,  // halfwords
    input wire logic [15:0] feed_room_i,
    output logic [arrival_pkg::WIDTH-1:0] arrival_o,
    output logic [stream_answer_pkg::WIDTH-1:0] answer_o
);

  // The way of a word, one clock each: either halfword is examined and judged, then the word is answered.
  logic low_q;
  logic low_judge_q;
  logic high_q;
  logic high_judge_q;
  logic answer_q;

  logic [15:0] halfword_q;  // halfword under way: the lower one, except while the upper one is examined and judged
  logic ready_q;
  logic partial_q;
  logic refuse_q;
  logic [7:0] reason_q;
  logic open_q;
  logic faulted_q;  // the word came during a fault
  logic flush_q;
  logic [4:0] left_q;  // words to come: at most 25, for ARC_CHORD
  logic restart;
  logic truncate;
  logic last;
  logic padding;
  logic judged;
  logic refused;
  logic accepted;
  logic store;
  logic [7:0] op;
  logic [7:0] mask;
  logic [7:0] number;
  logic to_geometry;
  logic to_feed;
  logic [5:0] stored;
  logic header_bad;
  logic [7:0] header_reason;
  logic field_bad;
  logic field_bad_mask;

  assign answer_o = stream_answer_pkg::pack(partial_q, ready_q, refuse_q, number, reason_q);

  // Halfwords to store. No command is larger than 50 halfwords of geometry or 20 of feed.
  logic [15:0] stored_q;
  logic geometry_write_q;
  logic geometry_commit_q;
  logic feed_write_q;
  logic feed_commit_q;
  logic drop_q;
  assign arrival_o[arrival_pkg::HALFWORD+:16] = stored_q;
  assign arrival_o[arrival_pkg::GEOMETRY_WRITE] = geometry_write_q;
  assign arrival_o[arrival_pkg::GEOMETRY_COMMIT] = geometry_commit_q;
  assign arrival_o[arrival_pkg::FEED_WRITE] = feed_write_q;
  assign arrival_o[arrival_pkg::FEED_COMMIT] = feed_commit_q;
  assign arrival_o[arrival_pkg::DROP] = drop_q;
  assign arrival_o[arrival_pkg::FULL] = geometry_room_i[15:6] == 10'd0 || feed_room_i[15:5] == 11'd0;

  // The state changes only during a word and in the clock after it, in which the pulses fall.
  logic awake;
  logic awake_q;
  assign awake = restart || write_i || flush_i || awake_q;
  always_ff @(posedge clk_i) awake_q <= write_i || flush_i || flush_q || !ready_q;

  assign restart  = rst_i || clear_i;
  assign truncate = ready_q && (flush_i || flush_q) && partial_q;
  assign last     = left_q == 5'd1;
  assign padding  = last && !stored[0];
  assign judged   = answer_q && open_q && !faulted_q;
  assign refused  = judged && (partial_q ? field_bad : header_bad);
  assign accepted = judged && partial_q && last && !field_bad;
  // The first halfword is stored only after the header is accepted: before that there may be no room for it.
  assign store    = partial_q ? low_judge_q || (high_judge_q && !padding) : judged && !refused;

  command_header #(
      .Axes(Axes),
      .Engines(Engines)
  ) header (
      .clk_i,
      .restart_i(restart),
      .phase_i(partial_q ? 4'd0 : {high_judge_q, high_q, low_judge_q, low_q}),
      .accept_i(accepted),
      .halfword_i(halfword_q),
      .geometry_room_i,
      .feed_room_i,
      .op_o(op),
      .mask_o(mask),
      .number_o(number),
      .to_geometry_o(to_geometry),
      .to_feed_o(to_feed),
      .stored_o(stored),
      .bad_o(header_bad),
      .reason_o(header_reason)
  );

  command_fields #(
      .Engines(Engines)
  ) fields (
      .clk_i,
      .restart_i(!partial_q),
      .examine_i((low_q || high_q) && partial_q),
      .judge_i((low_judge_q || high_judge_q) && partial_q),
      .read_ahead_i(low_judge_q || high_judge_q),
      .padding_i(padding && partial_q),
      .halfword_i(halfword_q),
      .op_i(op),
      .mask_i(mask),
      .bad_o(field_bad),
      .bad_mask_o(field_bad_mask)
  );

  always_ff @(posedge clk_i) begin
    if (awake) begin
      halfword_q <= low_judge_q || high_q ? word_i[31:16] : word_i[15:0];
      if (judged) left_q <= partial_q ? left_q - 5'd1 : stored[5:1];
    end
  end

  always_ff @(posedge clk_i) begin
    if (awake) begin
      if (restart) begin
        {low_q, low_judge_q, high_q, high_judge_q, answer_q} <= 5'd0;
        ready_q <= 1'b1;
        flush_q <= 1'b0;
        open_q <= 1'b1;
        partial_q <= 1'b0;
      end else begin
        low_q <= ready_q && write_i && open_q && !closed_i && !truncate;
        low_judge_q <= low_q;
        high_q <= low_judge_q;
        high_judge_q <= high_q;
        answer_q <= high_judge_q || (ready_q && write_i && (!open_q || closed_i || truncate));
        ready_q <= answer_q || (ready_q && !write_i);
        if (ready_q) faulted_q <= closed_i;
        flush_q <= !ready_q && (flush_i || flush_q);
        if (refused || truncate) open_q <= 1'b0;
        if (refused || truncate) partial_q <= 1'b0;
        else if (judged) partial_q <= !accepted;
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (awake) begin
      if (restart) begin
        stored_q <= 16'd0;
        {geometry_write_q, geometry_commit_q, feed_write_q, feed_commit_q} <= 4'd0;
        drop_q <= 1'b0;
        refuse_q <= 1'b0;
        reason_q <= card_map_pkg::REFUSE_NONE;
      end else begin
        if (store) stored_q <= halfword_q;
        geometry_write_q <= store && to_geometry;
        geometry_commit_q <= accepted && to_geometry;
        feed_write_q <= store && to_feed;
        feed_commit_q <= accepted && to_feed;
        drop_q <= refused || truncate;
        refuse_q <= refused || truncate || (answer_q && !judged);
        // Never both: an answer comes while ready_q is low, a flush takes effect while it is high.
        if (answer_q) begin
          if (faulted_q) reason_q <= card_map_pkg::REFUSE_FAULTED;
          else if (!open_q) reason_q <= card_map_pkg::REFUSE_STREAM_CLOSED;
          else if (refused && !partial_q) reason_q <= header_reason;
          else if (refused) reason_q <= field_bad_mask ? card_map_pkg::REFUSE_BAD_MASK : card_map_pkg::REFUSE_BAD_FIELD;
        end else if (truncate) reason_q <= card_map_pkg::REFUSE_TRUNCATED;
      end
    end
  end

endmodule
`default_nettype wire
