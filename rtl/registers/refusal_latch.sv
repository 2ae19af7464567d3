`default_nettype none

// The sticky registers: FAULT and REFUSAL.
// clear_fault_i (ones for the bits to clear) goes out as clear_fault_o a clock later; the sources have two more
// clocks to drop their levels before FAULT itself is cleared, so that an old level does not set it again.
// REFUSAL keeps the first refusal; one that comes in the very clock of the clear is kept, not lost.
module refusal_latch (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic [ 9:0] fault_i,
    input  wire logic [ 9:0] clear_fault_i,
    input  wire logic        clear_refusal_i,
    input  wire logic        refuse_i,
    input  wire logic [ 7:0] reason_i,
    input  wire logic [11:0] address_i,
    input  wire logic        door_refuse_i,
    input  wire logic [ 7:0] door_reason_i,
    input  wire logic [ 7:0] door_number_i,
    output logic      [ 9:0] fault_o,
    output logic      [ 9:0] clear_fault_o,
    output logic             refused_o,
    output logic      [27:0] refusal_o
);

  logic [9:0] clear_fault_q;
  logic [9:0] dropping_q;
  logic [9:0] dropped_q;
  logic [9:0] fault_q;

  always_ff @(posedge clk_i) begin
    clear_fault_q <= clear_fault_i;
    dropping_q <= clear_fault_q;
    dropped_q <= dropping_q;
    fault_q <= (fault_q & ~dropped_q) | fault_i;
    if (rst_i) begin
      clear_fault_q <= '0;
      dropping_q <= '0;
      dropped_q <= '0;
      fault_q <= '0;
    end
  end

  logic        refused_q;
  logic [27:0] refusal_q;

  always_ff @(posedge clk_i) begin
    // A refusal by the door and one by the register file never meet: the door refuses a word while its write waits.
    if ((refuse_i || door_refuse_i) && (!refused_q || clear_refusal_i)) begin
      refused_q <= 1'b1;
      refusal_q <= door_refuse_i ? {address_i, door_number_i, door_reason_i} : {address_i, 8'd0, reason_i};
    end else if (clear_refusal_i) begin
      refused_q <= 1'b0;
      refusal_q <= '0;
    end
    if (rst_i) begin
      refused_q <= 1'b0;
      refusal_q <= '0;
    end
  end

  assign fault_o = fault_q;
  assign clear_fault_o = clear_fault_q;
  assign refused_o = refused_q;
  assign refusal_o = refusal_q;

endmodule

`default_nettype wire
