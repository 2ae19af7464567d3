// The card's inputs: two flip-flops each against metastability, then the polarity.
`default_nettype none

module input_pins #(
    parameter int Inputs = 4  // 1 to 32
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [Inputs-1:0] pin_i,
    output logic [Inputs-1:0] level_o  // combinational
);
  // The attribute makes tools place the two flip-flops side by side, and ignore the timing of the first one's data.
  (* async_reg = "true" *) logic [Inputs-1:0] first_q;
  (* async_reg = "true" *) logic [Inputs-1:0] second_q;
  logic [Inputs-1:0] inverted_q;

  logic [31:0] data;

  assign data = setting_bus_pkg::data(setting_i);

  always_ff @(posedge clk_i) begin
    first_q  <= pin_i;
    second_q <= first_q;
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_INPUT_POLARITY)) inverted_q <= data[Inputs-1:0];
    if (rst_i) begin
      first_q <= '0;
      second_q <= '0;
      inverted_q <= card_map_pkg::RESET_INPUT_POLARITY[Inputs-1:0];
    end
  end

  assign level_o = second_q ^ inverted_q;

  if (Inputs < 32) begin : gen_few
    logic unused;
    assign unused = &{1'b0, data[31:Inputs]};
  end
endmodule

`default_nettype wire
