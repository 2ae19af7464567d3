// The card's outputs: set and cleared by commands; a cut gives those that OUTPUT_SAFE names their safe levels.
`default_nettype none

module output_pins #(
    parameter int Outputs = 4  // 1 to 16
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [Outputs-1:0] idle_i,  // strap: the levels in reset
    input wire logic change_i,
    input wire logic [Outputs-1:0] set_i,  // with change_i; goes before clear_i
    input wire logic [Outputs-1:0] clear_i,
    output logic [Outputs-1:0] pin_o
);
  logic [Outputs-1:0] safe_q;
  logic [Outputs-1:0] changes_q;  // those that a cut changes

  logic [31:0] data;

  assign data = setting_bus_pkg::data(setting_i);

  always_ff @(posedge clk_i) begin
    if (cut_i) pin_o <= (pin_o & ~changes_q) | (safe_q & changes_q);
    else if (change_i) pin_o <= (pin_o & ~clear_i) | set_i;
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_OUTPUT_SAFE)) begin
      safe_q <= data[Outputs-1:0];
      changes_q <= data[16+:Outputs];
    end
    if (rst_i) begin
      pin_o <= idle_i;
      safe_q <= card_map_pkg::RESET_OUTPUT_SAFE[Outputs-1:0];
      changes_q <= card_map_pkg::RESET_OUTPUT_SAFE[16+:Outputs];
    end
  end

  logic unused;
  assign unused = &{1'b0, data[31:0]};
endmodule

`default_nettype wire
