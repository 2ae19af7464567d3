// One word of the snapshot chain: takes its value at a strobe, and passes the chain on towards the RAM at a shift.
`default_nettype none

module snapshot_slice #(
    parameter int Width = 32  // bits of the widest word that passes
) (
    input wire logic clk_i,
    input wire logic [Width-1:0] value_i,
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o
);
  logic [Width-1:0] word_q;
  logic [31:0] incoming;
  logic strobe;

  assign incoming = snapshot_pkg::word(snapshot_i);
  assign strobe   = snapshot_i[snapshot_pkg::STROBE];

  always_ff @(posedge clk_i) begin
    if (strobe || snapshot_i[snapshot_pkg::SHIFT]) word_q <= strobe ? value_i : incoming[Width-1:0];
  end

  assign snapshot_o = snapshot_pkg::with_word(snapshot_i, 32'(word_q));

  if (Width < 32) begin : gen_narrow
    logic unused;
    assign unused = &{1'b0, incoming[31:Width]};
  end
endmodule

`default_nettype wire
