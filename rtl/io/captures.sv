// The capture units, and what the registers see of them.
`default_nettype none

module captures #(
    parameter int Captures = 4  // units, 1 to 4
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [input_levels_pkg::WIDTH-1:0] inputs_i,
    input wire logic [3:0] captured_i,  // events, a bit for each unit: the snapshot that it asks for is in its area
    output logic [3:0] ask_o,  // combinational
    output logic [31:0] state_o  // as CAPTURE_STATE has it
);
  logic [ 3:0] pending;
  logic [ 3:0] valid;
  logic [ 3:0] overrun;
  logic [ 3:0] active;
  logic [15:0] snapshots_q;
  logic [ 9:0] word;
  logic [31:0] data;
  logic        clears;

  assign word   = setting_bus_pkg::word(setting_i);
  assign data   = setting_bus_pkg::data(setting_i);
  assign clears = setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_CAPTURE_CLEAR);

  for (genvar n = 0; n < 4; n++) begin : gen_unit
    if (n < Captures) begin : gen_built
      localparam logic [9:0] SELECT = card_map_pkg::ADDR_CAPTURE_SELECT[11:2] + 10'(n);

      capture_unit of_input (
          .clk_i,
          .rst_i,
          .raw_i(input_levels_pkg::raw(inputs_i)),
          .level_i(input_levels_pkg::levels(inputs_i)),
          .quiet_i(input_levels_pkg::quiet(inputs_i)),
          .select_i(setting_i[setting_bus_pkg::SET] && word == SELECT),
          .setting_i(data),
          .clear_i(clears && data[n]),
          .captured_i(captured_i[n]),
          .ask_o(ask_o[n]),
          .pending_o(pending[n]),
          .valid_o(valid[n]),
          .overrun_o(overrun[n]),
          .active_o(active[n])
      );
    end else begin : gen_absent
      assign {ask_o[n], pending[n], valid[n], overrun[n], active[n]} = '0;
    end
  end

  always_ff @(posedge clk_i) begin
    if (captured_i != '0) snapshots_q <= snapshots_q + 16'd1;
    if (rst_i) snapshots_q <= '0;
  end

  assign state_o[card_map_pkg::BIT_CAPTURE_STATE_PENDING+:4] = pending;
  assign state_o[card_map_pkg::BIT_CAPTURE_STATE_VALID+:4] = valid;
  assign state_o[card_map_pkg::BIT_CAPTURE_STATE_OVERRUN+:4] = overrun;
  assign state_o[card_map_pkg::BIT_CAPTURE_STATE_ACTIVE+:4] = active;
  assign state_o[card_map_pkg::BIT_CAPTURE_STATE_SNAPSHOTS+:16] = snapshots_q;
endmodule

`default_nettype wire
