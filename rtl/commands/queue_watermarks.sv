// Watermarks of both queues: a queue is low while it has fewer halfwords than its watermark. Changes of watermark and
// room are shown two clocks later.
//
// Queued = depth - room < watermark is computed as watermark + room > depth: a sum, and one clock later a comparison
// with a constant.
`default_nettype none

module queue_watermarks #(
    parameter int GeometryDepth = 4096,  // halfwords, 2 to 32,768
    parameter int FeedDepth     = 2560
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [15:0] geometry_room_i,
    input wire logic [15:0] feed_room_i,
    output logic geometry_low_o,
    output logic feed_low_o
);
  logic [15:0] geometry_q;
  logic [15:0] feed_q;
  logic [16:0] geometry_sum_q;
  logic [16:0] feed_sum_q;
  logic [31:0] data;

  assign data = setting_bus_pkg::data(setting_i);

  always_ff @(posedge clk_i) begin
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_GEOMETRY_WATERMARK)) geometry_q <= data[15:0];
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_FEED_WATERMARK)) feed_q <= data[15:0];
    geometry_sum_q <= {1'b0, geometry_q} + {1'b0, geometry_room_i};
    feed_sum_q     <= {1'b0, feed_q} + {1'b0, feed_room_i};
    geometry_low_o <= geometry_sum_q > 17'(GeometryDepth);
    feed_low_o     <= feed_sum_q > 17'(FeedDepth);
    if (rst_i) begin
      geometry_q     <= card_map_pkg::RESET_GEOMETRY_WATERMARK[15:0];
      feed_q         <= card_map_pkg::RESET_FEED_WATERMARK[15:0];
      geometry_sum_q <= '0;
      feed_sum_q     <= '0;
      geometry_low_o <= 1'b0;
      feed_low_o     <= 1'b0;
    end
  end

  logic unused;
  assign unused = &{1'b0, data[31:16]};
endmodule

`default_nettype wire
