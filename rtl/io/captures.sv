// The capture units, and the state that the registers show of them.
`default_nettype none

module captures #(
    parameter int Captures    = 4,  // units, 1 to 4
    parameter int CaptureFifo = 0   // 1: with a queue
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [input_levels_pkg::WIDTH-1:0] inputs_i,
    input wire logic [capture_answer_pkg::WIDTH-1:0] answer_i,
    output logic [capture_pkg::WIDTH-1:0] capture_o
);
  logic [ 3:0] captured;
  logic [ 3:0] queued;
  logic [ 3:0] ask;
  logic [ 3:0] passed;
  logic [ 3:0] active_edge;
  logic [ 3:0] pending;
  logic [ 3:0] valid;
  logic [ 3:0] overrun;
  logic [ 3:0] active;
  logic [15:0] snapshots_q;
  logic [ 9:0] word;
  logic [31:0] data;
  logic        clears;
  logic [31:0] state;

  assign captured = capture_answer_pkg::captured(answer_i);
  assign queued = capture_answer_pkg::queued(answer_i);
  assign word = setting_bus_pkg::word(setting_i);
  assign data = setting_bus_pkg::data(setting_i);
  assign clears = setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_CAPTURE_CLEAR);

  for (genvar n = 0; n < 4; n++) begin : gen_unit
    if (n < Captures) begin : gen_built
      localparam logic [9:0] SELECT = card_map_pkg::ADDR_CAPTURE_SELECT[11:2] + 10'(n);

      capture_unit #(
          .Queue(CaptureFifo != 0)
      ) of_input (
          .clk_i,
          .rst_i,
          .raw_i(input_levels_pkg::raw(inputs_i)),
          .level_i(input_levels_pkg::levels(inputs_i)),
          .quiet_i(input_levels_pkg::quiet(inputs_i)),
          .select_i(setting_i[setting_bus_pkg::SET] && word == SELECT),
          .setting_i(data),
          .clear_i(clears && data[n]),
          .captured_i(captured[n]),
          .queued_i(queued[n]),
          .full_i(answer_i[capture_answer_pkg::FULL]),
          .ask_o(ask[n]),
          .passed_o(passed[n]),
          .active_edge_o(active_edge[n]),
          .pending_o(pending[n]),
          .valid_o(valid[n]),
          .overrun_o(overrun[n]),
          .active_o(active[n])
      );
    end else begin : gen_absent
      assign {ask[n], passed[n], active_edge[n], pending[n], valid[n], overrun[n], active[n]} = '0;
    end
  end

  always_ff @(posedge clk_i) begin
    if (captured != '0) snapshots_q <= snapshots_q + 16'd1;
    if (rst_i) snapshots_q <= '0;
  end

  assign state[card_map_pkg::BIT_CAPTURE_STATE_PENDING+:4] = pending;
  assign state[card_map_pkg::BIT_CAPTURE_STATE_VALID+:4] = valid;
  assign state[card_map_pkg::BIT_CAPTURE_STATE_OVERRUN+:4] = overrun;
  assign state[card_map_pkg::BIT_CAPTURE_STATE_ACTIVE+:4] = active;
  assign state[card_map_pkg::BIT_CAPTURE_STATE_SNAPSHOTS+:16] = snapshots_q;
  assign capture_o = capture_pkg::pack(state, active_edge, passed, ask);

  logic unused;  // bits of absent units
  assign unused = &{1'b0, queued};
endmodule

`default_nettype wire
