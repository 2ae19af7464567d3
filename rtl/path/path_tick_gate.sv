// Path ticks: counts the prescaler's steps and gives them to the path's engine one at a time; tells when all are
// finished.
//
// `ready_o` falls while two or more ticks wait. A tick that is taken reaches the prescaler one clock later, and its
// step reaches this counter three clocks after that. So at most seven wait: three bits would be enough; four leave room
// for a step at the same time.
`default_nettype none

module path_tick_gate (
    input  wire logic clk_i,
    input  wire logic rst_i,
    input  wire logic cut_i,
    input  wire logic coming_i,           // a tick is on its way through the prescaler, up to its step
    input  wire logic step_i,             // from the prescaler
    input  wire logic engine_ready_i,
    input  wire logic engine_stepping_i,  // the engine is not in the last clocks of a step
    output logic      tick_o,             // to the engine
    output logic      ready_o,            // feed ticks may be taken
    output logic      payload_ready_o,    // like done_o, but earlier, by the latency of a halfword on the load bus
    output logic      done_o              // no tick is coming or waits, and the engine has finished the last one
);
  logic [3:0] count_q;
  logic       waiting_q;
  logic       give;
  logic       quiet;

  // An engine lowers ready in the clock after a tick, so no tick is given in the clock of tick_o.
  assign give  = waiting_q && engine_ready_i && !tick_o;
  assign quiet = !coming_i && !waiting_q && !tick_o;

  always_ff @(posedge clk_i) begin : p_count
    logic [3:0] count_d;

    if (cut_i || rst_i) begin
      count_q   <= 4'd0;
      waiting_q <= 1'b0;
      ready_o   <= 1'b1;
    end else if (step_i ^ give) begin
      count_d = step_i ? count_q + 4'd1 : count_q - 4'd1;
      count_q   <= count_d;
      waiting_q <= count_d != 4'd0;
      ready_o   <= count_d < 4'd2;
    end
  end

  always_ff @(posedge clk_i) begin
    tick_o          <= give && !cut_i && !rst_i;
    done_o          <= quiet && engine_ready_i && !rst_i;
    payload_ready_o <= (quiet && !engine_stepping_i) || rst_i;
  end
endmodule

`default_nettype wire
