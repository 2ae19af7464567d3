// Soft limits: a pulse is a cause of a stop if it leaves an axis beyond an end of its range, further out than before.
// The host refuses such moves before they start; this block is the last guard.
//
// One axis is examined per clock. Its end on the side of its last pulse comes from a block RAM with a register behind
// it, and is compared with its position. FAULT shows a pulse 3 to Round + 3 clocks after the position. No pulse is
// missed: a pulse in the other direction comes 13 clocks later at the earliest.
//
// Positions count modulo 2^32, and so does the difference to an end. The comparison is right while the axis is less
// than 2^31 pulses away from that end.
`default_nettype none

module soft_limits #(
    parameter int Axes = 4  // 1 to 8
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [axis_observe_pkg::WIDTH*Axes-1:0] axes_i,
    input wire logic clear_i,  // event: FAULT.soft_limit is cleared
    output logic cause_o,  // event
    output logic [3:0] state_o  // in LIMIT_STATE: {1 for the positive end, number of the axis}
);
  localparam int Bits = Axes > 4 ? 3 : 2;  // bits of an axis's number
  localparam int Round = 1 << Bits;  // clocks of a round; absent axes have theirs, too
  localparam logic [11:0] SOFT_MINUS = card_map_pkg::ADDR_SOFT_MINUS;

  logic [    31:0] data;
  logic [     9:0] word;
  logic            sets;  // an end of an axis is written
  logic [Bits-1:0] set_axis;
  logic [Axes-1:0] has_q;
  logic [Axes-1:0] counts;  // a pulse begins; the position includes it from the next clock on
  logic [Axes-1:0] counts_back;
  logic [Axes-1:0] moved_q;  // the axis has moved since it was last examined
  logic [Axes-1:0] back_q;  // the axis's last pulse went backwards
  logic [  Bits:0] reads_q;  // axis whose end is read; the highest bit counts rounds
  logic            clearing_q;  // after a reset the ends are set to 0
  logic [    31:0] end_read_q;
  logic            back_read_q;
  logic [Bits-1:0] looked_at;  // the axis whose end was read
  logic            judges;
  logic [    31:0] end_q;
  logic [    31:0] position_q;
  logic            back_judged_q;
  logic [Bits-1:0] axis_judged_q;
  logic            judges_q;
  logic [    32:0] past;  // position less end; the lowest bit makes the carry
  logic            cause;
  logic [     3:0] place_q;  // end and axis of the cause
  logic            named_q;  // there was a cause since FAULT.soft_limit was cleared

  assign data = setting_bus_pkg::data(setting_i);
  assign word = setting_bus_pkg::word(setting_i);
  assign sets = setting_i[setting_bus_pkg::SET] && word[9:8] == SOFT_MINUS[11:10] && word[4:1] == SOFT_MINUS[6:3];
  assign set_axis = word[5+:Bits];
  assign looked_at = reads_q[Bits-1:0] - Bits'(1);

  logic [Round-1:0] moved;
  logic [Round-1:0] back;
  logic [32*Round-1:0] position;

  for (genvar n = 0; n < Round; n++) begin : gen_axis
    if (n < Axes) begin : gen_present
      assign counts[n] = axes_i[axis_observe_pkg::WIDTH*n+axis_observe_pkg::COUNTS];
      assign counts_back[n] = axes_i[axis_observe_pkg::WIDTH*n+axis_observe_pkg::COUNTS_BACK];
      assign moved[n] = moved_q[n];
      assign back[n] = back_q[n];
      assign position[32*n+:32] = axes_i[axis_observe_pkg::WIDTH*n+axis_observe_pkg::POSITION+:32];

      always_ff @(posedge clk_i) begin
        if (counts[n]) back_q[n] <= counts_back[n];
        moved_q[n] <= has_q[n] && (counts[n] || (moved_q[n] && !(judges && looked_at == Bits'(n))));
        if (rst_i) begin
          back_q[n]  <= 1'b0;
          moved_q[n] <= 1'b0;
        end
      end
    end else begin : gen_absent
      assign moved[n] = 1'b0;
      assign back[n] = 1'b0;
      assign position[32*n+:32] = '0;
    end
  end

  // If the axis has turned since its end was read, that was the other end: the axis waits for the next round.
  assign judges = moved[looked_at] && back[looked_at] == back_read_q;
  // One adder. Backwards: position - end, negative if beyond. Forwards: position - end - 1, negative if not beyond.
  assign past   = {position_q, back_judged_q} + {~end_q, back_judged_q};
  assign cause  = judges_q && past[32] == back_judged_q;

  always_ff @(posedge clk_i) begin
    reads_q <= reads_q + 1'b1;
    if (reads_q == '1) clearing_q <= 1'b0;
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_SOFT_LIMITS)) has_q <= data[Axes-1:0];
    back_read_q <= back[reads_q[Bits-1:0]];
    position_q <= position[32*looked_at+:32];
    back_judged_q <= back_read_q;
    axis_judged_q <= looked_at;
    judges_q <= judges;
    cause_o <= cause;
    place_q <= {!back_judged_q, 3'(axis_judged_q)};
    // In the same clock as FAULT, which is set by cause_o.
    named_q <= cause_o || (named_q && !clear_i);
    if (cause_o && (clear_i || !named_q)) state_o <= place_q;
    else if (clear_i) state_o <= '0;
    if (rst_i) begin
      reads_q <= '0;
      clearing_q <= 1'b1;
      has_q <= card_map_pkg::RESET_SOFT_LIMITS[Axes-1:0];
      judges_q <= 1'b0;
      cause_o <= 1'b0;
      named_q <= 1'b0;
      state_o <= '0;
    end
  end

  // One write port and one read port, with a register behind it.
  logic [31:0] ends[0:2*Round-1];  // for each axis the negative end, then the positive end

  always_ff @(posedge clk_i) begin
    if (sets || clearing_q) ends[clearing_q?reads_q : {set_axis, word[0]}] <= clearing_q ? '0 : data;
    end_read_q <= ends[{reads_q[Bits-1:0], !back[reads_q[Bits-1:0]]}];
    end_q <= end_read_q;
  end

  logic unused;  // bits of absent axes, and fields that are not used here
  assign unused = &{1'b0, word, past[31:0], axes_i};
endmodule

`default_nettype wire
