// Rules of Wishbone B4, classic or pipelined, at the pins: what the master and the card may do in each clock.
`default_nettype none
module wishbone_checker #(
    parameter int MaxClocks = 500  // clocks within which an access must be answered
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic pipelined_i,  // strap
    input wire logic [50:0] master_i,  // {CYC, STB, WE, SEL, ADR, DAT}
    input wire logic [2:0] card_i  // {ACK, ERR, STALL}
);
  import "DPI-C" function void port_rule_broken(input string rule);

  logic cyc, stb, ack, err, stall, answer, asked, stalled, unanswered;
  assign {cyc, stb} = master_i[50:49];
  assign {ack, err, stall} = card_i;
  assign answer = ack || err;
  assign asked = cyc && stb;
  assign stalled = pipelined_i && asked && stall;
  assign unanswered = !pipelined_i && asked && !answer;

  // Requests without an answer yet. A pipelined master withdraws them with CYC, a classic one also with STB.
  logic [1:0] open_q;
  logic [9:0] wait_q;
  always_ff @(posedge clk_i) begin
    if (pipelined_i) open_q <= open_q + {1'b0, asked && !stall} - {1'b0, answer};
    else open_q <= {1'b0, asked && !answer};
    wait_q <= open_q == 0 || answer ? 10'd0 : wait_q + 10'd1;
    if (rst_i || !cyc) begin
      open_q <= 2'd0;
      wait_q <= 10'd0;
    end
  end

  // The master
  assert property (@(posedge clk_i) rst_i |-> !cyc && !stb)
  else port_rule_broken("Wishbone: the master asks in reset");
  assert property (@(posedge clk_i) disable iff (rst_i) stb |-> cyc)
  else port_rule_broken("Wishbone: STB without CYC");
  assert property (@(posedge clk_i) disable iff (rst_i) stalled |=> $stable(master_i) || !cyc)
  else port_rule_broken("Wishbone: a request changes while STALL is high");
  assert property (@(posedge clk_i) disable iff (rst_i) unanswered |=> $stable(master_i) || !asked)
  else port_rule_broken("Wishbone: a request changes before its answer");

  // The card
  assert property (@(posedge clk_i) disable iff (rst_i) !(ack && err))
  else port_rule_broken("Wishbone: ACK and ERR together");
  assert property (@(posedge clk_i) disable iff (rst_i) answer |-> open_q != 0)
  else port_rule_broken("Wishbone: an answer to nothing");
  assert property (@(posedge clk_i) disable iff (rst_i) pipelined_i || !stall)
  else port_rule_broken("Wishbone: STALL on a classic bus");
  assert property (@(posedge clk_i) disable iff (rst_i) wait_q != 10'(MaxClocks))
  else port_rule_broken("Wishbone: an access is not answered in time");
endmodule
`default_nettype wire
