// Reads commands from a queue, one command ahead: header first, then the payload field by field.
//
// In the queue a command is {mask, opcode}, three halfwords of count, payload. The decoder around the fetch knows the
// fields: it names the first field and the next one with their lengths, and gets each halfword back with its field.
// Timing: a halfword requested with `read_o` in cycle r is on the queue's output in r+2, on the load bus in r+3 and in
// its chain from r+4. `valid_o` rises in r+3 after the last read, so that a swap that is decided then and carried out
// one clock later meets the whole chain. Fields that are loaded after the swap are read once the command is taken.
`default_nettype none

module command_fetch (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic pop_i,  // the decoded command is taken; the next may be read
    // queue
    input wire logic empty_i,
    input wire logic [15:0] word_i,
    output logic read_o,
    // fields of the payload, named by the decoder from opcode_o, mask_o and field_o
    input wire logic has_payload_i,
    input wire logic [4:0] first_field_i,
    input wire logic [2:0] first_length_i,  // halfwords, less one
    input wire logic [4:0] next_field_i,
    input wire logic [2:0] next_length_i,
    input wire logic last_field_i,
    input wire logic rest_i,  // fields are left to read when the command is taken
    input wire logic wait_i,  // the next field (with first_o: the first one) must wait
    output logic header_o,  // {mask, opcode} is on word_i
    output logic first_o,  // the first field is taken up now (combinational)
    output logic advance_o,  // the next field is taken up now (combinational)
    output logic [4:0] field_o,  // the field that is being read or waits
    // halfwords on their way, aligned with word_i
    output logic of_count_o,
    output logic of_field_o,
    output logic [4:0] which_o,  // field of the halfword
    // header
    output logic [7:0] opcode_o,
    output logic [7:0] mask_o,
    output logic idle_o,  // nothing is read or decoded
    output logic valid_o  // a command is decoded
);
  typedef enum logic [2:0] {
    IDLE,
    HEADER,
    PAYLOAD,
    WAIT,
    TAIL,
    VALID,
    REST
  } state_e;

  state_e       state_q;
  logic   [1:0] step_q;  // within HEADER and TAIL
  logic   [2:0] left_q;  // halfwords left in the field, less one
  logic         field_done;

  // Reads made 1 and 2 clocks ago.
  logic         header_1_q;
  logic         payload_1_q;
  logic         first_1_q;
  logic   [4:0] field_1_q;

  assign field_done = left_q == 3'd0;
  assign first_o = has_payload_i && state_q == HEADER && step_q == 2'd3;
  assign advance_o = (state_q == PAYLOAD || state_q == REST) && field_done;

  always_ff @(posedge clk_i) begin : p_state
    state_e state_d;

    state_d = state_q;
    case (state_q)
      IDLE: if (!empty_i) state_d = HEADER;
      HEADER:
      if (step_q == 2'd3) begin
        if (!has_payload_i) state_d = TAIL;
        else if (wait_i) state_d = WAIT;
        else state_d = PAYLOAD;
      end
      PAYLOAD:
      if (field_done) begin
        if (last_field_i) state_d = TAIL;
        else if (wait_i) state_d = WAIT;
      end
      WAIT: if (!wait_i) state_d = PAYLOAD;
      TAIL: if (step_q == 2'd1) state_d = VALID;
      REST: if (field_done && last_field_i) state_d = IDLE;
      default: ;
    endcase

    if (cut_i || rst_i) begin
      state_q <= IDLE;
      read_o  <= 1'b0;
      valid_o <= 1'b0;
      idle_o  <= 1'b1;
    end else if (!valid_o) begin
      state_q <= state_d;
      read_o  <= state_d == HEADER || state_d == PAYLOAD || state_d == REST;
      valid_o <= state_d == VALID;
      idle_o  <= state_d == IDLE;
    end else if (pop_i) begin  // pop_i comes late, so it drives as little as possible
      state_q <= rest_i ? REST : IDLE;
      read_o  <= rest_i;
      valid_o <= 1'b0;
      idle_o  <= !rest_i;
    end
  end

  always_ff @(posedge clk_i) begin : p_fetch
    // The state changes only while there is something to read or on its way, and no decoded command waits.
    if (cut_i || rst_i || !(valid_o || (idle_o && empty_i && !of_field_o))) begin
      // step_q is 0 in the first clock of either state. It need not look at the next state: HEADER has four clocks.
      step_q <= state_q == HEADER || state_q == TAIL ? step_q + 2'd1 : 2'd0;

      if (first_o) begin
        {field_o, left_q} <= {first_field_i, first_length_i};
      end else if (advance_o) begin
        {field_o, left_q} <= {next_field_i, next_length_i};
      end else if (state_q == PAYLOAD || state_q == REST) begin
        left_q <= left_q - 3'd1;
      end

      header_1_q  <= state_q == HEADER;
      first_1_q   <= state_q == HEADER && step_q == 2'd0;
      payload_1_q <= state_q == PAYLOAD || state_q == REST;
      field_1_q   <= field_o;
      header_o    <= first_1_q;
      of_count_o  <= header_1_q && !first_1_q;
      of_field_o  <= payload_1_q;
      which_o     <= field_1_q;
      if (header_o) {mask_o, opcode_o} <= word_i;

      if (cut_i || rst_i) begin
        header_1_q  <= 1'b0;
        payload_1_q <= 1'b0;
        of_count_o  <= 1'b0;
        of_field_o  <= 1'b0;
      end
    end
  end
endmodule

`default_nettype wire
