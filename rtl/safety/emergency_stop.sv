// The emergency stop's pin. Its level sets a flip-flop asynchronously, so that a glitch between two clock edges is
// latched and outputs change without a clock. The cause of a stop and FAULT.emergency_stop follow through a
// synchroniser.
//
// A clear takes effect only when the synchronised pin is inactive and the latch has become the cause. So no press
// passes without FAULT.emergency_stop, and a press that lasts is not cleared. A press in the clock of a clear sets the
// latch again.
`default_nettype none

module emergency_stop (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic pin_i,  // asynchronous
    input wire logic level_i,  // strap: the level that means stop
    input wire logic clear_i,  // event: a one was written to FAULT.emergency_stop
    output logic latched_o,  // latch of the emergency stop (asynchronous)
    output logic stop_o  // level: cause of a stop (combinational)
);
  (* async_reg = "true" *)logic pin_first_q;
  (* async_reg = "true" *)logic pin_second_q;
  (* async_reg = "true" *)logic latch_first_q;
  (* async_reg = "true" *)logic latch_second_q;
  logic pressed;
  logic clear;

  assign pressed = pin_i == level_i;
  assign clear   = clear_i && latch_second_q && pin_second_q != level_i;
  assign stop_o  = latch_second_q && !clear;

  always_ff @(posedge clk_i or posedge pressed) begin
    if (pressed) latched_o <= 1'b1;
    else if (clear || rst_i) latched_o <= 1'b0;
  end

  always_ff @(posedge clk_i) begin
    pin_first_q <= pin_i;
    pin_second_q <= pin_first_q;
    // The pin's level is included, so that it does not matter whether a simulation sets the latch before the edge or
    // with it.
    latch_first_q <= latched_o || pin_i == level_i;
    latch_second_q <= latch_first_q;
    if (clear || rst_i) begin
      latch_first_q  <= 1'b0;
      latch_second_q <= 1'b0;
    end
    if (rst_i) begin
      pin_first_q  <= 1'b0;
      pin_second_q <= 1'b0;
    end
  end
endmodule

`default_nettype wire
