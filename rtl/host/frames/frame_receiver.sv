// Takes a request's bytes: undoes the stuffing, keeps the header, puts the rest into the RAM. At the frame's end it
// says whether the frame is valid: its CRC is good, and its length fits kind and count (docs/reference/frames.md).
// Bytes come at least 10 clocks apart, so that each has passed the CRC before the next.
`default_nettype none
module frame_receiver (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic listen_i,  // low: a frame with a byte in this clock is dropped
    input wire logic restart_i,  // the bytes of the frame received so far are dropped
    input wire logic received_i,  // event
    input wire logic [7:0] byte_i,
    input wire logic [15:0] epoch_i,
    // CRC
    output logic crc_clear_o,
    output logic crc_start_o,
    output logic [7:0] byte_o,  // byte without stuffing
    input wire logic crc_whole_i,
    // RAM
    output logic [7:0] place_o,  // place of the byte in the frame; written with crc_start_o
    // the request: valid from frame_o until the next frame
    output logic frame_o,
    output logic [1:0] kind_o,
    output logic fixed_o,
    output logic [5:0] count_o,
    output logic malformed_o,
    output logic [15:0] number_o,
    output logic epoch_good_o,
    output logic [9:0] address_o  // word address
);
  localparam logic [7:0] END = 8'hC0;
  localparam logic [7:0] ESCAPE = 8'hDB;
  localparam logic [7:0] ESCAPED_END = 8'hDC;
  localparam logic [7:0] ESCAPED_ESCAPE = 8'hDD;
  // 8 bytes of header, 59 words, the CRC.
  localparam logic [7:0] MOST = 8'd248;

  logic [7:0] place_q;
  logic       escaped_q;
  logic       bad_q;
  logic       large_q;  // the count has more than six bits
  logic       strange_q;  // bits are set that no request has
  logic       ends;
  logic       escape;
  logic       unescaped;
  logic       add;
  logic       wrong;

  assign ends = received_i && byte_i == END;
  assign escape = byte_i == ESCAPE;
  assign unescaped = byte_i == ESCAPED_END || byte_i == ESCAPED_ESCAPE;
  assign wrong = !listen_i || (escaped_q && !unescaped) || place_q == MOST;
  // A byte that is stored at an end, or after a wrong byte, is never used.
  assign add = received_i && !escape && !wrong;

  assign byte_o = !escaped_q ? byte_i : byte_i[0] ? ESCAPE : END;
  assign crc_start_o = add;
  assign crc_clear_o = listen_i && ends;
  assign place_o = place_q;

  always_ff @(posedge clk_i) begin
    if (received_i) begin
      escaped_q <= escape;
      bad_q <= bad_q || wrong;
    end
    if (add) place_q <= place_q + 8'd1;
    if (rst_i || restart_i || ends) begin
      escaped_q <= 1'b0;
      bad_q <= 1'b0;
      place_q <= 8'd0;
    end
  end

  always_ff @(posedge clk_i) begin
    if (add && place_q[7:3] == 5'd0) begin
      unique case (place_q[2:0])
        3'd0: begin
          kind_o <= byte_o[1:0];
          fixed_o <= byte_o[4];
          strange_q <= {byte_o[7:5], byte_o[3:2]} != 5'd0;
        end
        3'd1: {large_q, count_o} <= {byte_o[7:6] != 2'd0, byte_o[5:0]};
        3'd2: number_o[7:0] <= byte_o;
        3'd3: number_o[15:8] <= byte_o;
        3'd4: epoch_good_o <= byte_o == epoch_i[7:0];
        3'd5: epoch_good_o <= epoch_good_o && byte_o == epoch_i[15:8];
        3'd6: begin
          address_o[5:0] <= byte_o[7:2];
          strange_q <= strange_q || byte_o[1:0] != 2'd0;
        end
        3'd7: begin
          address_o[9:6] <= byte_o[3:0];
          strange_q <= strange_q || byte_o[7:4] != 4'd0;
        end
      endcase
    end
  end

  logic writes;
  logic long_enough;
  logic good;

  assign writes = kind_o == 2'd3;
  // Header, data, CRC.
  assign long_enough = {1'b0, place_q} == {1'b0, writes ? count_o : 6'd0, 2'b00} + 9'd12;
  assign good = crc_whole_i && long_enough && !(writes && large_q) && !bad_q && !escaped_q && listen_i;

  always_ff @(posedge clk_i) frame_o <= ends && good && !restart_i && !rst_i;

  // ASK and CONNECT have no words, the others 1 to 59; the words of a write are bounded by its length.
  assign malformed_o = strange_q || (kind_o[1] ? count_o == 6'd0 || count_o[5:2] == 4'b1111 : count_o != 6'd0) ||
      large_q;
endmodule
`default_nettype wire
