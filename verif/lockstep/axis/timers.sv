// The timers beside the axes, as one top for their lockstep.
`default_nettype none

module timers (
    input  wire logic                              clk_i,
    input  wire logic                              rst_i,
    input  wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    output logic                                   tick_o,
    input  wire logic                              running_i,
    output logic                                   busy_o
);
  wait_timer wait_limit (
      .clk_i,
      .rst_i,
      .setting_i,
      .tick_o
  );

  busy_timer status_busy (
      .clk_i,
      .rst_i,
      .running_i,
      .busy_o
  );
endmodule

`default_nettype wire
