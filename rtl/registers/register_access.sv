// Carries one access at a time through: judgement, action, answer.
//
// The access stands still from request_i to ack_o. A write that is good acts in
// the clock after act_o, which is that of its ack_o.
`default_nettype none
module register_access (
    input  wire logic       clk_i,
    input  wire logic       rst_i,
    input  wire logic       request_i,
    input  wire logic       write_i,
    output logic            ack_o,
    output logic            error_o,
    output logic            read_o,            // with ack_o: what was read is to be shown
    // judgement
    output logic            judge_o,
    input  wire logic       wait_i,            // the RAM is being written and the access is not to a live register
    input  wire logic [8:0] verdict_i,         // {good, reason}
    input  wire logic       stream_i,
    input  wire logic       start_i,
    output logic            act_o,             // combinational
    output logic            sample_o,          // combinational: a live register is taken
    // who answers a word of the stream and START
    output logic            stream_write_o,
    input  wire logic       checker_ready_i,
    input  wire logic       checker_refuse_i,
    output logic            start_o,
    input  wire logic [9:0] start_answer_i,    // {done, error, reason}
    // a refusal by the map or by START, combinational
    output logic            refuse_o,
    output logic      [7:0] reason_o
);

  typedef enum logic [2:0] {
    IDLE,
    DECODE,  // register_decode takes the access
    WAIT,    // its judgement comes; whoever writes the RAM goes first
    ACT,     // refuse or act; the RAM's word is in its first register
    RESPOND, // the RAM's word gets into its second register
    STREAM,  // wait for the command checker's judgement
    START    // wait for the direct loader's
  } state_e;

  state_e state_q;
  logic   acting_q;  // ACT
  logic   good;

  assign good = verdict_i[8];

  always_ff @(posedge clk_i) begin
    ack_o <= 1'b0;
    error_o <= 1'b0;
    read_o <= 1'b0;
    stream_write_o <= 1'b0;
    start_o <= 1'b0;
    acting_q <= state_q == WAIT && !wait_i;
    case (state_q)
      IDLE:   if (request_i) state_q <= DECODE;
      DECODE: state_q <= WAIT;
      WAIT:   if (!wait_i) state_q <= ACT;
      ACT: begin
        state_q <= IDLE;
        if (good && !write_i) begin
          state_q <= RESPOND;
        end else if (good && stream_i) begin
          state_q <= STREAM;
          stream_write_o <= 1'b1;
        end else if (good && start_i) begin
          state_q <= START;
          start_o <= 1'b1;
        end else begin
          ack_o   <= 1'b1;
          error_o <= !good;
        end
      end
      STREAM: begin
        // The checker is still ready in the clock of the write.
        if (checker_ready_i && !stream_write_o) begin
          state_q <= IDLE;
          ack_o   <= 1'b1;
          error_o <= checker_refuse_i;
        end
      end
      START: begin
        if (start_answer_i[9]) begin
          state_q <= IDLE;
          ack_o   <= 1'b1;
          error_o <= start_answer_i[8];
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

  assign judge_o = state_q == DECODE || state_q == WAIT;
  assign act_o = acting_q && good && write_i;
  assign sample_o = acting_q;
  assign refuse_o = acting_q ? !good : state_q == START && start_answer_i[9] && start_answer_i[8];
  assign reason_o = acting_q ? verdict_i[7:0] : start_answer_i[7:0];

endmodule
`default_nettype wire
