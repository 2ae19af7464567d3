// The five settings of an axis. Values on the setting bus have been checked already.
`default_nettype none

module axis_settings #(
    parameter int Axis = 0
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [1:0] idle_level_i,
    output logic [15:0] step_length_o,
    output logic [15:0] step_space_o,
    output logic [15:0] dir_setup_o,
    output logic [15:0] dir_hold_o,
    output logic [3:0] mode_o
);
  localparam logic [11:0] SLOT = card_map_pkg::ADDR_STEP_LENGTH + 12'(Axis * card_map_pkg::STRIDE_STEP_LENGTH);

  logic        mine;
  logic [ 9:0] word;
  logic [ 2:0] place;
  logic [31:0] data;
  assign word  = setting_bus_pkg::word(setting_i);
  assign mine  = setting_i[setting_bus_pkg::SET] && word[9:3] == SLOT[11:5];
  assign place = word[2:0];
  assign data  = setting_bus_pkg::data(setting_i);

  always_ff @(posedge clk_i) begin
    if (mine) begin
      if (place == card_map_pkg::ADDR_STEP_LENGTH[4:2]) step_length_o <= data[15:0];
      if (place == card_map_pkg::ADDR_STEP_SPACE[4:2]) step_space_o <= data[15:0];
      if (place == card_map_pkg::ADDR_DIR_SETUP[4:2]) dir_setup_o <= data[15:0];
      if (place == card_map_pkg::ADDR_DIR_HOLD[4:2]) dir_hold_o <= data[15:0];
      if (place == card_map_pkg::ADDR_MODE[4:2]) mode_o <= data[3:0];
    end
    if (rst_i) begin
      step_length_o <= card_map_pkg::RESET_STEP_LENGTH[15:0];
      step_space_o  <= card_map_pkg::RESET_STEP_SPACE[15:0];
      dir_setup_o   <= card_map_pkg::RESET_DIR_SETUP[15:0];
      dir_hold_o    <= card_map_pkg::RESET_DIR_HOLD[15:0];
      mode_o        <= {idle_level_i, card_map_pkg::RESET_MODE[1:0]};
    end
  end

  // The shaper's settings are among the first eight of the axis's 32 words.
  logic unused;
  assign unused = &{1'b0, data[31:16]};
endmodule

`default_nettype wire
