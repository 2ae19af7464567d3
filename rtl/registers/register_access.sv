`default_nettype none

// Takes one access at a time and carries it through: judgement, action, answer.
// The access stands at address_o, write_o, partial_o and word_o from the clock behind request_i until the next one;
// word_o keeps the last word written.
module register_control (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic        request_i,
    input  wire logic        write_i,
    input  wire logic        partial_i,
    input  wire logic [11:0] address_i,
    input  wire logic [31:0] data_i,
    output logic             ack_o,
    output logic             error_o,
    output logic             respond_o,
    output logic             write_o,
    output logic             partial_o,
    output logic      [11:0] address_o,
    output logic      [31:0] word_o,
    output logic             judge_o,          // the access is being judged
    output logic             sample_o,         // a live register is taken, for respond_o in the next clock
    // judgement
    input  wire logic [ 2:0] kind_i,
    input  wire logic        stream_i,
    input  wire logic        start_i,
    input  wire logic        good_i,
    input  wire logic [ 7:0] reason_i,
    input  wire logic        walking_i,
    // a write takes effect while act_o is high, together with its ack_o
    output logic             act_o,
    output logic             refuse_o,
    output logic      [ 7:0] refuse_reason_o,
    output logic             stream_write_o,
    output logic             start_o,
    input  wire logic        door_ready_i,
    input  wire logic        door_refuse_i,
    input  wire logic        start_done_i,
    input  wire logic        start_error_i,
    input  wire logic [ 7:0] start_reason_i
);

  typedef enum logic [3:0] {
    IDLE,
    DECODE,   // register_decode takes the access
    WAIT,     // its judgement comes; a walk over the RAM goes first
    ACT,      // refuse or act; the RAM's word is in its first register
    RESPOND,  // the read value is there
    SEND,     // a word for the door: wait until it is ready
    SENT,     // the door sees the word
    JUDGE,    // wait for the door's judgement
    LOAD      // wait for the direct loader's
  } state_e;

  state_e        state_q;

  logic          write_q;
  logic          partial_q;
  logic   [11:0] address_q;
  logic   [31:0] word_q;

  always_ff @(posedge clk_i) begin
    if (request_i && state_q == IDLE) begin
      write_q   <= write_i;
      partial_q <= partial_i;
      address_q <= address_i;
      if (write_i) word_q <= data_i;
    end
    if (rst_i) begin
      address_q <= '0;
      word_q <= '0;
    end
  end

  logic word_refused_q;
  logic act_q;
  logic ack_q;
  logic error_q;
  logic stream_write_q;
  logic start_q;

  always_ff @(posedge clk_i) begin
    act_q <= 1'b0;
    ack_q <= 1'b0;
    error_q <= 1'b0;
    stream_write_q <= 1'b0;
    start_q <= 1'b0;
    case (state_q)
      IDLE:   if (request_i) state_q <= DECODE;
      DECODE: state_q <= WAIT;
      WAIT:   if (!walking_i || kind_i == card_map_pkg::ACCESS_LIVE) state_q <= ACT;
      ACT: begin
        if (!good_i) begin
          state_q <= IDLE;
          ack_q   <= 1'b1;
          error_q <= 1'b1;
        end else if (!write_q) begin
          state_q <= RESPOND;
        end else if (stream_i) begin
          state_q <= SEND;
        end else if (start_i) begin
          state_q <= LOAD;
          start_q <= 1'b1;
        end else begin
          state_q <= IDLE;
          ack_q   <= 1'b1;
          act_q   <= 1'b1;
        end
      end
      SEND: begin
        word_refused_q <= 1'b0;
        if (door_ready_i) begin
          state_q <= SENT;
          stream_write_q <= 1'b1;
        end
      end
      SENT:   state_q <= JUDGE;
      JUDGE: begin
        word_refused_q <= word_refused_q || door_refuse_i;
        if (door_ready_i) begin
          state_q <= IDLE;
          ack_q   <= 1'b1;
          error_q <= word_refused_q || door_refuse_i;
        end
      end
      LOAD: begin
        if (start_done_i) begin
          state_q <= IDLE;
          ack_q   <= 1'b1;
          error_q <= start_error_i;
        end
      end
      // RESPOND
      default: begin
        state_q <= IDLE;
        ack_q   <= 1'b1;
      end
    endcase
    if (rst_i) begin
      state_q <= IDLE;
      act_q <= 1'b0;
      ack_q <= 1'b0;
      error_q <= 1'b0;
      stream_write_q <= 1'b0;
      start_q <= 1'b0;
    end
  end

  assign ack_o = ack_q;
  assign error_o = error_q;
  assign judge_o = state_q == DECODE || state_q == WAIT;
  assign sample_o = state_q == ACT;
  assign respond_o = state_q == RESPOND;
  assign write_o = write_q;
  assign partial_o = partial_q;
  assign address_o = address_q;
  assign word_o = word_q;
  assign act_o = act_q;
  assign refuse_o = state_q == ACT ? !good_i : state_q == LOAD && start_done_i && start_error_i;
  assign refuse_reason_o = state_q == ACT ? reason_i : start_reason_i;
  assign stream_write_o = stream_write_q;
  assign start_o = start_q;

endmodule

`default_nettype wire
