// The card with an AXI4-Lite and a pipelined Wishbone port. Its signals have the names that third-party bus masters
// expect.
`default_nettype none
module card_on_buses (
    input  wire logic        clk,
    input  wire logic        rst,
    input  wire logic [11:0] axi_awaddr,
    input  wire logic        axi_awvalid,
    output logic             axi_awready,
    input  wire logic [31:0] axi_wdata,
    input  wire logic [ 3:0] axi_wstrb,
    input  wire logic        axi_wvalid,
    output logic             axi_wready,
    output logic      [ 1:0] axi_bresp,
    output logic             axi_bvalid,
    input  wire logic        axi_bready,
    input  wire logic [11:0] axi_araddr,
    input  wire logic        axi_arvalid,
    output logic             axi_arready,
    output logic      [31:0] axi_rdata,
    output logic      [ 1:0] axi_rresp,
    output logic             axi_rvalid,
    input  wire logic        axi_rready,
    input  wire logic        wb_cyc,
    input  wire logic        wb_stb,
    input  wire logic        wb_we,
    input  wire logic [ 3:0] wb_sel,
    input  wire logic [11:0] wb_adr,
    input  wire logic [31:0] wb_datwr,
    output logic      [31:0] wb_datrd,
    output logic             wb_ack,
    output logic             wb_err,
    output logic             wb_stall,
    output logic      [ 3:0] step,
    output logic      [ 3:0] dir
);
  logic miso;
  logic miso_enable;
  logic [wishbone_request_pkg::WIDTH-1:0] request;
  logic [wishbone_answer_pkg::WIDTH-1:0] answer;
  logic tx;
  logic irq;
  logic [3:0] outputs;
  logic [observe_pkg::WIDTH+axis_observe_pkg::WIDTH*4-1:0] observe;

  assign request[wishbone_request_pkg::CYC] = wb_cyc;
  assign request[wishbone_request_pkg::STB] = wb_stb;
  assign request[wishbone_request_pkg::WE] = wb_we;
  assign request[wishbone_request_pkg::SEL+:4] = wb_sel;
  assign request[wishbone_request_pkg::ADR+:12] = wb_adr;
  assign request[wishbone_request_pkg::DAT+:32] = wb_datwr;
  assign wb_ack = answer[wishbone_answer_pkg::ACK];
  assign wb_err = answer[wishbone_answer_pkg::ERR];
  assign wb_stall = answer[wishbone_answer_pkg::STALL];
  assign wb_datrd = answer[wishbone_answer_pkg::DAT+:32];

  card_with_ports #(
      .AxiLite (1),
      .Wishbone(2)
  ) card (
      .clk_i(clk),
      .rst_i(rst),
      .clock_hz_i(32'd50_000_000),
      .idle_level_i(8'd0),
      .output_idle_i(4'd0),
      .emergency_stop_level_i(1'b1),
      .emergency_stop_i(1'b0),
      .awvalid_i(axi_awvalid),
      .awready_o(axi_awready),
      .awaddr_i(axi_awaddr),
      .wvalid_i(axi_wvalid),
      .wready_o(axi_wready),
      .wdata_i(axi_wdata),
      .wstrb_i(axi_wstrb),
      .bvalid_o(axi_bvalid),
      .bready_i(axi_bready),
      .bresp_o(axi_bresp),
      .arvalid_i(axi_arvalid),
      .arready_o(axi_arready),
      .araddr_i(axi_araddr),
      .rvalid_o(axi_rvalid),
      .rready_i(axi_rready),
      .rdata_o(axi_rdata),
      .rresp_o(axi_rresp),
      .wishbone_i(request),
      .wishbone_o(answer),
      .rx_i(1'b1),
      .tx_o(tx),
      .sck_i(1'b0),
      .cs_n_i(1'b1),
      .mosi_i(1'b0),
      .miso_o(miso),
      .miso_enable_o(miso_enable),
      .input_i(4'd0),
      .output_o(outputs),
      .step_o(step),
      .dir_o(dir),
      .irq_o(irq),
      .observe_o(observe)
  );
endmodule
`default_nettype wire
