// Position streaming: periods are lines. If nothing follows when the last tick of a line is taken, the line continues
// along itself and its ticks beyond the end are counted. After STREAMING.stale_periods times its own number of ticks,
// the next period is missing; from then on the line continues until the card is at rest.
//
// Two counters of 40 bits: the ticks left of the present round, and their initial value. A tick may come in every
// clock, so it is computed one tick ahead whether the next one is the last of a round.
//
// The mode changes only at rest, and not inside a command on its way in. So the under-run guard, which counts nothing
// in this mode, resumes with empty queues.
`default_nettype none

module position_streaming (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [arrival_pkg::WIDTH-1:0] arrival_i,
    input wire logic rest_i,  // nothing is queued or runs
    input wire logic begin_i,  // a path begins
    input wire logic [39:0] count_i,  // number of its ticks, in the clock after begin_i
    input wire logic period_ends_i,  // a period's last tick is taken
    input wire logic goes_on_i,  // the line continues beyond the period
    input wire logic stale_i,  // the line has continued beyond its period
    input wire logic take_i,
    output logic streaming_o,  // position streaming is in force
    output logic missing_o,  // event: the next period is missing
    output logic lost_o,  // from missing_o until the cut
    output logic [31:0] ticks_o  // ticks beyond the end of the last period that ended
);
  logic        on_q;
  logic [ 7:0] stale_periods_q;
  logic        inside_q;
  logic        writes;
  logic        ends;
  logic [31:0] data;
  assign writes = arrival_pkg::writes(arrival_i);
  assign ends   = arrival_pkg::ends(arrival_i);
  assign data   = setting_bus_pkg::data(setting_i);

  always_ff @(posedge clk_i) begin
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_STREAMING))
      {stale_periods_q, on_q} <= {data[15:8], data[0]};
    inside_q <= !ends && (inside_q || writes);
    if (rest_i && !inside_q && !writes) streaming_o <= on_q;
    if (rst_i || cut_i) inside_q <= 1'b0;
    if (rst_i) begin
      {stale_periods_q, on_q} <= {card_map_pkg::RESET_STREAMING[15:8], card_map_pkg::RESET_STREAMING[0]};
      streaming_o <= card_map_pkg::RESET_STREAMING[0];
    end
  end

  logic        begin_q;
  logic [39:0] length_q;
  logic [39:0] left_q;
  logic        short_q;  // the line has one tick
  logic        last_q;  // the next tick ends a round
  logic [ 7:0] rounds_q;  // rounds left
  logic        one;
  logic        missing;
  logic        stale_tick;  // a tick beyond the end of the line
  assign stale_tick = take_i && stale_i;
  assign one = count_i == 40'd1;
  assign missing = goes_on_i && !lost_o &&
      (period_ends_i ? stale_periods_q == 8'd0 : stale_tick && last_q && rounds_q == 8'd1);

  always_ff @(posedge clk_i) begin
    begin_q <= begin_i;
    if (begin_q) begin
      {length_q, short_q} <= {count_i, one};
      {left_q, last_q}    <= {count_i, one};
    end else if (stale_tick) begin
      left_q <= last_q ? length_q : left_q - 40'd1;
      last_q <= last_q ? short_q : left_q == 40'd2;
      if (last_q) rounds_q <= rounds_q - 8'd1;
    end
    if (period_ends_i) rounds_q <= stale_periods_q;
    if (rst_i || period_ends_i) ticks_o <= 32'd0;
    else if (stale_tick) ticks_o <= ticks_o + 32'd1;
    missing_o <= missing && !cut_i && !rst_i;
    lost_o    <= (lost_o || missing) && !cut_i && !rst_i;
  end

  logic unused;
  assign unused = &{1'b0, data[31:16], data[7:1]};
endmodule

`default_nettype wire
