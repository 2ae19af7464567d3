// Watches the link to the session that writes: the session whose word of the stream, or whose LINK_TIMEOUT, was
// accepted last. Each accepted access of this session restarts the time of LINK_TIMEOUT. When the time has passed,
// lost_o rises and stays high until LINK_TIMEOUT is written. Accesses of other ports, of a later session at the same
// port, and those without a session do not count.
//
// The time lasts between LINK_TIMEOUT and LINK_TIMEOUT + 1 units; units are those of the time counter.
`default_nettype none

module link_watch (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [register_access_pkg::WIDTH-1:0] access_i,
    input wire logic [register_answer_pkg::WIDTH-1:0] answer_i,  // answer to access_i
    input wire logic unit_i,  // a bit of the time counter that changes once per unit
    output logic gone_o,  // the session that wrote has ended: another one is at its port
    output logic lost_o
);
  logic        ack;
  logic        accepted;
  logic        sets;  // LINK_TIMEOUT is written
  logic        claims;
  logic        feeds;
  logic        at_port;  // access of a session at the port of the writing session
  logic        begins;  // a new session begins at that port
  logic [31:0] data;
  logic [15:0] time_set;
  logic        unit;
  logic [15:0] left_d;
  logic        none_left;
  logic        unit_q;
  logic [ 1:0] writer_q;
  logic        written_q;  // there is, or was, a writing session
  logic [15:0] timeout_q;
  logic        watches_q;
  logic [15:0] left_q;

  assign ack = answer_i[register_answer_pkg::ACK];
  assign accepted = ack && !answer_i[register_answer_pkg::ERROR];
  assign sets = setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_LINK_TIMEOUT);
  assign claims = sets || (accepted && access_i[register_access_pkg::WRITE] && register_access_pkg::word(
      access_i
  ) == card_map_pkg::ADDR_STREAM[11:2]);
  assign at_port = register_access_pkg::port(access_i) == writer_q && access_i[register_access_pkg::OF_SESSION];
  assign begins = at_port && access_i[register_access_pkg::NEW_SESSION];
  // Nothing is watched before the first session that writes, so it need not be asked for here.
  assign feeds = claims || (accepted && at_port && !begins && !gone_o);
  assign data = setting_bus_pkg::data(setting_i);
  assign time_set = data[15:0];
  assign unit = unit_i != unit_q;
  // One subtraction: its borrow is the comparison with 0.
  assign {none_left, left_d} = {1'b0, left_q} - 17'd1;

  always_ff @(posedge clk_i) begin
    unit_q <= unit_i;
    if (ack && begins && written_q) gone_o <= 1'b1;
    if (claims) begin
      writer_q <= register_access_pkg::port(access_i);
      written_q <= 1'b1;
      gone_o <= 1'b0;
    end
    if (feeds) left_q <= sets ? time_set : timeout_q;
    else if (unit) left_q <= left_d;
    if (watches_q && unit && none_left && !feeds) lost_o <= 1'b1;
    if (sets) begin
      timeout_q <= time_set;
      watches_q <= time_set != 16'd0;
      lost_o <= 1'b0;
    end
    if (rst_i) begin
      unit_q <= 1'b0;
      written_q <= 1'b0;
      gone_o <= 1'b0;
      watches_q <= 1'b0;
      lost_o <= 1'b0;
    end
  end

  logic unused;
  assign unused = &{1'b0, data, access_i, answer_i};
endmodule

`default_nettype wire
