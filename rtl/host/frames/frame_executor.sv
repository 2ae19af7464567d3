// Makes a request's accesses at the inner port, up to the first that is refused. Then it reads the state of the card
// that every reply carries: the five registers from STATUS on. Words are in the RAM byte by byte: those of a request
// from place 8 of its half on, words that were read from place 20 of the reply's half on, after the state.
`default_nettype none
module frame_executor (
    input wire logic clk_i,
    input wire logic rst_i,
    // the request keeps its values from start_i on
    input wire logic start_i,
    input wire logic execute_i,  // with start_i; 0: only the state is read
    input wire logic new_i,  // with start_i: the first request of its session
    input wire logic write_i,
    input wire logic fixed_i,
    input wire logic [5:0] count_i,
    input wire logic [9:0] address_i,  // word address
    output logic done_o,  // event
    // results of the last execution
    output logic [5:0] made_o,
    output logic refused_o,
    output logic read_o,
    // RAM
    output logic [7:0] place_o,
    output logic store_o,
    output logic [7:0] byte_o,
    input wire logic [7:0] byte_i,  // byte at the place of one clock ago
    // to the inner port
    output logic [register_access_pkg::WIDTH-1:0] access_o,
    input wire logic [register_answer_pkg::WIDTH-1:0] answer_i
);
  localparam logic [7:0] REQUEST_WORDS = 8'd8;
  localparam logic [7:0] REPLY_WORDS = 8'd20;
  localparam logic [5:0] STATE_COUNT = 6'd5;
  localparam logic [9:0] STATE_ADDRESS = card_map_pkg::ADDR_STATUS[11:2];

  localparam int FETCH = 0;  // a word to write is read from the RAM
  localparam int ASK = 1;
  localparam int STORE = 2;  // a word that was read is written to the RAM
  localparam int NEXT = 3;

  logic [                           3:0] at_q;  // one-hot; none: at rest, or the inner port has the access
  logic [                           2:0] byte_q;  // byte of the word under way
  logic [                           5:0] word_q;
  logic                                  state_q;  // 1: the reply's state is read; 0: the request runs
  logic                                  error_q;
  logic                                  new_q;  // no access of the session has been answered yet
  logic [                           7:0] place_q;
  logic [                           9:0] address_q;
  logic [                          31:0] data_q;
  logic                                  writes;
  logic                                  over;
  logic                                  moves;
  logic                                  begins;  // the request begins
  logic                                  ack;
  logic                                  error;

  logic [register_access_pkg::WIDTH-1:0] asked;

  assign begins   = start_i && execute_i;
  assign writes   = write_i && !state_q;
  assign over     = error_q || word_q == (state_q ? STATE_COUNT : count_i);
  assign moves    = at_q[FETCH] || at_q[STORE];

  assign place_o  = place_q;
  assign store_o  = at_q[STORE];
  assign byte_o   = data_q[7:0];
  assign asked    = register_access_pkg::pack(at_q[ASK], writes, 1'b0, {address_q, 2'b00}, data_q);
  assign access_o = register_access_pkg::with_session(asked, !state_q, new_q && !state_q);
  assign ack      = answer_i[register_answer_pkg::ACK];
  assign error    = answer_i[register_answer_pkg::ERROR];
  assign done_o   = at_q[NEXT] && state_q && over;

  always_ff @(posedge clk_i) begin
    at_q[FETCH] <= (begins && write_i) || (at_q[FETCH] && !byte_q[2]) || (at_q[NEXT] && writes && !over);
    at_q[ASK]   <= (start_i && !(begins && write_i)) || (at_q[FETCH] && byte_q[2]) ||
        (at_q[NEXT] && !done_o && (!writes || over));
    at_q[STORE] <= (ack && !writes && (state_q || !error)) || (at_q[STORE] && byte_q != 3'd3);
    at_q[NEXT] <= (ack && (writes || (!state_q && error))) || (at_q[STORE] && byte_q == 3'd3);
    if (rst_i) at_q <= '0;
  end

  always_ff @(posedge clk_i) begin
    byte_q <= moves ? byte_q + 3'd1 : 3'd0;
    if (moves) data_q <= {byte_i, data_q[31:8]};
    if (ack) data_q <= register_answer_pkg::data(answer_i);
    // While a word is fetched, the place is one clock ahead of the byte.
    if (moves && !byte_q[2]) place_q <= place_q + 8'd1;
    if (ack) begin
      error_q <= error && !state_q;
      word_q  <= word_q + 6'(state_q || !error);
      if (!fixed_i || state_q) address_q <= address_q + 10'd1;
    end
    // The last of these values are the results of the execution.
    if (!state_q) begin
      made_o <= word_q;
      refused_o <= error_q;
      read_o <= !write_i;
    end
    if (begins) new_q <= new_i;
    else if (ack) new_q <= 1'b0;
    if (start_i || (at_q[NEXT] && over)) begin
      state_q <= !begins;
      word_q <= 6'd0;
      place_q <= !begins ? 8'd0 : write_i ? REQUEST_WORDS : REPLY_WORDS;
      address_q <= begins ? address_i : STATE_ADDRESS;
    end
    // A reply to a repeat has these values before anything was executed.
    if (rst_i) begin
      {made_o, refused_o, read_o} <= '0;
      state_q <= 1'b1;
    end
  end
endmodule
`default_nettype wire
