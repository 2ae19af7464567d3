// STATUS.refused and REFUSAL, one of each for every port.
//
// A port's first refusal is kept until the port clears it. Refusals by the map, refusals by the command checker and
// clears never meet: one access is carried through at a time, and the checker refuses while its access waits, or in the
// clock after a flush.
`default_nettype none
module refusal_latch #(
    parameter int Ports = 1  // 1 to 4
) (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic [ 1:0] port_i,            // the port that asks
    input  wire logic [11:0] address_i,
    input  wire logic        clear_i,
    input  wire logic        refuse_i,
    input  wire logic [ 7:0] reason_i,
    input  wire logic        checker_refuse_i,
    input  wire logic [15:0] checker_reason_i,  // {number, reason}
    output logic             any_refused_o,     // combinational, as the two below: of the port that asks
    output logic             refused_o,
    output logic      [27:0] refusal_o
);

  logic [        27:0] refusal;
  logic [   Ports-1:0] refused_q;
  logic [28*Ports-1:0] refusal_q;

  assign refusal = {address_i, checker_refuse_i ? checker_reason_i : {8'd0, reason_i}};

  for (genvar p = 0; p < Ports; p++) begin : gen_port
    always_ff @(posedge clk_i) begin
      if (Ports == 1 || port_i == 2'(p)) begin
        if ((refuse_i || checker_refuse_i) && !refused_q[p]) begin
          refused_q[p] <= 1'b1;
          refusal_q[28*p+:28] <= refusal;
        end else if (clear_i) begin
          refused_q[p] <= 1'b0;
          refusal_q[28*p+:28] <= '0;
        end
      end
      if (rst_i) begin
        refused_q[p] <= 1'b0;
        refusal_q[28*p+:28] <= '0;
      end
    end
  end

  assign any_refused_o = refused_q != '0;

  if (Ports == 1) begin : gen_one
    logic unused;
    assign unused    = &{1'b0, port_i};
    assign refused_o = refused_q;
    assign refusal_o = refusal_q;
  end else begin : gen_choice
    logic [  3:0] refused;
    logic [111:0] refusals;
    assign refused   = 4'(refused_q);
    assign refusals  = 112'(refusal_q);
    assign refused_o = refused[port_i];
    assign refusal_o = refusals[28*port_i+:28];
  end

endmodule
`default_nettype wire
