`default_nettype none

// STATUS, the registers that read as the card stands, and the interrupt.
// data_o is, a clock after sample_i, the live register at word_i; its low 4 bits tell the live registers apart.
module register_live (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic        sample_i,
    input  wire logic [ 5:2] word_i,
    input  wire logic        busy_i,
    input  wire logic        direct_i,
    input  wire logic        path_active_i,
    input  wire logic        feed_active_i,
    input  wire logic        ended_i,
    input  wire logic        incomplete_i,
    input  wire logic        walking_i,
    input  wire logic [16:0] ratio_i,
    input  wire logic [ 9:0] fault_i,
    input  wire logic        refused_i,
    input  wire logic [27:0] refusal_i,
    input  wire logic [15:0] geometry_room_i,
    input  wire logic [15:0] feed_room_i,
    input  wire logic [15:0] running_i,
    input  wire logic [ 7:0] irq_enable_i,
    output logic      [ 9:0] status_o,
    output logic      [27:0] data_o,
    output logic             irq_o
);

  logic [9:0] status;

  assign status = 10'(busy_i) << card_map_pkg::BIT_STATUS_BUSY |
      10'(direct_i) << card_map_pkg::BIT_STATUS_DIRECT |
      10'(path_active_i) << card_map_pkg::BIT_STATUS_PATH_ACTIVE |
      10'(feed_active_i) << card_map_pkg::BIT_STATUS_FEED_ACTIVE |
      10'(ratio_i == 17'd0) << card_map_pkg::BIT_STATUS_HELD |
      10'(ended_i) << card_map_pkg::BIT_STATUS_ENDED |
      10'(fault_i != 10'd0) << card_map_pkg::BIT_STATUS_FAULTED |
      10'(refused_i) << card_map_pkg::BIT_STATUS_REFUSED |
      10'(walking_i) << card_map_pkg::BIT_STATUS_SNAPSHOT |
      10'(incomplete_i) << card_map_pkg::BIT_STATUS_INCOMPLETE;

  logic [27:0] data_q;
  logic        irq_q;

  always_ff @(posedge clk_i) begin : p_live
    logic [7:0] causes;

    if (sample_i) begin
      case (word_i)
        card_map_pkg::ADDR_STATUS[5:2]: data_q <= {18'd0, status};
        card_map_pkg::ADDR_FAULT[5:2]: data_q <= {18'd0, fault_i};
        card_map_pkg::ADDR_REFUSAL[5:2]: data_q <= refusal_i;
        card_map_pkg::ADDR_GEOMETRY_ROOM[5:2]: data_q <= {12'd0, geometry_room_i};
        card_map_pkg::ADDR_FEED_ROOM[5:2]: data_q <= {12'd0, feed_room_i};
        default: data_q <= {12'd0, running_i};
      endcase
    end
    irq_q <= 1'b0;
    if (irq_enable_i != 8'd0) begin
      causes = 8'(!busy_i) << card_map_pkg::BIT_IRQ_ENABLE_IDLE |
          8'(ended_i) << card_map_pkg::BIT_IRQ_ENABLE_ENDED |
          8'(fault_i != 10'd0) << card_map_pkg::BIT_IRQ_ENABLE_FAULTED |
          8'(refused_i) << card_map_pkg::BIT_IRQ_ENABLE_REFUSED;
      irq_q <= (causes & irq_enable_i) != 8'd0;
    end
    if (rst_i) irq_q <= 1'b0;
  end

  assign status_o = status;
  assign data_o = data_q;
  assign irq_o = irq_q;

endmodule

`default_nettype wire
