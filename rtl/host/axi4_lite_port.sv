`default_nettype none

// AXI4-Lite slave in front of the card's inner port.
// A write is taken when address and data are both valid, a read when its address is. If both wait, they take turns.
// Ready answers valid one clock later, for one clock. The access was recorded one clock before its handshake; this is
// safe because a master keeps valid and the signals with it until the handshake.
module axi4_lite_port (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic awvalid_i,
    output logic awready_o,
    input wire logic [11:0] awaddr_i,
    input wire logic wvalid_i,
    output logic wready_o,
    input wire logic [31:0] wdata_i,
    input wire logic [3:0] wstrb_i,
    output logic bvalid_o,
    input wire logic bready_i,
    output logic [1:0] bresp_o,
    input wire logic arvalid_i,
    output logic arready_o,
    input wire logic [11:0] araddr_i,
    output logic rvalid_o,
    input wire logic rready_i,
    output logic [31:0] rdata_o,
    output logic [1:0] rresp_o,
    // to the inner port
    output logic [register_access_pkg::WIDTH-1:0] access_o,
    input wire logic [register_answer_pkg::WIDTH-1:0] answer_i
);

  logic        busy_q;
  logic        request_q;
  logic        write_q;
  logic        partial_q;
  logic [11:0] address_q;
  logic [31:0] data_q;

  logic        ack;

  assign access_o = register_access_pkg::pack(request_q, write_q, partial_q, address_q, data_q);
  assign ack = answer_i[register_answer_pkg::ACK];

  logic write_waits;
  logic read_waits;

  // A new access is taken only if its answer has a place to go.
  assign write_waits = awvalid_i && wvalid_i && !bvalid_o;
  assign read_waits  = arvalid_i && !rvalid_o;

  always_ff @(posedge clk_i) begin
    request_q <= 1'b0;
    awready_o <= 1'b0;
    arready_o <= 1'b0;
    if (busy_q) begin
      if (ack) busy_q <= 1'b0;
    end else if (write_waits && !(read_waits && write_q)) begin
      request_q <= 1'b1;
      awready_o <= 1'b1;
      busy_q <= 1'b1;
      write_q <= 1'b1;
      partial_q <= wstrb_i != 4'b1111;
      address_q <= awaddr_i;
      data_q <= wdata_i;
    end else if (read_waits) begin
      request_q <= 1'b1;
      arready_o <= 1'b1;
      busy_q <= 1'b1;
      write_q <= 1'b0;
      address_q <= araddr_i;
    end
    if (rst_i) begin
      request_q <= 1'b0;
      awready_o <= 1'b0;
      arready_o <= 1'b0;
      busy_q <= 1'b0;
      write_q <= 1'b0;
    end
  end

  assign wready_o = awready_o;

  // Answers: 0 is OKAY, 2 is SLVERR.
  logic write_error_q;
  logic read_error_q;

  always_ff @(posedge clk_i) begin
    if (bready_i) bvalid_o <= 1'b0;
    if (rready_i) rvalid_o <= 1'b0;
    if (ack && write_q) begin
      bvalid_o <= 1'b1;
      write_error_q <= answer_i[register_answer_pkg::ERROR];
    end
    if (ack && !write_q) begin
      rvalid_o <= 1'b1;
      read_error_q <= answer_i[register_answer_pkg::ERROR];
      rdata_o <= register_answer_pkg::data(answer_i);
    end
    if (rst_i) begin
      bvalid_o <= 1'b0;
      rvalid_o <= 1'b0;
      write_error_q <= 1'b0;
      read_error_q <= 1'b0;
    end
  end

  assign bresp_o = {write_error_q, 1'b0};
  assign rresp_o = {read_error_q, 1'b0};

endmodule

`default_nettype wire
