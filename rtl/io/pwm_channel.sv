// A PWM channel's period and pulse: a pulse begins with its period and lasts for the on-time that arrived last.
//
// After a stop, the first period begins 512 clocks later; an on-time arrives in the meantime.
`default_nettype none
module pwm_channel (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic stop_i,  // the channel is stopped, and restarts in the clock after
    input wire logic [26:0] period_i,  // clocks
    input wire logic done_i,  // event: on_i is a new on-time
    input wire logic [26:0] on_i,  // clocks, at most the period
    output logic due_o,  // the period ends within 511 clocks: requests an on-time
    output logic pulse_o
);
  localparam logic [26:0] TO_FIRST = 27'd512;

  logic [26:0] left_q;  // clocks left of the period
  logic [26:0] on_q;  // clocks left of the pulse, while there is one
  logic [26:0] next_q;  // the on-time of the next period
  logic        last;

  assign last  = left_q == 27'd1;
  assign due_o = left_q[26:9] == 18'd0;

  always_ff @(posedge clk_i) begin
    left_q <= last ? period_i : left_q - 27'd1;
    on_q <= last ? next_q : on_q - 27'd1;
    pulse_o <= last ? next_q != 27'd0 : pulse_o && on_q != 27'd1;
    if (done_i) next_q <= on_i;
    if (stop_i || rst_i) begin
      left_q  <= TO_FIRST;
      next_q  <= 27'd0;
      pulse_o <= 1'b0;
    end
  end
endmodule
`default_nettype wire
