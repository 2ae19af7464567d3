// The inputs part: all signals that the card receives from the machine. It has the levels and roles of the inputs, the
// captures of their edges, and the emergency stop, whose latch works without a clock.
`default_nettype none
module inputs_part #(
    parameter int          Axes     = 4,
    parameter logic [31:0] Engines  = '1,  // built-in engines: bits card_map_pkg::ENGINE_*
    parameter int          Captures = 4,   // 0 to 4 units
    parameter int          Inputs   = 4    // 1 to 32
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    // inputs
    input wire logic [Inputs-1:0] pin_i,
    output logic [input_levels_pkg::WIDTH-1:0] inputs_o,
    output logic [input_roles_pkg::WIDTH-1:0] roles_o,
    // captures
    input wire logic [capture_answer_pkg::WIDTH-1:0] capture_answer_i,
    output logic [capture_pkg::WIDTH-1:0] capture_o,
    // the emergency stop
    input wire logic emergency_stop_i,
    input wire logic emergency_stop_level_i,  // strap: the level that means stop
    input wire logic [31:0] clear_fault_i,  // ones written to FAULT
    input wire logic filling_i,  // after a reset: the registers are not yet ready for a snapshot
    output logic latched_o,  // latch of the emergency stop (asynchronous)
    output logic emergency_o  // level: emergency stop, a cause of a stop
);
  card_inputs #(
      .Axes(Axes),
      .Engines(Engines),
      .Inputs(Inputs)
  ) of_machine (
      .clk_i,
      .rst_i,
      .setting_i,
      .pin_i,
      .inputs_o,
      .roles_o
  );

  if (Captures != 0) begin : gen_captures
    captures #(
        .Captures(Captures),
        .CaptureFifo(32'(Engines[card_map_pkg::ENGINE_CAPTURE_FIFO]))
    ) of_edges (
        .clk_i,
        .rst_i,
        .setting_i,
        .inputs_i(inputs_o),
        .answer_i(capture_answer_i),
        .capture_o
    );
  end else begin : gen_no_captures
    assign capture_o = '0;

    logic unused;
    assign unused = &{1'b0, capture_answer_i};
  end

  if (Engines[card_map_pkg::ENGINE_EMERGENCY_STOP]) begin : gen_emergency_stop
    logic stop;

    // The cause is withheld until the registers are ready. Nothing can move before, and the latch already holds drives
    // and outputs.
    assign emergency_o = stop && !filling_i;

    emergency_stop pin (
        .clk_i,
        .rst_i,
        .pin_i  (emergency_stop_i),
        .level_i(emergency_stop_level_i),
        .clear_i(clear_fault_i[card_map_pkg::BIT_FAULT_EMERGENCY_STOP]),
        .latched_o,
        .stop_o (stop)
    );

    logic unused;  // stop_control clears the other faults
    assign unused = &{1'b0, clear_fault_i};
  end else begin : gen_no_emergency_stop
    assign emergency_o = 1'b0;
    assign latched_o   = 1'b0;

    logic unused;
    assign unused = &{1'b0, emergency_stop_i, emergency_stop_level_i, clear_fault_i, filling_i};
  end
endmodule
`default_nettype wire
