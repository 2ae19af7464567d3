`default_nettype none

// The settings that the hardware needs at all times, in flip-flops. write_i comes only with a setting's address and
// a value that was checked, so bits beyond a register's width are 0.
module register_settings #(
    parameter int Axes = 4
) (
    input  wire logic               clk_i,
    input  wire logic               rst_i,
    input  wire logic               write_i,
    input  wire logic [       11:2] word_i,
    input  wire logic [       27:0] data_i,
    output logic                    hold_o,
    output logic      [       16:0] ratio_o,
    output logic      [       27:0] slew_o,
    output logic      [       15:0] hold_limit_o,
    output logic      [        7:0] irq_enable_o,
    output logic      [16*Axes-1:0] step_length_o,
    output logic      [16*Axes-1:0] step_space_o,
    output logic      [16*Axes-1:0] dir_setup_o,
    output logic      [16*Axes-1:0] dir_hold_o,
    output logic      [ 4*Axes-1:0] mode_o
);

  logic        hold_q;
  logic [16:0] ratio_q;
  logic [27:0] slew_q;
  logic [15:0] hold_limit_q;
  logic [ 7:0] irq_enable_q;

  always_ff @(posedge clk_i) begin
    if (write_i) begin
      case (word_i)
        card_map_pkg::ADDR_HOLD[11:2]: hold_q <= data_i[0];
        card_map_pkg::ADDR_RATIO[11:2]: ratio_q <= data_i[16:0];
        card_map_pkg::ADDR_SLEW[11:2]: slew_q <= data_i[27:0];
        card_map_pkg::ADDR_HOLD_LIMIT[11:2]: hold_limit_q <= data_i[15:0];
        card_map_pkg::ADDR_IRQ_ENABLE[11:2]: irq_enable_q <= data_i[7:0];
        default: ;
      endcase
    end
    if (rst_i) begin
      hold_q <= card_map_pkg::RESET_HOLD[0];
      ratio_q <= card_map_pkg::RESET_RATIO[16:0];
      slew_q <= card_map_pkg::RESET_SLEW[27:0];
      hold_limit_q <= card_map_pkg::RESET_HOLD_LIMIT[15:0];
      irq_enable_q <= card_map_pkg::RESET_IRQ_ENABLE[7:0];
    end
  end

  assign hold_o = hold_q;
  assign ratio_o = ratio_q;
  assign slew_o = slew_q;
  assign hold_limit_o = hold_limit_q;
  assign irq_enable_o = irq_enable_q;

  for (genvar n = 0; n < Axes; n++) begin : gen_axis
    localparam logic [11:0] STEP_LENGTH = card_map_pkg::ADDR_STEP_LENGTH + 12'(n * card_map_pkg::STRIDE_STEP_LENGTH);
    localparam logic [11:0] STEP_SPACE = card_map_pkg::ADDR_STEP_SPACE + 12'(n * card_map_pkg::STRIDE_STEP_SPACE);
    localparam logic [11:0] DIR_SETUP = card_map_pkg::ADDR_DIR_SETUP + 12'(n * card_map_pkg::STRIDE_DIR_SETUP);
    localparam logic [11:0] DIR_HOLD = card_map_pkg::ADDR_DIR_HOLD + 12'(n * card_map_pkg::STRIDE_DIR_HOLD);
    localparam logic [11:0] MODE = card_map_pkg::ADDR_MODE + 12'(n * card_map_pkg::STRIDE_MODE);

    logic [15:0] step_length_q;
    logic [15:0] step_space_q;
    logic [15:0] dir_setup_q;
    logic [15:0] dir_hold_q;
    logic [ 3:0] mode_q;

    always_ff @(posedge clk_i) begin
      if (write_i) begin
        case (word_i)
          STEP_LENGTH[11:2]: step_length_q <= data_i[15:0];
          STEP_SPACE[11:2]: step_space_q <= data_i[15:0];
          DIR_SETUP[11:2]: dir_setup_q <= data_i[15:0];
          DIR_HOLD[11:2]: dir_hold_q <= data_i[15:0];
          MODE[11:2]: mode_q <= data_i[3:0];
          default: ;
        endcase
      end
      if (rst_i) begin
        step_length_q <= card_map_pkg::RESET_STEP_LENGTH[15:0];
        step_space_q <= card_map_pkg::RESET_STEP_SPACE[15:0];
        dir_setup_q <= card_map_pkg::RESET_DIR_SETUP[15:0];
        dir_hold_q <= card_map_pkg::RESET_DIR_HOLD[15:0];
        mode_q <= card_map_pkg::RESET_MODE[3:0];
      end
    end

    assign step_length_o[16*n+:16] = step_length_q;
    assign step_space_o[16*n+:16] = step_space_q;
    assign dir_setup_o[16*n+:16] = dir_setup_q;
    assign dir_hold_o[16*n+:16] = dir_hold_q;
    assign mode_o[4*n+:4] = mode_q;
  end

endmodule

`default_nettype wire
