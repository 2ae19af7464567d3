// Command queue: halfwords in block RAM, readable only once their whole command is committed.
//
// A write at c belongs to the command under way. A commit makes the halfwords written in earlier clocks readable; a
// drop discards them (and has priority over a write or commit in the same clock). word_o at c+2 is the halfword that
// read_i took at c. Reads may follow each other in every clock; a read while empty_o is ignored. empty_o includes a
// read at c+1 and a commit at c+2; room_o includes reads, writes and drops at c+2. The writer keeps within the room_o
// before its command.
`default_nettype none
module halfword_queue #(
    parameter int Depth = 4096  // halfwords, 2 to 32,768
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic clear_i,
    input wire logic drop_i,
    input wire logic commit_i,
    input wire logic write_i,
    input wire logic [15:0] halfword_i,
    input wire logic read_i,
    output logic [15:0] word_o,
    output logic empty_o,
    output logic [15:0] room_o
);

  // A depth below 2 must elaborate as far as the message that refuses it.
  localparam int AddressWidth = Depth > 1 ? $clog2(Depth) : 1;
  localparam logic [AddressWidth:0] DEPTH = (AddressWidth + 1)'(Depth);
  localparam logic [AddressWidth-1:0] LAST = AddressWidth'(Depth - 1);

  // A pointer is an address with the parity of its laps above it: equal addresses mean empty or full. A lap of a power
  // of two needs no comparison.
  function automatic logic [AddressWidth:0] next(input logic [AddressWidth:0] pointer);
    next = pointer + 1'b1;
    if (Depth != 2 ** AddressWidth && pointer[AddressWidth-1:0] == LAST) begin
      next = {~pointer[AddressWidth], {AddressWidth{1'b0}}};
    end
  endfunction

  logic [AddressWidth:0] write_q;
  logic [AddressWidth:0] commit_q;
  logic [AddressWidth:0] read_q;
  logic [AddressWidth:0] read_next_q;
  logic take;
  logic reset;

  assign take  = read_i && !empty_o;
  assign reset = rst_i || clear_i;

  // In slices, so that each block RAM is deep and narrow: then no or few RAMs are selected between after their slow
  // output. The largest RAM assumed has 16,384 bits, each with its own address.
  // Nothing is read before it is committed, so no location is read and written in one clock.
  localparam int Slice = Depth <= 4096 ? 4 : Depth <= 8192 ? 2 : 1;
  for (genvar n = 0; n < 16 / Slice; n++) begin : gen_slice
    (* no_rw_check *) logic [Slice-1:0] memory[0:Depth-1];
    logic [Slice-1:0] memory_q;

    always_ff @(posedge clk_i) begin
      if (write_i) memory[write_q[AddressWidth-1:0]] <= halfword_i[Slice*n+:Slice];
      if (take) memory_q <= memory[read_q[AddressWidth-1:0]];
      // A flip-flop without logic right after the RAM.
      word_o[Slice*n+:Slice] <= memory_q;
    end
  end

  always_ff @(posedge clk_i) begin
    if (reset) begin
      write_q <= '0;
      commit_q <= '0;
      read_q <= '0;
      read_next_q <= (AddressWidth + 1)'(1);
    end else begin
      if (drop_i) write_q <= commit_q;
      else if (write_i) write_q <= next(write_q);
      if (commit_i && !drop_i) commit_q <= write_q;
      if (take) begin
        read_q <= read_next_q;
        read_next_q <= next(read_next_q);
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (reset) empty_o <= 1'b1;
    else empty_o <= (take ? read_next_q : read_q) == commit_q;
  end

  logic [AddressWidth:0] ahead;  // read address less write address; negative or 0 in the same lap
  logic [AddressWidth:0] room;

  assign ahead = {1'b0, read_q[AddressWidth-1:0]} - {1'b0, write_q[AddressWidth-1:0]};
  assign room  = read_q[AddressWidth] == write_q[AddressWidth] ? ahead + DEPTH : ahead;

  always_ff @(posedge clk_i) begin
    if (reset) room_o <= 16'(DEPTH);
    else room_o <= 16'(room);
  end

endmodule
`default_nettype wire
