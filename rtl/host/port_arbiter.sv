// Joins several host ports in front of the card core's inner port. A single port is wired through.
//
// A request is recorded and passed on one clock later, or one clock after the answer to the request before it. The
// ports take turns: the port after the one that was served last comes first. The other fields of a request keep their
// values at its port until the answer, so only the requests are stored here.
`default_nettype none
module port_arbiter #(
    parameter int Ports = 1  // 1 to 4
) (
    input wire logic clk_i,
    input wire logic rst_i,
    // ports, the first one lowest
    input wire logic [register_access_pkg::WIDTH*Ports-1:0] access_i,
    output logic [register_answer_pkg::WIDTH*Ports-1:0] answer_o,
    // card core
    output logic [register_access_pkg::WIDTH-1:0] access_o,
    input wire logic [register_answer_pkg::WIDTH-1:0] answer_i
);
  localparam int ACCESS = register_access_pkg::WIDTH;
  localparam int ANSWER = register_answer_pkg::WIDTH;

  if (Ports == 1) begin : gen_wires
    logic unused;
    assign unused   = &{1'b0, clk_i, rst_i};

    assign access_o = access_i;
    assign answer_o = answer_i;
  end else begin : gen_turns
    logic [ Ports-1:0] request;
    logic [       3:0] waiting_q;
    logic [       1:0] port_q;
    logic              busy_q;
    logic              request_q;
    logic [ACCESS-1:0] served;
    logic              ack;

    assign ack = answer_i[register_answer_pkg::ACK];

    for (genvar p = 0; p < Ports; p++) begin : gen_port
      assign request[p] = access_i[ACCESS*p+register_access_pkg::REQUEST];
      assign answer_o[ANSWER*p+:ANSWER] = register_answer_pkg::only_if(answer_i, port_q == 2'(p));
    end

    always_ff @(posedge clk_i) begin : p_turns
      logic [1:0] candidate;
      logic [1:0] chosen;

      request_q <= 1'b0;
      waiting_q <= waiting_q | 4'(request);
      if (ack) busy_q <= 1'b0;
      if ((!busy_q || ack) && waiting_q != '0) begin
        // From the farthest port to the next one: the last one that waits is chosen. Absent ports never wait.
        chosen = port_q;
        for (int n = 3; n >= 1; n--) begin
          candidate = port_q + 2'(n);
          if (waiting_q[candidate]) chosen = candidate;
        end
        port_q <= chosen;
        waiting_q[chosen] <= 1'b0;
        request_q <= 1'b1;
        busy_q <= 1'b1;
      end
      if (rst_i) begin
        request_q <= 1'b0;
        waiting_q <= '0;
        busy_q <= 1'b0;
        port_q <= 2'd3;
      end
    end

    assign served   = access_i[ACCESS*port_q+:ACCESS];
    assign access_o = register_access_pkg::passed_on(served, request_q, port_q);
  end
endmodule
`default_nettype wire
