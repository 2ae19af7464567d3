// The card's inputs, from the pins to levels and roles. With the engine machine_inputs each input that has a filter
// length goes through its filter, and the roles are found from the filtered levels. Without it there are no roles.
`default_nettype none

module card_inputs #(
    parameter int          Axes    = 4,   // 1 to 8
    parameter logic [31:0] Engines = '1,  // built-in engines: bits card_map_pkg::ENGINE_*
    parameter int          Inputs  = 4    // 1 to 32
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [Inputs-1:0] pin_i,
    output logic [input_levels_pkg::WIDTH-1:0] inputs_o,
    output logic [input_roles_pkg::WIDTH-1:0] roles_o
);
  logic [Inputs-1:0] raw;

  assign inputs_o[input_levels_pkg::RAW+:32] = 32'(raw);

  if (Engines[card_map_pkg::ENGINE_PATH_COMMANDS]) begin : gen_pins
    input_pins #(
        .Inputs(Inputs)
    ) pins (
        .clk_i,
        .rst_i,
        .setting_i,
        .pin_i,
        .level_o(raw)
    );
  end else begin : gen_no_pins
    assign raw = '0;

    logic unused;
    assign unused = &{1'b0, clk_i, rst_i, setting_i, pin_i};
  end

  if (Engines[card_map_pkg::ENGINE_MACHINE_INPUTS]) begin : gen_machine_inputs
    logic [       9:0] word;
    logic [      31:0] data;
    logic              set_filter;
    logic              set_role;
    logic [Inputs-1:0] filtered;
    logic [Inputs-1:0] stands;
    logic [Inputs-1:0] quiet;
    logic [Inputs-1:0] filters_q;  // inputs with a filter; the others bypass it
    logic [Inputs-1:0] levels;

    assign levels = filters_q & filtered | ~filters_q & raw;
    assign quiet = stands | ~filters_q;

    assign word = setting_bus_pkg::word(setting_i);
    assign data = setting_bus_pkg::data(setting_i);
    // From 0xE00 on the map has the 32 words of the filters, then the 64 words of the roles: words 7'h00 and 7'h20 of
    // that range.
    assign set_filter = setting_i[setting_bus_pkg::SET] && word[9:5] == card_map_pkg::ADDR_INPUT_FILTER[11:7];
    assign set_role = setting_i[setting_bus_pkg::SET] && word[9:7] == card_map_pkg::ADDR_ROLE[11:9] &&
        word[6] != word[5];

    input_filter #(
        .Inputs(Inputs),
        .Quiet (32'(Engines[card_map_pkg::ENGINE_CAPTURES]))
    ) filter (
        .clk_i,
        .rst_i,
        .levels_i(raw),
        .set_i(set_filter),
        .set_input_i(word[4:0]),
        .set_length_i(data[15:0]),
        .levels_o(filtered),
        .quiet_o(stands)
    );

    always_ff @(posedge clk_i) begin
      for (int n = 0; n < Inputs; n++) begin
        if (set_filter && word[4:0] == 5'(n)) filters_q[n] <= data[15:0] != 16'd0;
      end
      if (rst_i) filters_q <= '0;
    end

    role_scan #(
        .Axes  (Axes),
        .Inputs(Inputs)
    ) roles (
        .clk_i,
        .rst_i,
        .levels_i(levels),
        .set_i(set_role),
        .set_role_i({!word[5], word[4:0]}),
        .set_mask_i(data[Inputs-1:0]),
        .roles_o
    );

    assign inputs_o[input_levels_pkg::LEVELS+:32] = 32'(levels);
    assign inputs_o[input_levels_pkg::QUIET+:32]  = 32'(quiet);

    logic unused;
    assign unused = &{1'b0, data};
  end else begin : gen_no_machine_inputs
    assign inputs_o[input_levels_pkg::LEVELS+:32] = 32'(raw);
    assign inputs_o[input_levels_pkg::QUIET+:32] = '0;
    assign roles_o = '0;
  end
endmodule

`default_nettype wire
