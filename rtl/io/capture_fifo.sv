// The queue of captures: up to 16, in the order in which their filters passed. The host reads the oldest one.
//
// A block RAM has 20 slots of 16 words. The queue has 16 of them; each of the four units has one, into which its
// snapshots are written along with its area. When an edge has passed, the unit's slot becomes the last one of the
// queue, and the unit gets the slot that was in that place. So no word is copied, and the ring and the units together
// always have all 20 slots. A reset fills the ring in 16 clocks; in this time the registers take no setting, so no unit
// is on. A full queue keeps its captures.
`default_nettype none

module capture_fifo (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] store_i,  // a word of a snapshot
    input wire logic [3:0] passed_i,  // levels, by unit: a capture is in the unit's slot
    input wire logic [3:0] active_i,  // by unit: the level after the captured edge
    output logic [3:0] queued_o,  // events (combinational): the capture is in the queue, or lost if that is full
    output logic full_o,
    output logic [31:0] state_o,  // the register CAPTURE_QUEUE
    input wire logic [3:0] word_i,  // index of a word of the oldest capture
    output logic [31:0] data_o  // that word two clocks later; 0 if the queue is empty
);

  localparam int SLOT = 5;  // bits of a slot's number, 0 to 19

  logic        filling_q;
  logic [ 3:0] first_q;  // place of the oldest capture in the ring, modulo 16
  logic [ 3:0] next_q;  // place of the next capture in the ring, modulo 16
  logic [ 4:0] count_q;  // 0 to 16
  logic [15:0] lost_q;  // lost captures, modulo 2^16
  logic [ 1:0] unit;  // the first unit that has a capture
  logic        passed;
  logic        push;
  logic        drop;
  logic [31:0] data;

  assign unit = passed_i[0] ? 2'd0 : passed_i[1] ? 2'd1 : passed_i[2] ? 2'd2 : 2'd3;
  assign passed = passed_i != '0;
  assign queued_o = 4'(passed) << unit;
  assign full_o = count_q[4];
  assign push = passed && !full_o;
  assign data = setting_bus_pkg::data(setting_i);
  assign drop = setting_bus_pkg::writes(
      setting_i, card_map_pkg::ADDR_CAPTURE_NEXT
  ) && count_q != '0 && data[3:0] == first_q;

  logic [SLOT-1:0] slot_q[0:3];  // slot of each unit
  logic [SLOT+2:0] ring[0:15];  // {level, unit, slot}
  logic [SLOT+2:0] oldest;
  logic [SLOT-1:0] spare;  // slot at the place of the next capture
  logic [SLOT-1:0] oldest_q;

  assign oldest = ring[first_q];
  assign spare  = SLOT'(ring[next_q]);

  always_ff @(posedge clk_i) begin
    filling_q <= filling_q && next_q != 4'd15;
    count_q   <= count_q + 5'(push) - 5'(drop);
    if (drop) first_q <= first_q + 4'd1;
    if (push || filling_q) begin
      next_q <= next_q + 4'd1;
      ring[next_q] <= filling_q ? {4'd0, next_q} : {active_i[unit], unit, slot_q[unit]};
    end
    if (push) slot_q[unit] <= spare;
    if (passed && full_o) lost_q <= lost_q + 16'd1;
    if (rst_i) begin
      filling_q <= 1'b1;
      first_q <= '0;
      next_q <= '0;
      count_q <= '0;
      lost_q <= '0;
      for (int n = 0; n < 4; n++) slot_q[n] <= SLOT'(16 + n);
    end
    // Registered, so that all fields are of one clock.
    oldest_q <= oldest[SLOT-1:0];
    state_o <= 32'(count_q) << card_map_pkg::BIT_CAPTURE_QUEUE_CAPTURES |
        32'(first_q) << card_map_pkg::BIT_CAPTURE_QUEUE_OLDEST | 32'(lost_q) << card_map_pkg::BIT_CAPTURE_QUEUE_LOST;
    if (count_q != '0) state_o[card_map_pkg::BIT_CAPTURE_QUEUE_UNIT_NUMBER+:3] <= oldest[SLOT+:3];
    if (rst_i) state_o <= '0;
  end

  // The areas of captures follow that of REST: 16 words each, from half of the second area on.
  logic [ 9:0] stored;
  logic [ 1:0] of_unit;
  logic        store_q;
  logic [ 8:0] store_place_q;
  logic [31:0] store_data_q;

  assign stored  = setting_bus_pkg::word(store_i);
  assign of_unit = {stored[6], stored[4]};

  logic there_q;  // the queue was not empty when the word was read

  (* no_rw_check *)
  logic [31:0] memory[0:511];
  logic [31:0] memory_q;

  always_ff @(posedge clk_i) begin
    store_q <= store_i[setting_bus_pkg::SET] && stored[9:7] == card_map_pkg::AREA_CAPTURE_0[11:9] && stored[6:5] != '0;
    store_place_q <= {slot_q[of_unit], stored[3:0]};
    store_data_q <= setting_bus_pkg::data(store_i);
    if (store_q) memory[store_place_q] <= store_data_q;
    memory_q <= memory[{oldest_q, word_i}];
    there_q  <= state_o[card_map_pkg::BIT_CAPTURE_QUEUE_CAPTURES+:5] != '0;
    data_o   <= there_q ? memory_q : '0;
  end

  logic unused;
  assign unused = &{1'b0, data};

endmodule

`default_nettype wire
