// START: reads the direct-mode registers, checks them, shifts them into the chains of the masked axes, starts the move.
//
// The chains are loaded while the registers are checked: nothing takes them up before `go_o`, and the next command or
// START loads them again. A read takes 4 clocks: the address is a register, its data arrives two clocks later, and the
// two halfwords are taken in the last clock and the next.
`default_nettype none

module direct_loader #(
    parameter int Axes = 4
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic busy_i,  // something runs, is decoded or queued
    input wire logic closed_i,  // no command and no START is accepted
    // registers
    input wire logic [start_pkg::WIDTH-1:0] start_i,
    output logic [start_answer_pkg::WIDTH-1:0] answer_o,
    // to the geometry sequencer
    output logic [load_bus_pkg::WIDTH-1:0] load_o,
    output logic go_o,
    output logic [Axes-1:0] mask_o
);
  typedef enum logic [2:0] {
    IDLE,
    CHECK,
    AXIS,
    LENGTH,
    DECIDE
  } state_e;

  // Steps within a state at which halfwords are taken.
  localparam logic [4:0] TAKE_DIRECTION = 5'd3;
  localparam logic [4:0] TAKE_FREQUENCY_0 = 5'd7;
  localparam logic [4:0] TAKE_FREQUENCY_1 = 5'd8;
  localparam logic [4:0] TAKE_FREQUENCY_2 = 5'd11;
  localparam logic [4:0] TAKE_COUNT_0 = 5'd15;
  localparam logic [4:0] TAKE_COUNT_1 = 5'd16;
  localparam logic [4:0] TAKE_LENGTH_0 = 5'd3;
  localparam logic [4:0] TAKE_LENGTH_1 = 5'd4;
  localparam logic [4:0] TAKE_LENGTH_2 = 5'd7;

  state_e        state_q;
  logic   [ 4:0] step_q;
  logic   [ 7:0] rest_q;  // masked axes from axis_q on
  logic   [ 2:0] axis_q;
  logic          busy_q;
  logic          closed_q;
  logic          bad_mask_q;

  // The halfword taken, on its way to the chains.
  logic   [15:0] raw_q;
  logic          frequency_q;
  logic          frequency_top_q;
  logic          count_q;
  logic          length_q;
  logic   [ 2:0] raw_axis_q;

  // Judgement.
  logic          negative_q;
  logic          carry_q;  // carry of the serial negation
  logic          frequency_any_q;  // the frequency has had a one so far
  logic          length_any_q;
  logic          bad_q;

  // Signals of the registers.
  logic          start;
  logic   [ 7:0] mask;
  logic   [31:0] data;
  logic   [ 9:0] address_q;
  logic          done_q;
  logic          error_q;
  logic   [ 7:0] reason_q;

  assign start = start_i[start_pkg::START];
  assign mask = start_pkg::mask(start_i);
  assign data = start_pkg::data(start_i);
  assign answer_o = start_answer_pkg::pack(address_q, done_q, error_q, reason_q);

  always_ff @(posedge clk_i) begin : p_loader
    logic        closed;
    logic        refused;
    logic        axis_done;
    logic        axis_last;
    logic        take_high;
    logic        raw_any;
    logic [15:0] negated;
    logic [ 3:0] target;

    // The state does not change at rest, once done_q and go_o have fallen again.
    if (rst_i || start || state_q != IDLE || done_q) begin
      // A fault that came in the meantime counts: the move must not wait for FAULT to be cleared.
      closed = closed_q || (state_q == DECIDE && closed_i);
      refused = bad_mask_q || closed || busy_q || bad_q;
      axis_last = axis_q == 3'd7;
      axis_done = !rest_q[0] || step_q == TAKE_COUNT_1;
      take_high = (state_q == AXIS) ? (step_q == TAKE_FREQUENCY_1 || step_q == TAKE_COUNT_1) : step_q == TAKE_LENGTH_1;
      raw_any = raw_q != 16'd0;
      negated = (raw_q ^ {16{negative_q && frequency_q}}) + {15'd0, carry_q && frequency_q};

      // The pipeline's stages in reverse order: each before the one that feeds it.
      target = count_q ? load_target_pkg::COUNT : load_target_pkg::INCREMENT;
      load_o <= load_bus_pkg::pack(
          (frequency_q || count_q || length_q) && !rst_i,
          length_q ? load_target_pkg::TICKS : load_target_pkg::of_axis(
              raw_axis_q, target
          ),
          negated
      );

      done_q <= state_q == DECIDE && step_q == 5'd7 && !rst_i;
      error_q <= refused || !length_any_q;
      go_o <= state_q == DECIDE && step_q == 5'd7 && !refused && length_any_q && !rst_i;
      if (bad_mask_q) reason_q <= card_map_pkg::REFUSE_BAD_VALUE;
      else if (closed) reason_q <= card_map_pkg::REFUSE_FAULTED;
      else if (busy_q) reason_q <= card_map_pkg::REFUSE_BUSY;
      else reason_q <= card_map_pkg::REFUSE_BAD_VALUE;

      if (state_q == CHECK && step_q != 5'd7) {busy_q, closed_q} <= {busy_i, closed_i};
      if (state_q == CHECK) bad_mask_q <= mask == 8'd0 || (mask >> Axes) != 8'd0;
      if (state_q == IDLE) begin
        bad_q        <= 1'b0;
        length_any_q <= 1'b0;
      end
      // A frequency above 2^40: bit 40 is bit 8 of its third halfword.
      if (frequency_q && frequency_top_q && raw_q[8] && (frequency_any_q || raw_q[7:0] != 8'd0)) bad_q <= 1'b1;
      if (count_q && raw_any && !frequency_any_q) bad_q <= 1'b1;
      if (length_q && raw_any) length_any_q <= 1'b1;

      if (state_q == AXIS && step_q == TAKE_DIRECTION) begin
        negative_q      <= data[0];
        carry_q         <= data[0];
        frequency_any_q <= 1'b0;
      end else if (frequency_q) begin
        carry_q         <= carry_q && !raw_any;
        frequency_any_q <= frequency_any_q || raw_any;
      end

      raw_q <= take_high ? data[31:16] : data[15:0];
      raw_axis_q <= axis_q;
      frequency_top_q <= step_q == TAKE_FREQUENCY_2;
      frequency_q     <= state_q == AXIS && rest_q[0] &&
          (step_q == TAKE_FREQUENCY_0 || step_q == TAKE_FREQUENCY_1 || step_q == TAKE_FREQUENCY_2);
      count_q <= state_q == AXIS && rest_q[0] && (step_q == TAKE_COUNT_0 || step_q == TAKE_COUNT_1);
      length_q <= state_q == LENGTH && (step_q == TAKE_LENGTH_0 || step_q == TAKE_LENGTH_1 || step_q == TAKE_LENGTH_2);

      if (state_q == LENGTH) begin
        address_q <= step_q[2] ? card_map_pkg::ADDR_LENGTH_HI[11:2] : card_map_pkg::ADDR_LENGTH_LO[11:2];
      end else begin
        case (step_q[3:2])
          2'd0: address_q <= card_map_pkg::ADDR_DIRECTION[11:2] - {5'd0, axis_q, 2'd0};
          2'd1: address_q <= card_map_pkg::ADDR_FREQUENCY_LO[11:2] - {5'd0, axis_q, 2'd0};
          2'd2: address_q <= card_map_pkg::ADDR_FREQUENCY_HI[11:2] - {5'd0, axis_q, 2'd0};
          default: address_q <= card_map_pkg::ADDR_COUNT[11:2] - {5'd0, axis_q, 2'd0};
        endcase
      end

      if (state_q == CHECK) begin
        rest_q <= mask;
        axis_q <= 3'd0;
        mask_o <= mask[Axes-1:0];
      end else if (state_q == AXIS && axis_done) begin
        rest_q <= {1'b0, rest_q[7:1]};
        axis_q <= axis_q + 3'd1;
      end

      step_q <= step_q + 5'd1;
      case (state_q)
        IDLE: begin
          step_q <= 5'd0;
          if (start) state_q <= CHECK;
        end
        // Long enough for a command that was just committed to make the card busy.
        CHECK: begin
          if (step_q == 5'd7) begin
            step_q  <= 5'd0;
            state_q <= refused ? DECIDE : AXIS;
          end
        end
        AXIS: begin
          if (axis_done) begin
            step_q <= 5'd0;
            if (axis_last) state_q <= LENGTH;
          end
        end
        LENGTH: begin
          if (step_q == TAKE_LENGTH_2) begin
            step_q  <= 5'd0;
            state_q <= DECIDE;
          end
        end
        default: if (step_q == 5'd7) state_q <= IDLE;
      endcase

      if (rst_i) begin
        state_q     <= IDLE;
        frequency_q <= 1'b0;
        count_q     <= 1'b0;
        length_q    <= 1'b0;
      end
    end
  end
endmodule

`default_nettype wire
