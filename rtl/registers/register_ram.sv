// The block RAM behind the registers: constants, the settings' shadow, snapshots and the direct mode's registers.
//
// After reset every word is written with its reset value or constant in 256 clocks, in the order in which the low byte
// of the time counter runs; writing_o tells whether a word may still be on its way. Settings and words of a snapshot never come together, nor before that is over.
// data_o is the word at address_i two clocks earlier.
`default_nettype none
module register_ram #(
    parameter int Axes = 4  // 1 to 8
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [card_constants_pkg::WIDTH-1:0] constants_i,
    input wire logic [2*Axes-1:0] idle_level_i,  // {second pins, first pins}
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] store_i,  // a word of a snapshot
    input wire logic [7:0] clocks_i,  // since reset, the low byte
    input wire logic [7:0] address_i,
    output logic writing_o,
    output logic [31:0] data_o
);

  localparam logic [7:0] FIRST_MODE = card_map_pkg::ADDR_MODE[9:2];
  localparam logic [7:0] AXIS_SLOTS = 8'(7 * card_map_pkg::STRIDE_MODE / 4);

  // The counter is two clocks late: it begins at 0xFE.
  localparam logic [7:0] LAST_SWEPT = 8'hFD;

  logic        resetting_q;
  logic        store_q;
  logic [ 7:0] store_address_q;
  logic [31:0] store_data_q;

  always_ff @(posedge clk_i) begin
    if (clocks_i == LAST_SWEPT) resetting_q <= 1'b0;
    if (rst_i) resetting_q <= 1'b1;
  end

  logic setting;
  logic snapshot;
  logic [9:0] setting_word;
  logic [9:0] store_word;

  assign setting = setting_i[setting_bus_pkg::SET];
  assign snapshot = store_i[setting_bus_pkg::SET];
  assign setting_word = setting_bus_pkg::word(setting_i);
  assign store_word = setting_bus_pkg::word(store_i);

  logic unused;  // the RAM has the first 256 words of the map
  assign unused = &{1'b0, setting_word[9:8], store_word[9:8]};

  // The write port, registered: those who write take turns, and give 0 when it is not theirs.
  always_ff @(posedge clk_i) begin : p_store
    logic [ 7:0] swept;
    logic [31:0] reset_value;
    logic [ 7:0] first_inverted;
    logic [ 7:0] second_inverted;

    swept = '0;
    reset_value = '0;
    if (resetting_q) begin
      swept = clocks_i;
      reset_value = card_map_pkg::register_reset({2'b00, swept});
      if (swept < 8'd16) reset_value = reset_value | card_constants_pkg::word(constants_i, swept[3:0]);
      first_inverted  = 8'(idle_level_i[Axes-1:0]);
      second_inverted = 8'(idle_level_i[2*Axes-1:Axes]);
      if ((swept & ~AXIS_SLOTS) == FIRST_MODE) begin
        reset_value[3:2] = {second_inverted[swept[5:3]], first_inverted[swept[5:3]]};
      end
    end
    store_q <= setting || snapshot || resetting_q;
    store_address_q <= {8{setting}} & setting_word[7:0] | store_word[7:0] | swept;
    store_data_q <= {32{setting}} & setting_bus_pkg::data(setting_i) | setting_bus_pkg::data(store_i) | reset_value;
  end

  (* no_rw_check *)
  logic [31:0] memory[0:255];
  logic [31:0] memory_q;

  always_ff @(posedge clk_i) begin
    if (store_q) memory[store_address_q] <= store_data_q;
    memory_q <= memory[address_i];
    data_o   <= memory_q;
  end

  // Of a snapshot its writer tells. An access after a reset asks two clocks later at the earliest.
  assign writing_o = store_q;

endmodule
`default_nettype wire
