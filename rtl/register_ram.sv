`default_nettype none

// The block RAM behind the registers, and all that writes to it: settings (write_i), the walk over reset values and
// constants behind reset, and the walk over what a snapshot took.
// In the clock of snapshot_i everything is taken at once; the time's low word is written first, straight from its
// counter. The high half of the counter runs one clock late, so that it still matches when it is written next.
// The words leave the chain at position 0; the narrow ones stand at its end, where nothing wider shifts through them.
// data_o is the word at address_i two clocks earlier.
module register_ram #(
    parameter int Axes = 4,
    parameter int GeometryDepth = 4096,
    parameter int FeedDepth = 2560
) (
    input  wire logic               clk_i,
    input  wire logic               rst_i,
    input  wire logic [       31:0] clock_hz_i,
    input  wire logic               write_i,
    input  wire logic [        7:0] write_address_i,
    input  wire logic [       31:0] write_data_i,
    input  wire logic               snapshot_i,
    input  wire logic [32*Axes-1:0] position_i,
    input  wire logic [       31:0] rate_i,
    input  wire logic [       16:0] ratio_i,
    input  wire logic [       15:0] running_i,
    input  wire logic [        9:0] status_i,
    input  wire logic [        7:0] address_i,
    output logic                    walking_o,
    output logic      [       31:0] data_o
);

  localparam logic [7:0] TIME_LO = card_map_pkg::ADDR_SNAP_TIME_LO[9:2];
  localparam logic [7:0] TIME_HI = card_map_pkg::ADDR_SNAP_TIME_HI[9:2];
  localparam logic [7:0] FIRST_POSITION = card_map_pkg::ADDR_SNAP_POSITION[9:2];
  localparam logic [7:0] LAST_POSITION = FIRST_POSITION + 8'(Axes - 1);
  localparam logic [7:0] RATE = card_map_pkg::ADDR_SNAP_RATE[9:2];
  localparam logic [7:0] RATIO = card_map_pkg::ADDR_SNAP_RATIO[9:2];
  localparam logic [7:0] RUNNING = card_map_pkg::ADDR_SNAP_RUNNING[9:2];
  localparam logic [7:0] STATUS = card_map_pkg::ADDR_SNAP_STATUS[9:2];
  localparam int ChainWords = Axes + 4;

  // Clocks since reset.
  logic [31:0] time_lo_q;
  logic        time_carry_q;
  logic [31:0] time_hi_q;

  always_ff @(posedge clk_i) begin
    if (time_carry_q) time_hi_q <= time_hi_q + 32'd1;
    {time_carry_q, time_lo_q} <= {1'b0, time_lo_q} + 33'd1;
    if (rst_i) begin
      time_carry_q <= 1'b0;
      time_lo_q <= '0;
      time_hi_q <= '0;
    end
  end

  // Which walk is under way, and the address to write next.
  logic       resetting_q;
  logic       snapping_q;
  logic       hold_chain;
  logic [7:0] next_q;

  assign hold_chain = next_q == TIME_HI;

  // What the snapshot took, shifted down a word a clock.
  logic [32*ChainWords-1:0] chain_q;

  always_ff @(posedge clk_i) begin
    // The chain shifts from the clock behind the time's high word on.
    if (snapshot_i) chain_q <= {22'd0, status_i, 16'd0, running_i, 15'd0, ratio_i, rate_i, position_i};
    else if (snapping_q && !hold_chain) chain_q <= {32'd0, chain_q[32*ChainWords-1:32]};
  end

  // The walks.
  always_ff @(posedge clk_i) begin
    if (snapshot_i) begin
      next_q <= TIME_HI;
      snapping_q <= 1'b1;
    end else if (snapping_q) begin
      case (next_q)
        TIME_HI: next_q <= FIRST_POSITION;
        LAST_POSITION: next_q <= RATE;
        RATE: next_q <= RATIO;
        RATIO: next_q <= RUNNING;
        RUNNING: next_q <= STATUS;
        default: next_q <= next_q + 8'd1;
      endcase
      if (next_q == STATUS) snapping_q <= 1'b0;
    end else if (resetting_q) begin
      next_q <= next_q + 8'd1;
      if (next_q == 8'hFF) resetting_q <= 1'b0;
    end
    if (rst_i) begin
      next_q <= '0;
      resetting_q <= 1'b1;
      snapping_q <= 1'b0;
    end
  end

  // The write port, registered.
  logic        store_q;
  logic [ 7:0] store_address_q;
  logic [31:0] store_data_q;

  always_ff @(posedge clk_i) begin
    store_q <= write_i || snapshot_i || resetting_q || snapping_q;
    if (write_i) begin
      store_address_q <= write_address_i;
      store_data_q <= write_data_i;
    end else if (snapshot_i) begin
      store_address_q <= TIME_LO;
      store_data_q <= time_lo_q;
    end else if (resetting_q) begin
      store_address_q <= next_q;
      case (next_q)
        card_map_pkg::ADDR_AXES[9:2]: store_data_q <= 32'(Axes);
        card_map_pkg::ADDR_CLOCK_HZ[9:2]: store_data_q <= clock_hz_i;
        card_map_pkg::ADDR_GEOMETRY_DEPTH[9:2]: store_data_q <= 32'(GeometryDepth);
        card_map_pkg::ADDR_FEED_DEPTH[9:2]: store_data_q <= 32'(FeedDepth);
        default: store_data_q <= card_map_pkg::register_reset({2'b00, next_q});
      endcase
    end else if (snapping_q) begin
      store_address_q <= next_q;
      if (hold_chain) store_data_q <= time_hi_q;
      else store_data_q <= chain_q[31:0];
    end
    if (rst_i) store_q <= 1'b0;
  end

  (* no_rw_check *)
  logic [31:0] memory[256];
  logic [31:0] memory_q;
  logic [31:0] data_q;

  always_ff @(posedge clk_i) begin
    if (store_q) memory[store_address_q] <= store_data_q;
    memory_q <= memory[address_i];
    data_q   <= memory_q;
  end

  assign walking_o = resetting_q || snapping_q || store_q;
  assign data_o = data_q;

endmodule

`default_nettype wire
