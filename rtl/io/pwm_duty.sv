// The on-times of both PWM channels, which take turns of 128 clocks. One adder makes three products, one bit of the
// second factor per clock. A product of A and B is (A B + 2^16) / 2^17, rounded down: dropping one bit in each of 17
// additions rounds down as one division would, and the sum starts with the half. The sum for the speed starts with 0
// and so stays below 2^31.
//
//   clock 0        the speed is sampled, if the channel requests an on-time
//   1 to 17        rate * ratio
//   18 to 48       shifted up, at most to 2^31 - 1
//   50 to 66       * gain, cut to the duty
//   68 to 84       * period
//   85             the on-time is done
`default_nettype none
module pwm_duty (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [1:0] due_i,  // by channel: requests an on-time
    input wire logic [1:0] cancel_i,  // by channel: the inputs of its on-time have changed
    input wire logic [2*pwm_order_pkg::WIDTH-1:0] orders_i,
    input wire logic [2*27-1:0] periods_i,
    input wire logic [31:0] rate_i,  // feed ticks per enabled clock, in units of 2^-32
    input wire logic [16:0] ratio_i,  // enabled clocks per clock, in units of 2^-16
    output logic [1:0] done_o,  // events, by channel (combinational)
    output logic [26:0] on_o  // with done_o
);
  localparam logic [31:0] HALF = 32'h0001_0000;

  logic [                     7:0] phase_q;
  logic                            channel;
  logic [                     6:0] turn;
  logic                            busy_q;
  logic [                    31:0] a_q;
  logic [                    16:0] b_q;
  logic [                    31:0] sum_q;
  logic [                    32:0] sum;
  logic [                     4:0] shift_q;  // shifts still to make
  logic [pwm_order_pkg::WIDTH-1:0] order;
  logic [                    26:0] period;
  logic [                    16:0] followed;
  logic [                    15:0] duty;

  assign channel  = phase_q[7];
  assign turn     = phase_q[6:0];
  assign order    = orders_i[(channel?pwm_order_pkg::WIDTH : 0)+:pwm_order_pkg::WIDTH];
  assign period   = periods_i[(channel?27 : 0)+:27];
  assign sum      = {1'b0, sum_q} + (b_q[0] ? {1'b0, a_q} : 33'd0);
  assign followed = sum_q[29:13];

  always_comb begin
    duty = pwm_order_pkg::duty(order);
    if (order[pwm_order_pkg::FOLLOWS] && followed < {1'b0, duty}) duty = followed[15:0];
  end

  always_ff @(posedge clk_i) begin
    phase_q <= phase_q + 8'd1;
    sum_q   <= sum[32:1];
    b_q     <= {1'b0, b_q[16:1]};
    case (turn)
      7'd0: begin
        busy_q <= due_i[channel];
        shift_q <= pwm_order_pkg::shift(order);
        {a_q, b_q, sum_q} <= {rate_i, ratio_i, 32'd0};
      end
      7'd49: {a_q, b_q, sum_q} <= {sum_q, 1'b0, pwm_order_pkg::gain(order), HALF};
      // A duty of 65535 means full: each duty from 32768 on counts as 1/65536 more.
      7'd67: {a_q, b_q, sum_q} <= {4'd0, period, 1'b0, {1'b0, duty} + 17'(duty[15]), HALF};
      default:
      if (turn >= 7'd18 && turn <= 7'd48) begin
        sum_q <= sum_q;
        if (shift_q != 5'd0) begin
          shift_q <= shift_q - 5'd1;
          sum_q   <= sum_q[30] ? 32'h7FFF_FFFF : {1'b0, sum_q[29:0], 1'b0};
        end
      end
    endcase
    if (cancel_i[channel]) busy_q <= 1'b0;
    if (rst_i) {phase_q, busy_q} <= '0;
  end

  logic unused;  // the dropped bits
  assign unused = &{1'b0, sum[0]};

  assign done_o = 2'(busy_q && turn == 7'd85) << channel;
  assign on_o   = sum_q[26:0];
endmodule
`default_nettype wire
