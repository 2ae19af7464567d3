// Requests in a stream of bytes, replies in another stream, accesses at the inner port: docs/reference/frames.md. One
// request is handled at a time; bytes that arrive while it runs or is replied to are dropped. One block RAM has 512
// bytes: the lower half for a request, the upper half for the reply, whose words stay there for a repeat.
`default_nettype none
module frame_engine (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic restart_i,  // event: a new connection (a break)
    input wire logic received_i,  // event; at least 10 clocks apart
    input wire logic [7:0] byte_i,  // with received_i
    // replies; combinational from registers
    output logic valid_o,
    output logic [7:0] byte_o,
    input wire logic ready_i,
    // to the inner port
    output logic [register_access_pkg::WIDTH-1:0] access_o,
    input wire logic [register_answer_pkg::WIDTH-1:0] answer_i
);
  localparam logic [1:0] WRITE = 2'd3;

  logic        listen;
  logic        start;
  logic        execute;
  logic        new_session;
  logic        executed;
  logic        send;
  logic        sending;
  logic        sent;
  logic [15:0] epoch;
  logic [15:0] last;
  logic [ 2:0] result;
  logic        repeats;
  logic        frame;
  logic [ 1:0] kind;
  logic        fixed;
  logic [ 5:0] count;
  logic        malformed;
  logic [15:0] number;
  logic        epoch_good;
  logic [ 9:0] address;

  frame_session session (
      .clk_i,
      .rst_i,
      .restart_i,
      .frame_i(frame),
      .kind_i(kind),
      .malformed_i(malformed),
      .number_i(number),
      .epoch_good_i(epoch_good),
      .executed_i(executed),
      .sent_i(sent),
      .listen_o(listen),
      .start_o(start),
      .execute_o(execute),
      .new_o(new_session),
      .send_o(send),
      .sending_o(sending),
      .epoch_o(epoch),
      .last_o(last),
      .result_o(result),
      .repeats_o(repeats)
  );

  logic       busy;
  logic       whole;
  logic       crc_feed;
  logic [7:0] crc_out;
  logic       crc_clear;
  logic       receive_add;
  logic [7:0] received;
  logic [7:0] receive_place;
  logic       send_add;
  logic [7:0] crc_byte;

  frame_crc crc (
      .clk_i,
      .rst_i,
      .clear_i(crc_clear || sent || restart_i),
      .start_i(receive_add || send_add),
      .feed_i (!sending || crc_feed),
      .byte_i (sending ? crc_byte : received),
      .busy_o (busy),
      .whole_o(whole),
      .byte_o (crc_out)
  );

  frame_receiver receiver (
      .clk_i,
      .rst_i,
      .listen_i(listen),
      .restart_i,
      .received_i,
      .byte_i,
      .epoch_i(epoch),
      .crc_clear_o(crc_clear),
      .crc_start_o(receive_add),
      .byte_o(received),
      .crc_whole_i(whole),
      .place_o(receive_place),
      .frame_o(frame),
      .kind_o(kind),
      .fixed_o(fixed),
      .count_o(count),
      .malformed_o(malformed),
      .number_o(number),
      .epoch_good_o(epoch_good),
      .address_o(address)
  );

  logic [5:0] made;
  logic       refused;
  logic       read;
  logic [7:0] execute_place;
  logic       store;
  logic [7:0] execute_byte;
  logic [7:0] send_place;
  logic [7:0] ram_q;

  frame_executor executor (
      .clk_i,
      .rst_i,
      .start_i(start),
      .execute_i(execute),
      .new_i(new_session),
      .write_i(kind == WRITE),
      .fixed_i(fixed),
      .count_i(count),
      .address_i(address),
      .done_o(executed),
      .made_o(made),
      .refused_o(refused),
      .read_o(read),
      .place_o(execute_place),
      .store_o(store),
      .byte_o(execute_byte),
      .byte_i(ram_q),
      .access_o,
      .answer_i
  );

  // The reply's header, byte 0 lowest.
  logic [63:0] header;
  logic        with_words;

  assign with_words   = repeats && read;
  assign header[7:0]  = {2'b10, with_words, 2'b00, repeats && refused ? 3'd1 : result};
  assign header[63:8] = {epoch, last, number, 2'b00, repeats ? made : 6'd0};

  frame_sender sender (
      .clk_i,
      .rst_i,
      .start_i(send),
      .stop_i(restart_i),
      .header_i(header),
      .count_i(with_words ? made : 6'd0),
      .done_o(sent),
      .place_o(send_place),
      .ram_i(ram_q),
      .crc_start_o(send_add),
      .crc_feed_o(crc_feed),
      .crc_byte_o(crc_byte),
      .crc_busy_i(busy),
      .crc_i(crc_out),
      .valid_o,
      .byte_o,
      .ready_i
  );

  // No place is read in the clock in which it is written.
  (* no_rw_check *) logic [7:0] memory[0:511];

  always_ff @(posedge clk_i) begin
    // While no byte arrives, the receiver's value is written to the place of the next byte, which overwrites it.
    if (store) memory[{1'b1, execute_place}] <= execute_byte;
    else memory[{1'b0, receive_place}] <= received;
    ram_q <= memory[{sending, sending?send_place : execute_place}];
  end
endmodule
`default_nettype wire
