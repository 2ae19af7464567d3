// Sends bytes to the line: start bit, eight bits (lowest first), stop bit.
`default_nettype none
module uart_transmitter (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic known_i,  // the period is known; low: the line is high, no byte is taken
    input wire logic [19:0] period_i,
    input wire logic valid_i,
    input wire logic [7:0] byte_i,
    output logic ready_o,  // the byte is taken if it is valid; combinational from registers
    output logic tx_o
);
  logic       run_q;
  logic [3:0] bit_q;  // 0 the start bit, 9 the stop bit
  logic [8:0] shift_q;  // bits after this one
  logic       take;
  logic       ends;

  assign ready_o = known_i && !run_q;
  assign take = valid_i && ready_o;

  uart_timer timer (
      .clk_i,
      .period_i,
      .start_i(take),
      .half_i (1'b0),
      .end_o  (ends)
  );

  always_ff @(posedge clk_i) begin
    if (take) begin
      run_q <= 1'b1;
      bit_q <= 4'd0;
      shift_q <= {1'b1, byte_i};
      tx_o <= 1'b0;
    end else if (run_q && ends) begin
      bit_q <= bit_q + 4'd1;
      shift_q <= {1'b1, shift_q[8:1]};
      tx_o <= shift_q[0];
      if (bit_q[3] && bit_q[0]) run_q <= 1'b0;
    end
    if (rst_i || !known_i) begin
      run_q <= 1'b0;
      tx_o  <= 1'b1;
    end
  end
endmodule
`default_nettype wire
