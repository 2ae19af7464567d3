// Sends a reply: header, state and words from the RAM, the CRC, the end. Each byte is stuffed if it must be. A byte is
// offered 12 clocks after the one before it was taken, or after start_i; the second half of a stuffed byte is offered
// at once.
`default_nettype none
module frame_sender (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic start_i,
    input wire logic stop_i,  // the rest of the reply is not sent
    // the reply: keeps its values from start_i to done_o
    input wire logic [63:0] header_i,  // byte 0 lowest
    input wire logic [5:0] count_i,  // words after the state
    output logic done_o,  // event
    // RAM
    output logic [7:0] place_o,
    input wire logic [7:0] ram_i,  // byte at the place of one clock ago
    // CRC
    output logic crc_start_o,
    output logic crc_feed_o,
    output logic [7:0] crc_byte_o,
    input wire logic crc_busy_i,
    input wire logic [7:0] crc_i,
    // to the port; combinational from registers
    output logic valid_o,
    output logic [7:0] byte_o,
    input wire logic ready_i
);
  localparam logic [7:0] END = 8'hC0;
  localparam logic [7:0] ESCAPE = 8'hDB;
  localparam logic [7:0] ESCAPED_END = 8'hDC;
  localparam logic [7:0] ESCAPED_ESCAPE = 8'hDD;

  localparam logic [1:0] HEADER = 2'd0;
  localparam logic [1:0] WORDS = 2'd1;
  localparam logic [1:0] CRC = 2'd2;
  localparam logic [1:0] FINISH = 2'd3;

  localparam int FETCH = 0;  // the RAM reads
  localparam int LOAD = 1;
  localparam int PASS = 2;  // the byte passes the CRC
  localparam int OFFER = 3;

  logic [3:0] at_q;  // one-hot; none: at rest
  logic [1:0] section_q;
  logic [7:0] place_q;  // place within the section
  logic [7:0] byte_q;
  logic       second_q;  // second half of a stuffed byte
  logic       stuffed;
  logic       taken;
  logic       last;
  logic [7:0] chosen;
  logic [7:0] header;  // byte of the header at this place
  logic [2:0] low;

  assign stuffed = (byte_q == END || byte_q == ESCAPE) && section_q != FINISH;
  assign taken   = at_q[OFFER] && ready_i && (!stuffed || second_q);
  assign done_o  = taken && section_q == FINISH;
  assign place_o = place_q;

  assign low    = place_q[2:0];
  assign header = header_i[{low, 3'b000}+:8];

  always_comb begin
    chosen = END;
    last   = (low | 3'd4) == 3'd7;  // last byte of the CRC
    if (section_q == HEADER) begin
      chosen = header;
      last   = low == 3'd7;
    end
    if (section_q == WORDS) begin
      chosen = ram_i;
      last   = place_q == {count_i + 6'd4, 2'b11};
    end
    if (section_q == CRC) chosen = crc_i;
  end

  assign crc_start_o = at_q[LOAD];
  assign crc_feed_o = !section_q[1];
  assign crc_byte_o = chosen;
  assign valid_o = at_q[OFFER];
  assign byte_o = !stuffed ? byte_q : !second_q ? ESCAPE : byte_q == END ? ESCAPED_END : ESCAPED_ESCAPE;

  always_ff @(posedge clk_i) begin
    at_q[FETCH] <= start_i || (taken && !done_o);
    at_q[LOAD]  <= at_q[FETCH];
    at_q[PASS]  <= at_q[LOAD] || (at_q[PASS] && crc_busy_i);
    at_q[OFFER] <= (at_q[PASS] && !crc_busy_i) || (at_q[OFFER] && !taken);
    if (rst_i || stop_i) at_q <= '0;
  end

  always_ff @(posedge clk_i) begin
    if (at_q[LOAD]) byte_q <= chosen;
    second_q <= at_q[OFFER] && (second_q || ready_i);
    if (taken) begin
      place_q   <= last ? 8'd0 : place_q + 8'd1;
      section_q <= section_q + 2'(last);
    end
    if (start_i) begin
      place_q   <= 8'd0;
      section_q <= HEADER;
    end
  end
endmodule
`default_nettype wire
