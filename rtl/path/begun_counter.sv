// Counts the commands of a queue that have begun since the last cut. It also has their word of the snapshot.
`default_nettype none

module begun_counter (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic begin_i,
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o,
    output logic [31:0] begun_o
);
  always_ff @(posedge clk_i) begin
    if (begin_i) begun_o <= begun_o + 32'd1;
    if (cut_i || rst_i) begun_o <= 32'd0;
  end

  snapshot_slice begun (
      .clk_i,
      .snapshot_i,
      .value_i(begun_o),
      .snapshot_o
  );
endmodule

`default_nettype wire
