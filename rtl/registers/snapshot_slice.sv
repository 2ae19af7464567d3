// One word of the snapshot chain: takes its value at a strobe, and hands the chain on towards the RAM at a shift.
`default_nettype none

module snapshot_slice #(
    parameter int Width = 32  // of the widest word that passes
) (
    input  wire logic             clk_i,
    input  wire logic [      1:0] snapshot_i,  // {shift, strobe}
    input  wire logic [Width-1:0] value_i,
    input  wire logic [     31:0] chain_i,
    output logic      [     31:0] chain_o
);
  logic [Width-1:0] word_q;

  always_ff @(posedge clk_i) begin
    if (snapshot_i != 2'd0) word_q <= snapshot_i[0] ? value_i : chain_i[Width-1:0];
  end

  assign chain_o = 32'(word_q);

  if (Width < 32) begin : gen_narrow
    logic unused;
    assign unused = &{1'b0, chain_i[31:Width]};
  end
endmodule

`default_nettype wire
