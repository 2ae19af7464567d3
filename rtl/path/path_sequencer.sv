// Runs one path after the other: swaps the decoded command in at the last tick of a line, waits for an arc's engine or
// for the axes of a direct move to finish, and stops at barriers.
//
// A swap is decided in one clock and carried out in the next, together with the tick (both leave as registers), so that
// the last tick still meets the old increments and the next one the new.
`default_nettype none

module path_sequencer #(
    parameter int Axes = 4
) (
    input  wire logic            clk_i,
    input  wire logic            rst_i,
    input  wire logic            clear_i,
    input  wire logic            go_i,             // no fault
    // decoded command
    input  wire logic            valid_i,
    input  wire logic            line_i,
    input  wire logic            arc_i,
    input  wire logic            barrier_i,
    input  wire logic [Axes-1:0] mask_i,
    output logic                 pop_o,            // taken now (combinational)
    // direct move: the chains are loaded
    input  wire logic            direct_go_i,
    input  wire logic [Axes-1:0] direct_mask_i,
    // ticks
    input  wire logic            take_i,
    input  wire logic            last_i,
    output logic                 taking_o,         // ticks may be taken
    output logic                 swap_o,           // a path begins with the next tick
    output logic                 load_count_o,     // as swap_o, a clock earlier (combinational)
    output logic      [Axes-1:0] active_o,         // sampled with swap_o
    output logic                 prescaler_o,      // sampled with swap_o: the path is an arc
    output logic                 arc_start_o,
    output logic                 direct_o,         // a direct move is under way
    output logic                 arc_busy_o,
    // ends
    input  wire logic            axes_live_i,
    input  wire logic            engine_empty_i,
    input  wire logic            engine_at_end_i,
    output logic                 incomplete_o,     // an arc ended elsewhere
    input  wire logic            barrier_done_i,
    output logic                 at_barrier_o,
    output logic                 active_path_o
);
  // Clocks from the last take until its path tick is counted (5) or an axis's live flag has followed it (4).
  localparam logic [2:0] SETTLE_CLOCKS = 3'd7;

  logic       idle_q;  // no path
  logic       drain_q;  // the last tick is taken, the engine still works
  logic [2:0] settle_q;
  logic       settled_q;
  logic       over;
  logic       ending;
  logic       path_valid;
  logic       swap;

  assign path_valid    = valid_i & (line_i | arc_i);
  assign ending        = take_i & last_i & ~drain_q;
  assign over          = settled_q & (arc_busy_o ? engine_empty_i : ~axes_live_i);
  // Behind a line the next path takes over in the clock of the last tick.
  assign swap          = path_valid & go_i & (idle_q | (ending & ~arc_busy_o & ~direct_o));
  assign pop_o         = swap | barrier_done_i;
  assign load_count_o  = swap | direct_go_i;
  assign active_path_o = ~idle_q;

  always_ff @(posedge clk_i) begin
    swap_o       <= (swap | direct_go_i) & ~clear_i & ~rst_i;
    arc_start_o  <= swap & arc_i & ~clear_i & ~rst_i;
    incomplete_o <= over & arc_busy_o & ~engine_at_end_i & ~clear_i & ~rst_i;
    at_barrier_o <= valid_i & barrier_i & idle_q & ~barrier_done_i & ~clear_i & ~rst_i;
    settled_q    <= drain_q & (settle_q == 3'd0) & ~over & ~clear_i & ~rst_i;
    if (~drain_q) settle_q <= SETTLE_CLOCKS;
    else if (settle_q != 3'd0) settle_q <= settle_q - 3'd1;

    if (swap) begin
      active_o    <= line_i ? mask_i : '0;
      prescaler_o <= arc_i;
    end else if (direct_go_i) begin
      active_o    <= direct_mask_i;
      prescaler_o <= 1'b0;
    end

    if (rst_i | clear_i) begin
      idle_q     <= 1'b1;
      taking_o   <= 1'b0;
      drain_q    <= 1'b0;
      arc_busy_o <= 1'b0;
      direct_o   <= 1'b0;
    end else if (swap | direct_go_i) begin
      idle_q     <= 1'b0;
      taking_o   <= 1'b1;
      drain_q    <= 1'b0;
      arc_busy_o <= swap & arc_i;
      direct_o   <= ~swap;
    end else if (ending) begin
      idle_q   <= ~arc_busy_o & ~direct_o;
      taking_o <= direct_o;
      drain_q  <= arc_busy_o | direct_o;
    end else if (over) begin
      idle_q     <= 1'b1;
      taking_o   <= 1'b0;
      drain_q    <= 1'b0;
      arc_busy_o <= 1'b0;
      direct_o   <= 1'b0;
    end
  end
endmodule

`default_nettype wire
