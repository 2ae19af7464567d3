// Rules of AXI4-Lite and further rules of the card, at the pins: what the master and the card may do in each clock.
`default_nettype none
module axi4_lite_checker #(
    parameter int MaxClocks = 500  // clocks within which an access must be answered
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic awvalid_i,
    input wire logic awready_i,
    input wire logic [11:0] awaddr_i,
    input wire logic wvalid_i,
    input wire logic wready_i,
    input wire logic [31:0] wdata_i,
    input wire logic [3:0] wstrb_i,
    input wire logic bvalid_i,
    input wire logic bready_i,
    input wire logic [1:0] bresp_i,
    input wire logic arvalid_i,
    input wire logic arready_i,
    input wire logic [11:0] araddr_i,
    input wire logic rvalid_i,
    input wire logic rready_i,
    input wire logic [31:0] rdata_i,
    input wire logic [1:0] rresp_i
);
  import "DPI-C" function void port_rule_broken(input string rule);

  // Addresses, data and reads that were accepted but not answered yet, up to 3; clocks for which the oldest has
  // waited.
  logic [1:0] addresses_q, data_q, reads_q;
  logic [9:0] write_wait_q, read_wait_q;
  always_ff @(posedge clk_i) begin
    addresses_q <= addresses_q + {1'b0, awvalid_i && awready_i} - {1'b0, bvalid_i && bready_i};
    data_q <= data_q + {1'b0, wvalid_i && wready_i} - {1'b0, bvalid_i && bready_i};
    reads_q <= reads_q + {1'b0, arvalid_i && arready_i} - {1'b0, rvalid_i && rready_i};
    write_wait_q <= addresses_q == 0 || data_q == 0 || bvalid_i ? 10'd0 : write_wait_q + 10'd1;
    read_wait_q <= reads_q == 0 || rvalid_i ? 10'd0 : read_wait_q + 10'd1;
    if (rst_i) begin
      addresses_q <= 2'd0;
      data_q <= 2'd0;
      reads_q <= 2'd0;
      write_wait_q <= 10'd0;
      read_wait_q <= 10'd0;
    end
  end

  // The master
  assert property (@(posedge clk_i) rst_i |-> !awvalid_i && !wvalid_i && !arvalid_i)
  else port_rule_broken("AXI4-Lite: the master asks in reset");
  assert property (@(posedge clk_i) disable iff (rst_i) awvalid_i && !awready_i |=> awvalid_i)
  else port_rule_broken("AXI4-Lite: AWVALID falls before AWREADY");
  assert property (@(posedge clk_i) disable iff (rst_i) awvalid_i && !awready_i |=> $stable(awaddr_i))
  else port_rule_broken("AXI4-Lite: AWADDR changes before AWREADY");
  assert property (@(posedge clk_i) disable iff (rst_i) wvalid_i && !wready_i |=> wvalid_i)
  else port_rule_broken("AXI4-Lite: WVALID falls before WREADY");
  assert property (@(posedge clk_i) disable iff (rst_i) wvalid_i && !wready_i |=> $stable({wdata_i, wstrb_i}))
  else port_rule_broken("AXI4-Lite: WDATA or WSTRB changes before WREADY");
  assert property (@(posedge clk_i) disable iff (rst_i) arvalid_i && !arready_i |=> arvalid_i)
  else port_rule_broken("AXI4-Lite: ARVALID falls before ARREADY");
  assert property (@(posedge clk_i) disable iff (rst_i) arvalid_i && !arready_i |=> $stable(araddr_i))
  else port_rule_broken("AXI4-Lite: ARADDR changes before ARREADY");

  // The card
  assert property (@(posedge clk_i) disable iff (rst_i) bvalid_i && !bready_i |=> bvalid_i)
  else port_rule_broken("AXI4-Lite: BVALID falls before BREADY");
  assert property (@(posedge clk_i) disable iff (rst_i) bvalid_i && !bready_i |=> $stable(bresp_i))
  else port_rule_broken("AXI4-Lite: BRESP changes before BREADY");
  assert property (@(posedge clk_i) disable iff (rst_i) rvalid_i && !rready_i |=> rvalid_i)
  else port_rule_broken("AXI4-Lite: RVALID falls before RREADY");
  assert property (@(posedge clk_i) disable iff (rst_i) rvalid_i && !rready_i |=> $stable({rdata_i, rresp_i}))
  else port_rule_broken("AXI4-Lite: RDATA or RRESP changes before RREADY");
  assert property (@(posedge clk_i) disable iff (rst_i) bvalid_i |-> addresses_q != 0 && data_q != 0)
  else port_rule_broken("AXI4-Lite: BVALID without a write");
  assert property (@(posedge clk_i) disable iff (rst_i) rvalid_i |-> reads_q != 0)
  else port_rule_broken("AXI4-Lite: RVALID without a read");
  // OKAY or SLVERR: the port decodes no slave address and has no exclusive access.
  assert property (@(posedge clk_i) disable iff (rst_i) bvalid_i |-> !bresp_i[0])
  else port_rule_broken("AXI4-Lite: BRESP is neither OKAY nor SLVERR");
  assert property (@(posedge clk_i) disable iff (rst_i) rvalid_i |-> !rresp_i[0])
  else port_rule_broken("AXI4-Lite: RRESP is neither OKAY nor SLVERR");
  assert property (@(posedge clk_i) disable iff (rst_i) write_wait_q != 10'(MaxClocks))
  else port_rule_broken("AXI4-Lite: a write is not answered in time");
  assert property (@(posedge clk_i) disable iff (rst_i) read_wait_q != 10'(MaxClocks))
  else port_rule_broken("AXI4-Lite: a read is not answered in time");
endmodule
`default_nettype wire
