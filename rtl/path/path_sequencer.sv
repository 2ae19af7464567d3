// Runs one path after the other: swaps the decoded command in at the last tick of a line, waits for a path's engine or
// for the axes of a direct move to finish, and stops at barriers.
//
// In position streaming a line without a successor continues beyond its last tick (`stale_o`), until a path or a
// barrier is decoded. Once the next period is missing, only a cut ends the line.
//
// A swap is decided in one clock and carried out in the next, together with the tick (both leave as registers). So the
// last tick still meets the old increments, and the next one the new.
`default_nettype none

module path_sequencer #(
    parameter int Axes = 4
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic halt_i,  // event: the path ends here; no command is valid in this clock
    // decoded command
    input wire logic valid_i,  // a path or a barrier
    input wire logic [4:0] engine_i,  // number of the path's engine, card_map_pkg::ENGINE_*
    input wire logic barrier_i,
    input wire logic [Axes-1:0] mask_i,
    output logic pop_o,  // the command is taken now (combinational)
    // direct move: the chains are loaded
    input wire logic direct_go_i,
    input wire logic [Axes-1:0] direct_mask_i,
    // position streaming
    input wire logic streaming_i,  // position streaming is in force
    input wire logic lost_i,  // the next period is missing, or a cut is due: nothing begins
    output logic period_ends_o,  // a period's last tick is taken (combinational)
    output logic goes_on_o,  // the line continues beyond the period (combinational)
    output logic stale_o,  // the line has continued beyond its period
    // ticks
    input wire logic take_i,
    input wire logic last_i,
    output logic taking_o,  // ticks may be taken
    output logic swap_o,  // a path begins with the next tick
    output logic begin_o,  // swap_o one clock earlier (combinational)
    output logic [Axes-1:0] active_o,  // sampled with swap_o
    output logic [4:0] engine_o,  // sampled with swap_o: engine of the path
    output logic direct_o,  // a direct move is under way
    // ends
    input wire logic axes_live_i,
    input wire logic done_i,  // every path tick given is finished
    input wire logic missed_end_i,  // with done_i: the path ended away from its commanded end point
    output logic engine_taken_o,  // the engine is taken by a path that still takes ticks (combinational)
    output logic incomplete_o,  // event: a path missed its end point
    output logic over_o,  // event: a path ended: its last tick was taken (lines), or its engine has finished
    input wire logic barrier_done_i,
    output logic at_barrier_o,
    output logic path_active_o,
    output logic unfinished_o  // the path under way has ticks to take (combinational)
);
  // Clocks from the last enabled clock of a direct move until the axes are asked whether one is live.
  localparam logic [2:0] SETTLE_CLOCKS = 3'd7;
  localparam logic [4:0] LINES = 5'(card_map_pkg::ENGINE_LINES);
  // With this engine, too, the axes' own generators make the steps.
  localparam logic [4:0] ARC_GENERATOR = 5'(card_map_pkg::ENGINE_ARC_GENERATOR);

  logic       idle_q;  // no path is under way
  logic       drain_q;  // the last tick is taken, but the path has not ended
  logic       drained_q;  // drain_q one clock later: done_i includes the last tick
  logic [2:0] settle_q;
  logic       settled_q;
  logic       on_lines;
  logic       on_engine_q;  // the path runs on another engine than lines
  logic       over;
  logic       ending;
  logic       path_valid;
  logic       swap;
  logic       stale_ends;

  assign on_lines = engine_i == LINES;
  assign path_valid = valid_i && !barrier_i;
  assign ending = take_i && last_i && !stale_o;
  assign over = on_engine_q ? drained_q && done_i : settled_q && !axes_live_i;
  // After a line the next path takes over in the clock of the last tick. A path that missed its end point has no
  // successor.
  assign swap = path_valid && !incomplete_o && !lost_i && (idle_q || stale_o || (ending && !on_engine_q));
  assign pop_o = swap || barrier_done_i;
  assign begin_o = swap || direct_go_i;
  assign path_active_o = !idle_q;
  assign unfinished_o = !idle_q && !drain_q;
  assign engine_taken_o = on_engine_q && !drained_q;
  assign period_ends_o = streaming_i && ending && !on_engine_q && !direct_o;
  assign goes_on_o = streaming_i && (period_ends_o || stale_o) && !swap && (lost_i || !(valid_i && barrier_i));
  assign stale_ends = stale_o && !goes_on_o;

  always_ff @(posedge clk_i) begin
    swap_o       <= begin_o && !cut_i && !rst_i;
    over_o       <= ((over && drain_q) || (ending && !on_engine_q && !direct_o) || stale_ends) && !cut_i && !rst_i;
    incomplete_o <= over && on_engine_q && missed_end_i && !cut_i && !rst_i;
    at_barrier_o <= valid_i && barrier_i && idle_q && !barrier_done_i && !cut_i && !rst_i;
    stale_o      <= goes_on_o && !cut_i && !halt_i && !rst_i;
    drained_q    <= drain_q;
    settled_q    <= drain_q && settle_q == 3'd0;
    if (!drain_q) settle_q <= SETTLE_CLOCKS;
    else if (settle_q != 3'd0) settle_q <= settle_q - 3'd1;

    if (begin_o) begin
      active_o <= direct_go_i ? direct_mask_i : on_lines || engine_i == ARC_GENERATOR ? mask_i : '0;
      engine_o <= swap ? engine_i : LINES;
    end

    if (rst_i || cut_i || halt_i) begin
      idle_q <= 1'b1;
      taking_o <= 1'b0;
      drain_q <= 1'b0;
      on_engine_q <= 1'b0;
      direct_o <= 1'b0;
    end else if (begin_o) begin
      idle_q <= 1'b0;
      taking_o <= 1'b1;
      on_engine_q <= swap && !on_lines;
      direct_o <= direct_go_i;
    end else if (ending || stale_ends) begin
      idle_q   <= !on_engine_q && !direct_o && !goes_on_o;
      taking_o <= direct_o || goes_on_o;
      drain_q  <= on_engine_q || direct_o;
    end else if (over) begin
      idle_q <= 1'b1;
      taking_o <= 1'b0;
      drain_q <= 1'b0;
      on_engine_q <= 1'b0;
      direct_o <= 1'b0;
    end
  end
endmodule

`default_nettype wire
