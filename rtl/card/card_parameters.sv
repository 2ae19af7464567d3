// Checks the card's parameters. If one is out of range, or lacks another one that it needs, elaboration stops here in
// every tool: an instance names a module that does not exist, and that name is the error message.
`default_nettype none
module card_parameters #(
    parameter int          Axes          = 4,
    parameter logic [31:0] Engines       = '0,    // bits card_map_pkg::ENGINE_*
    parameter int          Flags         = 0,     // bitwise OR of all parameters that must be 0 or 1
    parameter int          GeometryDepth = 4096,
    parameter int          FeedDepth     = 2560,
    parameter int          Captures      = 0,
    parameter int          Inputs        = 4,
    parameter int          Outputs       = 4,
    parameter int          Ports         = 1
) ();
  if (Axes < 1 || Axes > 8) begin : gen_wrong_axes
    ERROR_Axes_must_be_1_to_8 error ();
  end
  if (GeometryDepth < 2 || GeometryDepth > 32768 || FeedDepth < 2 || FeedDepth > 32768) begin : gen_wrong_depth
    ERROR_GeometryDepth_and_FeedDepth_must_be_2_to_32768 error ();
  end
  if (Ports < 1 || Ports > 4) begin : gen_wrong_ports
    ERROR_Ports_must_be_1_to_4 error ();
  end
  if (Inputs < 1 || Inputs > 32 || Outputs < 1 || Outputs > 16) begin : gen_wrong_pins
    ERROR_Inputs_must_be_1_to_32_and_Outputs_1_to_16 error ();
  end
  if (Captures < 0 || Captures > 4) begin : gen_wrong_captures
    ERROR_Captures_must_be_0_to_4 error ();
  end
  if (Flags != 0 && Flags != 1) begin : gen_wrong_flag
    ERROR_engines_and_BuildDirty_must_be_0_or_1 error ();
  end

  // If a flag is neither 0 nor 1, only that error is reported.
  if (Flags == 0 || Flags == 1) begin : gen_needs
    localparam logic PATH_COMMANDS = Engines[card_map_pkg::ENGINE_PATH_COMMANDS];
    localparam logic MACHINE_INPUTS = Engines[card_map_pkg::ENGINE_MACHINE_INPUTS];

    if (Engines[card_map_pkg::ENGINE_ACCUMULATOR_8] && !Engines[card_map_pkg::ENGINE_ACCUMULATOR]) begin : gen_eight
      ERROR_EightDirections_needs_Accumulator error ();
    end
    if (MACHINE_INPUTS && !PATH_COMMANDS) begin : gen_machine_inputs_alone
      ERROR_MachineInputs_needs_PathCommands error ();
    end
    if (Engines[card_map_pkg::ENGINE_SOFT_LIMITS] && !MACHINE_INPUTS) begin : gen_soft_limits_alone
      ERROR_SoftLimits_needs_MachineInputs error ();
    end
    if (Captures != 0 && !MACHINE_INPUTS) begin : gen_captures_alone
      ERROR_Captures_needs_MachineInputs error ();
    end
    if (Engines[card_map_pkg::ENGINE_CAPTURE_FIFO] && Captures == 0) begin : gen_capture_fifo_alone
      ERROR_CaptureFifo_needs_Captures error ();
    end
    if (Engines[card_map_pkg::ENGINE_PWM] && !PATH_COMMANDS) begin : gen_pwm_alone
      ERROR_Pwm_needs_PathCommands error ();
    end
    if (Engines[card_map_pkg::ENGINE_ENABLES] && !PATH_COMMANDS) begin : gen_enables_alone
      ERROR_Enables_needs_PathCommands error ();
    end
  end
endmodule
`default_nettype wire
