// The block RAM behind the registers: constants, copies of the settings, snapshots and the registers of direct mode.
//
// Constants and descriptors are its initial content, which nothing overwrites. After a reset the other words are
// written with their reset values, in the order in which the low bits of the time counter run. This sweep takes 256
// clocks; with machine inputs 354, or 482 with more than 4 axes (enables take 482 there, too); with captures 450 or
// 614. writing_o tells whether a word may still be on its way. Settings and words of a snapshot never come together,
// nor before the sweep is over: accesses wait for it, and so does the emergency stop, the only cause of a stop that can
// come so early (inputs_part).
// data_o is the word at place_i two clocks earlier.
`default_nettype none
module register_ram #(
    parameter int                                           Axes        = 4,   // 1 to 8
    parameter logic [                                 31:0] Engines     = '1,  // bits card_map_pkg::ENGINE_*
    parameter logic [        card_constants_pkg::WIDTH-1:0] Constants   = '0,
    // the first word lowest
    parameter logic [32*card_map_pkg::COUNT_DESCRIPTOR-1:0] Descriptors = '0
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [31:0] clock_hz_i,  // strap
    input wire logic [2*Axes-1:0] idle_level_i,  // level before and in reset: {second pins, first pins}
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] store_i,  // a word of a snapshot
    input wire logic [9:0] clocks_i,  // low bits of the clocks since reset
    input wire logic [9:0] place_i,  // place as in register_fold_pkg
    output logic filling_o,  // the reset values are being written; nothing else may be written
    output logic writing_o,
    output logic [31:0] data_o
);

  localparam logic MORE_AXES = Axes > 4;
  localparam logic MACHINE_INPUTS = Engines[card_map_pkg::ENGINE_MACHINE_INPUTS];
  localparam logic CAPTURES = Engines[card_map_pkg::ENGINE_CAPTURES];
  localparam logic ENABLES = Engines[card_map_pkg::ENGINE_ENABLES];
  localparam logic SOFT_LIMITS = Engines[card_map_pkg::ENGINE_SOFT_LIMITS];
  localparam int BITS = MORE_AXES && (CAPTURES || ENABLES || SOFT_LIMITS) ? 10 :
      MORE_AXES || ENABLES || MACHINE_INPUTS ? 9 : 8;
  localparam logic [9:0] CLOCK_HZ = register_fold_pkg::place_of(card_map_pkg::ADDR_CLOCK_HZ[11:2], MORE_AXES);
  localparam logic [9:0] FIRST_MODE = register_fold_pkg::place_of(card_map_pkg::ADDR_MODE[11:2], MORE_AXES);
  localparam logic [9:0] AXIS_SLOTS = 10'o070;

  // The counter is delayed by two clocks: it begins at 0x3FE. All words that are written lie in the lower 256, except
  // for filters and roles (96 words from 256 or 384 on), captures (whose last word is swept last), enables and soft
  // limits. Enables and soft limits are written in the clocks of the descriptors, which are constants; with more than 4
  // axes the descriptors lie beyond 256.
  localparam logic BEYOND = MACHINE_INPUTS || (ENABLES && MORE_AXES);
  localparam logic [9:0] LAST_SWEPT = CAPTURES ? (MORE_AXES ? 10'h263 : 10'h1BF) :
      !BEYOND ? 10'h0FD : MORE_AXES ? 10'h1DF : 10'h15F;
  localparam logic [3:0] BESIDE_DESCRIPTORS = MORE_AXES ? 4'b1001 : 4'b0111;

  logic        resetting_q;
  logic        store_q;
  logic [ 9:0] store_place_q;
  logic [31:0] store_data_q;

  always_ff @(posedge clk_i) begin
    if (clocks_i == LAST_SWEPT) resetting_q <= 1'b0;
    if (rst_i) resetting_q <= 1'b1;
  end

  logic setting;
  logic snapshot;

  assign setting  = setting_i[setting_bus_pkg::SET];
  assign snapshot = store_i[setting_bus_pkg::SET];

  // The write port, registered. The writers take turns; each gives 0 when it is not its turn, so that their values can
  // be ORed.
  always_ff @(posedge clk_i) begin : p_store
    logic [ 9:0] swept;
    logic [31:0] reset_value;
    logic [ 7:0] first_inverted;
    logic [ 7:0] second_inverted;

    swept = '0;
    reset_value = '0;
    if (resetting_q) begin
      swept = {clocks_i[9] && BITS == 10, clocks_i[8] && BEYOND, clocks_i[7:0]};
      if ((ENABLES || SOFT_LIMITS) && register_fold_pkg::is_descriptor(swept, MORE_AXES))
        swept[9:6] = BESIDE_DESCRIPTORS;
      if (register_fold_pkg::is_setting(swept)) begin
        reset_value = card_map_pkg::register_reset(register_fold_pkg::setting_word(swept));
      end
      if (swept == CLOCK_HZ) reset_value = clock_hz_i;
      first_inverted  = 8'(idle_level_i[Axes-1:0]);
      second_inverted = 8'(idle_level_i[2*Axes-1:Axes]);
      if ((swept & ~AXIS_SLOTS) == FIRST_MODE) begin
        reset_value[3:2] = {second_inverted[swept[5:3]], first_inverted[swept[5:3]]};
      end
    end
    store_q <= setting || snapshot || resetting_q;
    store_place_q <= {10{setting}} & register_fold_pkg::place_of(
        setting_bus_pkg::word(setting_i), MORE_AXES
    ) | register_fold_pkg::place_of(
        setting_bus_pkg::word(store_i), MORE_AXES
    ) | swept;
    store_data_q <= {32{setting}} & setting_bus_pkg::data(setting_i) | setting_bus_pkg::data(store_i) | reset_value;
  end

  function automatic logic [31:0] content(input logic [9:0] place);
    content = '0;
    if (register_fold_pkg::is_identity(place)) begin
      content = card_map_pkg::register_reset({6'd0, place[3:0]}) | card_constants_pkg::word(Constants, place[3:0]);
    end
    if (register_fold_pkg::is_descriptor(place, MORE_AXES)) content = Descriptors[32*place[5:0]+:32];
  endfunction

  (* no_rw_check *)
  logic [31:0] memory[0:(1<<BITS)-1];
  logic [31:0] memory_q;

  initial for (int i = 0; i < 1 << BITS; i++) memory[i] = content(10'(i));

  // Nothing overwrites constants, even if the flip-flops have arbitrary values before the first reset.
  logic [9:0] stored_at;
  logic identity;
  logic descriptor;

  assign stored_at  = 10'(store_place_q[BITS-1:0]);
  assign identity   = register_fold_pkg::is_identity(stored_at) && stored_at != CLOCK_HZ;
  assign descriptor = register_fold_pkg::is_descriptor(stored_at, MORE_AXES);

  // Not always_ff, because the initial content drives the memory, too.
  always @(posedge clk_i) begin
    if (store_q && !identity && !descriptor) memory[store_place_q[BITS-1:0]] <= store_data_q;
    memory_q <= memory[place_i[BITS-1:0]];
    data_o   <= memory_q;
  end

  // snapshot_writer reports its own words. An access after a reset looks at writing_o two clocks later at the earliest.
  assign writing_o = store_q;
  assign filling_o = resetting_q;

  logic unused;  // bits for a larger RAM
  assign unused = &{1'b0, store_place_q, place_i};

endmodule
`default_nettype wire
