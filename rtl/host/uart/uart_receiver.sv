// Receives bytes from the line: start bit, eight bits (lowest first), stop bit, each sampled in its middle. A false
// start bit, or a byte without its stop bit, is dropped.
`default_nettype none
module uart_receiver (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic level_i,  // the line, synchronised
    input wire logic fall_i,  // it is low, and was high a clock ago
    input wire logic known_i,  // the period is known; low: no byte is received
    input wire logic [19:0] period_i,
    output logic received_o,  // event
    output logic [7:0] byte_o  // with received_o
);
  logic       run_q;
  logic [3:0] bit_q;  // 0 the start bit, 9 the stop bit
  logic       start;
  logic       sample;
  logic       stop;

  assign start = fall_i && !run_q;
  assign stop  = bit_q[3] && bit_q[0];

  uart_timer timer (
      .clk_i,
      .period_i,
      .start_i(start),
      .half_i (1'b1),
      .end_o  (sample)
  );

  always_ff @(posedge clk_i) begin
    received_o <= run_q && sample && stop && level_i;
    if (start) begin
      run_q <= 1'b1;
      bit_q <= 4'd0;
    end else if (sample) begin
      bit_q <= bit_q + 4'd1;
      if (stop || (bit_q == 4'd0 && level_i)) run_q <= 1'b0;
      if (!stop) byte_o <= {level_i, byte_o[7:1]};
    end
    if (rst_i || !known_i) begin
      received_o <= 1'b0;
      run_q <= 1'b0;
    end
  end
endmodule
`default_nettype wire
