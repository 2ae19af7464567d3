// Watermarks of both queues: a queue is low while fewer halfwords are in it than its watermark. What
// watermark and room are shows two clocks later.
//
// Queued = depth - room < watermark is looked for as watermark + room > depth: a sum, and a comparison with a constant a
// clock later.
`default_nettype none

module queue_watermarks #(
    parameter int GeometryDepth = 4096,  // halfwords, 2 to 32,768
    parameter int FeedDepth     = 2560
) (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic [40:0] setting_i,
    input  wire logic [31:0] room_i,     // {geometry, feed}
    output logic      [ 1:0] low_o       // {feed, geometry}
);
  logic [15:0] geometry_q;
  logic [15:0] feed_q;
  logic [16:0] geometry_sum_q;
  logic [16:0] feed_sum_q;

  always_ff @(posedge clk_i) begin
    if (setting_i[40] && setting_i[39:32] == card_map_pkg::ADDR_GEOMETRY_WATERMARK[9:2]) geometry_q <= setting_i[15:0];
    if (setting_i[40] && setting_i[39:32] == card_map_pkg::ADDR_FEED_WATERMARK[9:2]) feed_q <= setting_i[15:0];
    geometry_sum_q <= {1'b0, geometry_q} + {1'b0, room_i[31:16]};
    feed_sum_q     <= {1'b0, feed_q} + {1'b0, room_i[15:0]};
    low_o          <= {feed_sum_q > 17'(FeedDepth), geometry_sum_q > 17'(GeometryDepth)};
    if (rst_i) begin
      geometry_q     <= card_map_pkg::RESET_GEOMETRY_WATERMARK[15:0];
      feed_q         <= card_map_pkg::RESET_FEED_WATERMARK[15:0];
      geometry_sum_q <= '0;
      feed_sum_q     <= '0;
      low_o          <= '0;
    end
  end

  logic unused;
  assign unused = &{1'b0, setting_i[31:16]};
endmodule

`default_nettype wire
