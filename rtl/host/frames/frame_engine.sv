// Requests in a stream of bytes, replies in another, accesses at the inner port: docs/reference/frames.md.
// One request at a time; what comes while it runs or is replied to is dropped. One block RAM of 512 bytes: the lower half
// for a request, the upper for the reply, whose words stay for a repeat.
`default_nettype none
module frame_engine (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic restart_i,  // event: a new connection (a break)
    input wire logic [8:0] byte_i,  // {valid, byte}, 10 clocks apart at least
    // replies; combinational from registers
    output logic valid_o,
    output logic [7:0] byte_o,
    input wire logic ready_i,
    // to the inner port
    output logic [47:0] access_o,  // {request, write, partial, 0, address, data}
    input wire logic ack_i,
    input wire logic error_i,
    input wire logic [31:0] data_i
);
  localparam logic [1:0] WRITE = 2'd3;

  logic        listen_o;
  logic        start_o;
  logic        execute_o;
  logic        executed;
  logic        send_o;
  logic        sending_o;
  logic        sent;
  logic [15:0] epoch_o;
  logic [15:0] last_o;
  logic [ 2:0] result_o;
  logic        repeats_o;
  logic        frame_o;
  logic [ 1:0] kind_o;
  logic        fixed_o;
  logic [ 5:0] count_o;
  logic        malformed_o;
  logic [15:0] number_o;
  logic        epoch_good_o;
  logic [ 9:0] address_o;

  frame_session session (
      .*,
      .frame_i(frame_o),
      .kind_i(kind_o),
      .malformed_i(malformed_o),
      .number_i(number_o),
      .epoch_good_i(epoch_good_o),
      .executed_i(executed),
      .sent_i(sent)
  );

  logic       busy_o;
  logic       whole_o;
  logic       crc_feed_o;
  logic [7:0] crc_out;
  logic       crc_clear_o;
  logic       receive_add;
  logic [7:0] received;
  logic [7:0] receive_place;
  logic       send_add;
  logic [7:0] crc_byte_o;

  frame_crc crc (
      .*,
      .clear_i(crc_clear_o || sent || restart_i),
      .start_i(receive_add || send_add),
      .feed_i (!sending_o || crc_feed_o),
      .byte_i (sending_o ? crc_byte_o : received),
      .byte_o (crc_out)
  );

  frame_receiver receiver (
      .*,
      .listen_i(listen_o),
      .epoch_i(epoch_o),
      .crc_start_o(receive_add),
      .byte_o(received),
      .crc_whole_i(whole_o),
      .place_o(receive_place)
  );

  logic [5:0] made_o;
  logic       refused_o;
  logic       read_o;
  logic [7:0] execute_place;
  logic       store_o;
  logic [7:0] execute_byte;
  logic [7:0] send_place;
  logic [7:0] ram_q;

  frame_executor executor (
      .*,
      .start_i(start_o),
      .execute_i(execute_o),
      .write_i(kind_o == WRITE),
      .fixed_i(fixed_o),
      .count_i(count_o),
      .address_i(address_o),
      .done_o(executed),
      .place_o(execute_place),
      .byte_o(execute_byte),
      .byte_i(ram_q)
  );

  // Byte 0 lowest.
  logic [63:0] header;
  logic        with_words;

  assign with_words   = repeats_o && read_o;
  assign header[7:0]  = {2'b10, with_words, 2'b00, repeats_o && refused_o ? 3'd1 : result_o};
  assign header[63:8] = {epoch_o, last_o, number_o, 2'b00, repeats_o ? made_o : 6'd0};

  frame_sender sender (
      .*,
      .start_i(send_o),
      .stop_i(restart_i),
      .header_i(header),
      .count_i(with_words ? made_o : 6'd0),
      .done_o(sent),
      .place_o(send_place),
      .ram_i(ram_q),
      .crc_start_o(send_add),
      .crc_busy_i(busy_o),
      .crc_i(crc_out)
  );

  // No place is read in the clock in which it is written.
  (* no_rw_check *) logic [7:0] memory[0:511];

  always_ff @(posedge clk_i) begin
    // What stands at the receiver while no byte comes goes to the place of the next one.
    if (store_o) memory[{1'b1, execute_place}] <= execute_byte;
    else memory[{1'b0, receive_place}] <= received;
    ram_q <= memory[{sending_o, sending_o?send_place : execute_place}];
  end
endmodule
`default_nettype wire
