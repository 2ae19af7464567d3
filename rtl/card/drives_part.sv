// The drives part: tells the drives whether they may hold their axes. It has the enable with its brake and delays, and
// the outputs that show whether the card is healthy.
`default_nettype none
module drives_part #(
    parameter int          Axes    = 4,
    parameter logic [31:0] Engines = '1  // built-in engines: bits card_map_pkg::ENGINE_*
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic moves_i,  // a path or a direct move takes ticks
    input wire logic busy_i,  // something runs or is queued
    input wire logic emergency_i,  // level: emergency stop
    input wire logic [31:0] fault_i,
    input wire logic fed_i,  // the watchdog is running
    output logic enabled_o,
    output logic released_o,  // the brake is released
    output logic healthy_o,
    output logic pump_o,  // square wave of the charge pump
    output logic wait_o,  // no tick may be taken
    output logic waiting_o,  // motion waits for the enable (combinational)
    output logic [Axes-1:0] disabled_o  // events: the axis's drive is disabled (combinational)
);
  if (Engines[card_map_pkg::ENGINE_ENABLES]) begin : gen_enables
    drive_enable #(
        .Axes(Axes)
    ) sequence_of_drives (
        .clk_i,
        .rst_i,
        .setting_i,
        .moves_i,
        .busy_i,
        .emergency_i,
        .fault_i,
        .enabled_o,
        .released_o,
        .wait_o,
        .waiting_o,
        .disabled_o
    );

    card_health health (
        .clk_i,
        .rst_i,
        .setting_i,
        .fault_i,
        .fed_i,
        .healthy_o,
        .pump_o
    );
  end else begin : gen_no_enables
    assign enabled_o = 1'b0;
    assign released_o = 1'b0;
    assign healthy_o = 1'b0;
    assign pump_o = 1'b0;
    assign wait_o = 1'b0;
    assign waiting_o = 1'b0;
    assign disabled_o = '0;

    logic unused;
    assign unused = &{1'b0, clk_i, rst_i, setting_i, moves_i, busy_i, emergency_i, fault_i, fed_i};
  end
endmodule
`default_nettype wire
