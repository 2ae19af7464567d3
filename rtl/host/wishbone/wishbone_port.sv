// Wishbone B4 slave in front of the card's inner port: classic, or pipelined with one access at a time. The request is
// registered, so a master may give an access up by withdrawing CYC (classic: or STB). The access is still made, since
// the inner port has it, but it is not answered.
`default_nettype none
module wishbone_port #(
    parameter int Pipelined = 0  // 1: pipelined
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cyc_i,
    input wire logic stb_i,
    input wire logic we_i,
    input wire logic [11:0] adr_i,  // bytes
    input wire logic [3:0] sel_i,
    input wire logic [31:0] dat_i,
    output logic [31:0] dat_o,
    output logic ack_o,
    output logic err_o,
    output logic stall_o,  // 0 if the port is classic
    // to the inner port
    output logic [register_access_pkg::WIDTH-1:0] access_o,
    input wire logic [register_answer_pkg::WIDTH-1:0] answer_i
);
  if (Pipelined < 0 || Pipelined > 1) begin : gen_wrong_kind
    ERROR_Pipelined_must_be_0_or_1 error ();
  end

  logic        busy_q;
  logic        wanted_q;  // the master still waits for the answer
  logic        request_q;
  logic        write_q;
  logic        partial_q;
  logic [11:0] address_q;
  logic [31:0] data_q;
  logic        stays;
  logic        take;

  // A classic master's STB stays high until the answer, including the clock of the answer. A pipelined master's STB is
  // taken by a low STALL. STALL is high in the clock after a reset, since a card may hold the port in reset one clock
  // longer than its hosts.
  if (Pipelined != 0) begin : gen_pipelined
    logic was_reset_q;
    always_ff @(posedge clk_i) was_reset_q <= rst_i;
    assign take = cyc_i && stb_i && !stall_o;
    assign stays = cyc_i;
    assign stall_o = busy_q || was_reset_q;
  end else begin : gen_classic
    assign take = cyc_i && stb_i && !busy_q && !ack_o && !err_o;
    assign stays = cyc_i && stb_i;
    assign stall_o = 1'b0;
  end

  logic ack;
  logic error;

  assign access_o = register_access_pkg::pack(request_q, write_q, partial_q, address_q, data_q);
  assign ack = answer_i[register_answer_pkg::ACK];
  assign error = answer_i[register_answer_pkg::ERROR];

  always_ff @(posedge clk_i) begin
    request_q <= take;
    wanted_q  <= take || (wanted_q && stays);
    if (ack) busy_q <= 1'b0;
    if (take) begin
      busy_q <= 1'b1;
      write_q <= we_i;
      partial_q <= we_i && sel_i != 4'b1111;
      address_q <= adr_i;
      data_q <= dat_i;
    end
    if (rst_i) begin
      request_q <= 1'b0;
      busy_q <= 1'b0;
    end
  end

  always_ff @(posedge clk_i) begin
    ack_o <= ack && !error && wanted_q && stays && !rst_i;
    err_o <= ack && error && wanted_q && stays && !rst_i;
    if (ack) dat_o <= register_answer_pkg::data(answer_i);
  end
endmodule
`default_nettype wire
