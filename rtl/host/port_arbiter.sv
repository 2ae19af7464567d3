// Joins several host ports in front of the card core's one. With a single port it is wires.
//
// A request is noted and passed on a clock later, or a clock after the answer to the one before it. The ports take
// turns: the one after the port that was served last comes first. What belongs to a request stands at its port until
// the answer, so only the requests are kept here.
`default_nettype none
module port_arbiter #(
    parameter int Ports = 1  // 1 to 4
) (
    input wire logic clk_i,
    input wire logic rst_i,
    // ports: each {request, write, partial, 0, address, data}
    input wire logic [48*Ports-1:0] access_i,
    output logic [Ports-1:0] ack_o,
    output logic error_o,
    output logic [31:0] data_o,
    // card core
    output logic request_o,
    output logic [47:0] access_o,  // {port, write, partial, address, data}
    input wire logic ack_i,
    input wire logic error_i,
    input wire logic [31:0] data_i
);
  assign error_o = error_i;
  assign data_o  = data_i;

  if (Ports == 1) begin : gen_wires
    logic unused;
    assign unused    = &{1'b0, clk_i, rst_i, access_i[44]};

    assign ack_o     = ack_i;
    assign request_o = access_i[47];
    assign access_o  = {2'd0, access_i[46:45], access_i[43:0]};
  end else begin : gen_turns
    logic [Ports-1:0] request;
    logic [      3:0] waiting_q;
    logic [      1:0] port_q;
    logic             busy_q;

    for (genvar p = 0; p < Ports; p++) begin : gen_port
      assign request[p] = access_i[48*p+47];
      assign ack_o[p]   = ack_i && port_q == 2'(p);
    end

    always_ff @(posedge clk_i) begin : p_turns
      logic [1:0] candidate;
      logic [1:0] chosen;

      request_o <= 1'b0;
      waiting_q <= waiting_q | 4'(request);
      if (ack_i) busy_q <= 1'b0;
      if ((!busy_q || ack_i) && waiting_q != '0) begin
        // From the farthest port to the next one: the last that waits is taken. Ports that are not there never wait.
        chosen = port_q;
        for (int n = 3; n >= 1; n--) begin
          candidate = port_q + 2'(n);
          if (waiting_q[candidate]) chosen = candidate;
        end
        port_q <= chosen;
        waiting_q[chosen] <= 1'b0;
        request_o <= 1'b1;
        busy_q <= 1'b1;
      end
      if (rst_i) begin
        request_o <= 1'b0;
        waiting_q <= '0;
        busy_q <= 1'b0;
        port_q <= 2'd3;
      end
    end

    logic [47:0] served;
    logic        unused;
    assign served   = access_i[48*port_q+:48];
    assign unused   = &{1'b0, served[47], served[44]};

    assign access_o = {port_q, served[46:45], served[43:0]};
  end
endmodule
`default_nettype wire
