// Counts an arc's path ticks and tells which of them end half a chord: odd halves for y, even halves for x.
//
// Bit m-1 of a tick's number changes at every multiple of 2^(m-1). The bit is selected one tick ahead: the count is
// that of the tick after the next.
`default_nettype none

module chord_counter (
    input  wire logic       clk_i,
    input  wire logic       start_i,
    input  wire logic       tick_i,
    input  wire logic [4:0] m_i,      // 2^m ticks per chord; below 5: no chord ever ends
    output logic            odd_o,    // the next tick ends an odd half
    output logic            even_o    // the next tick ends an even half
);
  logic [30:0] count_q;
  logic [31:0] by_m;
  logic        half_q;  // bit m-1 of the next tick's number
  logic        half_before_q;  // bit m-1 of the last tick's number

  assign by_m   = {count_q[30:4], 5'd0};
  assign odd_o  = half_q & ~half_before_q;
  assign even_o = ~half_q & half_before_q;

  always_ff @(posedge clk_i) begin
    if (start_i) begin
      count_q <= 31'd2;
      half_q <= 1'b0;
      half_before_q <= 1'b0;
    end else if (tick_i) begin
      count_q <= count_q + 31'd1;
      half_q <= by_m[m_i];
      half_before_q <= half_q;
    end
  end
endmodule

`default_nettype wire
