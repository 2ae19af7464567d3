// Causes of a stop that come from the machine's inputs: limits, drive faults, the probe outside probing, the tool
// setter. Each cause is reported one clock after it arises; stop_control decides what to do.
`default_nettype none

module limit_check #(
    parameter int Axes = 4
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [input_roles_pkg::WIDTH-1:0] roles_i,
    input wire logic [Axes-1:0] step_i,  // steps on the path
    input wire logic [Axes-1:0] dir_i,  // direction of each axis's last step: 1 backwards, 0 forwards
    input wire logic runs_i,  // a path or a direct move is under way
    input wire logic probing_i,
    input wire logic stopping_i,  // a fault's stop is under way
    input wire logic [31:0] clear_i,  // ones written to FAULT
    output logic [stop_causes_pkg::WIDTH-1:0] causes_o,
    output logic [23:0] state_o  // the register LIMIT_STATE
);
  logic [    31:0] data;
  logic            clears_limit;
  logic            clears_drives;
  logic [     7:0] limit_minus;
  logic [     7:0] limit_plus;
  logic [Axes-1:0] drives;
  logic [Axes-1:0] any_step_q;
  logic [Axes-1:0] shared_q;
  logic            probe_counts_q;
  logic            tool_setter_counts_q;
  logic [     1:0] were_active_q;  // levels one clock ago: tool setter, probe
  logic            probed_q;
  logic            set_tool_q;
  logic [Axes-1:0] drives_q;
  logic [Axes-1:0] faulted_q;
  logic            ramp;
  logic [Axes-1:0] limited;  // axes with an active limit
  logic [Axes-1:0] into;
  logic [Axes-1:0] beyond;
  logic            any_limit;
  logic            watched_step;
  logic [Axes-1:0] minus;  // axes whose negative limit caused FAULT.limit
  logic [Axes-1:0] plus;  // axes whose positive limit caused FAULT.limit

  assign data = setting_bus_pkg::data(setting_i);
  assign clears_limit = clear_i[card_map_pkg::BIT_FAULT_LIMIT];
  assign clears_drives = clear_i[card_map_pkg::BIT_FAULT_DRIVE_FAULT];
  assign limit_minus = input_roles_pkg::limit_minus(roles_i);
  assign limit_plus = input_roles_pkg::limit_plus(roles_i);
  assign drives = roles_i[input_roles_pkg::DRIVE_FAULT+:Axes];
  assign any_limit = (limited & any_step_q) != '0;
  assign watched_step = (step_i & any_step_q) != '0;
  assign causes_o[stop_causes_pkg::LIMIT] = into != '0;
  assign causes_o[stop_causes_pkg::BEYOND] = beyond != '0;
  assign causes_o[stop_causes_pkg::DRIVE_FAULT] = drives_q != '0;
  assign causes_o[stop_causes_pkg::PROBE] = probed_q;
  assign causes_o[stop_causes_pkg::TOOL_SETTER] = set_tool_q;
  // stopping_i shows a ramp two clocks after the step that began it; `into` covers the clock before.
  assign ramp = stopping_i || into != '0;
  assign state_o[7:0] = 8'(minus);
  assign state_o[15:8] = 8'(plus);
  assign state_o[23:16] = 8'(faulted_q);

  for (genvar n = 0; n < Axes; n++) begin : gen_axis
    logic [1:0] active;

    limit_axis #(
        .Axis(n)
    ) axis (
        .clk_i,
        .rst_i,
        .setting_i,
        .limit_i({limit_plus[n], limit_minus[n]}),
        .step_i(step_i[n]),
        .dir_i(dir_i[n]),
        .shared_i(shared_q[n]),
        .any_step_i(any_step_q[n]),
        .any_limit_i(any_limit),
        .watched_step_i(watched_step),
        .ramp_i(ramp),
        .clear_i(clears_limit),
        .active_o(active),
        .into_o(into[n]),
        .beyond_o(beyond[n]),
        .caused_o({plus[n], minus[n]})
    );

    assign limited[n] = active != 2'b00;
  end

  always_ff @(posedge clk_i) begin
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_STOP_CAUSES)) begin
      any_step_q <= data[Axes-1:0];
      shared_q <= data[Axes+7:8];
      probe_counts_q <= data[card_map_pkg::BIT_FAULT_PROBE];
      tool_setter_counts_q <= data[card_map_pkg::BIT_FAULT_TOOL_SETTER];
    end
    were_active_q <= {roles_i[input_roles_pkg::TOOL_SETTER], roles_i[input_roles_pkg::PROBE]};
    probed_q <= probe_counts_q && roles_i[input_roles_pkg::PROBE] && !were_active_q[0] && runs_i && !probing_i;
    set_tool_q <= tool_setter_counts_q && roles_i[input_roles_pkg::TOOL_SETTER] && !were_active_q[1] && runs_i;
    drives_q <= drives;
    faulted_q <= (clears_drives ? '0 : faulted_q) | drives_q;
    if (rst_i) begin
      any_step_q <= '0;
      shared_q <= '0;
      probe_counts_q <= 1'b0;
      tool_setter_counts_q <= 1'b0;
      were_active_q <= 2'b11;
      probed_q <= 1'b0;
      set_tool_q <= 1'b0;
      drives_q <= '0;
      faulted_q <= '0;
    end
  end

  logic unused;  // bits of absent axes; the buttons
  assign unused = &{1'b0, data, limit_minus, limit_plus, roles_i, clear_i};
endmodule

`default_nettype wire
