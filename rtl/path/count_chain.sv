// The next command's count, shifted in from the load bus, with the zero flags that a tick_counter loads.
`default_nettype none

module count_chain (
    input  wire logic        clk_i,
    input  wire logic        load_i,
    input  wire logic [15:0] word_i,
    output logic      [39:0] count_o,
    // of count_o, one clock late
    output logic             mid_zero_o,  // bits 19 to 4
    output logic             top_zero_o,  // bits 39 to 20
    output logic             zero_o       // all bits; two clocks late
);
  logic [7:0] top_q;  // of the third halfword nothing counts, but the first two pass here
  logic       low_zero_q;
  logic       loaded_q;
  logic       settled_q;

  always_ff @(posedge clk_i) begin
    if (load_i) {top_q, count_o} <= {word_i, top_q, count_o[39:16]};
    loaded_q  <= load_i;
    settled_q <= loaded_q;
    if (loaded_q) begin
      mid_zero_o <= count_o[19:4] == 16'd0;
      top_zero_o <= count_o[39:20] == 20'd0;
      low_zero_q <= count_o[3:0] == 4'd0;
    end
    if (settled_q) zero_o <= low_zero_q && mid_zero_o && top_zero_o;
  end
endmodule

`default_nettype wire
