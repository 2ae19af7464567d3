// The five settings of an axis, from the setting bus; a value on the bus was checked.
`default_nettype none

module axis_settings #(
    parameter int Axis = 0
) (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic [40:0] setting_i,
    input  wire logic [ 1:0] idle_level_i,
    output logic      [15:0] step_length_o,
    output logic      [15:0] step_space_o,
    output logic      [15:0] dir_setup_o,
    output logic      [15:0] dir_hold_o,
    output logic      [ 3:0] mode_o
);
  localparam logic [11:0] SLOT = card_map_pkg::ADDR_STEP_LENGTH + 12'(Axis * card_map_pkg::STRIDE_STEP_LENGTH);

  logic       mine;
  logic [2:0] place;
  assign mine  = setting_i[40] && setting_i[39:35] == SLOT[9:5];
  assign place = setting_i[34:32];

  always_ff @(posedge clk_i) begin
    if (mine) begin
      if (place == card_map_pkg::ADDR_STEP_LENGTH[4:2]) step_length_o <= setting_i[15:0];
      if (place == card_map_pkg::ADDR_STEP_SPACE[4:2]) step_space_o <= setting_i[15:0];
      if (place == card_map_pkg::ADDR_DIR_SETUP[4:2]) dir_setup_o <= setting_i[15:0];
      if (place == card_map_pkg::ADDR_DIR_HOLD[4:2]) dir_hold_o <= setting_i[15:0];
      if (place == card_map_pkg::ADDR_MODE[4:2]) mode_o <= setting_i[3:0];
    end
    if (rst_i) begin
      step_length_o <= card_map_pkg::RESET_STEP_LENGTH[15:0];
      step_space_o  <= card_map_pkg::RESET_STEP_SPACE[15:0];
      dir_setup_o   <= card_map_pkg::RESET_DIR_SETUP[15:0];
      dir_hold_o    <= card_map_pkg::RESET_DIR_HOLD[15:0];
      mode_o        <= {idle_level_i, card_map_pkg::RESET_MODE[1:0]};
    end
  end

  // A slot is eight words; what lies above it in the window is no setting.
  logic unused;
  assign unused = &{1'b0, setting_i[31:16]};
endmodule

`default_nettype wire
