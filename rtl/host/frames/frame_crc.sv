// CRC-32 of a frame, one bit per clock: of an incoming frame or of an outgoing one, since the two never come at the
// same time. A byte taken at c has passed at c+9. The bytes of the CRC itself leave by shifting without feedback: each
// appears inverted at the low end.
`default_nettype none
module frame_crc (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic clear_i,
    input wire logic start_i,  // takes the byte; not while busy
    input wire logic feed_i,  // 0: the byte only shifts
    input wire logic [7:0] byte_i,
    output logic busy_o,
    output logic whole_o,  // data and their correct CRC have passed
    output logic [7:0] byte_o  // the CRC's next byte
);
  localparam logic [31:0] POLYNOMIAL = 32'hEDB88320;
  localparam logic [31:0] RESIDUE = 32'hDEBB20E3;

  logic [31:0] state_q;
  logic [ 7:0] shift_q;
  logic [ 3:0] count_q;  // 8 to 15 while a byte passes
  logic        feed_q;
  logic        feedback;

  assign feedback = feed_q && (state_q[0] ^ shift_q[0]);
  assign busy_o   = count_q[3];
  assign whole_o  = state_q == RESIDUE;
  assign byte_o   = ~state_q[7:0];

  always_ff @(posedge clk_i) begin
    if (busy_o) begin
      count_q <= count_q + 4'd1;
      shift_q <= shift_q >> 1;
      state_q <= {1'b0, state_q[31:1]} ^ (feedback ? POLYNOMIAL : 32'd0);
    end
    if (start_i) begin
      count_q <= 4'd8;
      shift_q <= byte_i;
      feed_q  <= feed_i;
    end
    if (clear_i || rst_i) begin
      count_q <= 4'd0;
      state_q <= '1;
    end
  end
endmodule
`default_nettype wire
