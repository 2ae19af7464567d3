// Counts the feed ticks that are queued, for paths and for pieces, and compares both counts with a limit.
//
// The counters have 56 bits: no queue holds 2^14 commands, and no command has more than 2^40 - 1 ticks. Four words of
// 14 bits rotate, one per clock, in passes of four clocks that begin with word_i = 0. A pass subtracts the ticks taken
// before it, or adds the count of a command that has arrived. So the counters are at most 12 clocks old. The pass of a
// command is over long before the count of the next one arrives, since a word of the stream takes longer than a pass.
//
// The counters begin at -Reserve instead of 0, so that `count <= limit` means `queued <= limit + Reserve`. The limit is
// compared with the result of the pass, one clock later: word 0 in the clock with word_i = 1.
`default_nettype none

module queued_ticks #(
    parameter int Reserve = 256
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic forget_i,  // nothing counts as queued; a command on its way in continues
    input wire logic [arrival_pkg::WIDTH-1:0] arrival_i,
    input wire logic take_i,
    input wire logic [1:0] word_i,  // word of the pass
    input wire logic [13:0] inverted_limit_i,  // a word of the limit, inverted, one clock after word_i
    output logic geometry_short_o,  // paths: count <= limit; valid a clock after the limit's last word
    output logic feed_short_o,  // pieces: count <= limit; valid a clock after the limit's last word
    output logic covered_o,  // paths have at least as many ticks as pieces
    output logic at_rest_o,  // the last piece ends at rest
    output logic at_barrier_o  // the command that arrived last is a barrier
);
  localparam logic [55:0] EMPTY = 56'd0 - 56'(Reserve);

  logic geometry_commit, feed_commit, comes, ends;
  logic [15:0] halfword;
  logic reset;
  assign geometry_commit = arrival_i[arrival_pkg::GEOMETRY_COMMIT];
  assign feed_commit = arrival_i[arrival_pkg::FEED_COMMIT];
  assign comes = arrival_pkg::writes(arrival_i);
  assign ends = arrival_pkg::ends(arrival_i);
  assign halfword = arrival_pkg::halfword(arrival_i);
  assign reset = rst_i || cut_i;

  // The command on its way in: header, three halfwords of count, payload. Of the payload only a piece's stop distance
  // is used.
  localparam logic [3:0] STOP_DISTANCE = 4'd10;
  logic [ 3:0] index_q;
  logic [39:0] count_q;
  logic        zero_q;  // the stop distance is 0
  logic        adding_q;
  always_ff @(posedge clk_i) begin
    if (reset || ends) index_q <= 4'd0;
    else if (comes && index_q[3:2] != 2'd3) index_q <= index_q + 4'd1;
    if (comes) begin
      if (index_q == 4'd1) count_q[15:0] <= halfword;
      if (index_q == 4'd2) count_q[31:16] <= halfword;
      if (index_q == 4'd3) count_q[39:32] <= halfword[7:0];
      if (index_q[3:1] == STOP_DISTANCE[3:1]) zero_q <= halfword == 16'd0 && (zero_q || !index_q[0]);
    end else if (adding_q) count_q <= {14'd0, count_q[39:14]};
  end

  // The task of the next pass. A barrier's count is clocks, not ticks.
  logic pending_q, of_paths_q, of_pieces_q, zero_pending_q;
  logic add_paths_q, add_pieces_q;
  logic [3:0] owed_q, taken_q;
  logic [3:0] owed;
  assign owed = owed_q + {3'd0, take_i};
  always_ff @(posedge clk_i) begin
    owed_q <= owed;
    if (word_i == 2'd3) begin
      adding_q <= pending_q;
      pending_q <= 1'b0;
      add_paths_q <= !of_pieces_q;
      add_pieces_q <= !of_paths_q;
      if (pending_q) begin
        at_barrier_o <= of_paths_q && of_pieces_q;
        if (!of_paths_q) at_rest_o <= zero_pending_q;
      end else begin
        owed_q  <= 4'd0;
        taken_q <= owed;
      end
    end
    if (geometry_commit || feed_commit) begin
      pending_q <= 1'b1;
      of_paths_q <= geometry_commit;
      of_pieces_q <= feed_commit;
      zero_pending_q <= zero_q;
    end
    if (reset || forget_i) begin
      owed_q <= 4'd0;
      pending_q <= 1'b0;
      at_rest_o <= 1'b0;
      at_barrier_o <= 1'b0;
    end
  end

  // The words rotate: only at the end of a pass is the lowest word in its place.
  logic clearing_q;
  always_ff @(posedge clk_i) clearing_q <= reset || forget_i || (clearing_q && word_i != 2'd3);

  logic [55:0] paths_q, pieces_q;
  logic paths_carry_q, pieces_carry_q;
  always_ff @(posedge clk_i) begin : p_count
    logic [13:0] change;
    logic [14:0] paths_sum, pieces_sum;
    logic first;

    first = word_i == 2'd0;
    change = adding_q ? count_q[13:0] : ~(first ? {10'd0, taken_q} : 14'd0);
    paths_sum = {1'b0, paths_q[13:0]} + {1'b0, change} + {14'd0, first ? !adding_q : paths_carry_q};
    pieces_sum = {1'b0, pieces_q[13:0]} + {1'b0, change} + {14'd0, first ? !adding_q : pieces_carry_q};
    paths_carry_q <= paths_sum[14];
    pieces_carry_q <= pieces_sum[14];
    // A counter that the command does not concern drops the sum after the addition: a table of the adder has room for
    // that.
    paths_q <= {adding_q && !add_paths_q ? paths_q[13:0] : paths_sum[13:0], paths_q[55:14]};
    pieces_q <= {adding_q && !add_pieces_q ? pieces_q[13:0] : pieces_sum[13:0], pieces_q[55:14]};
    if (clearing_q) begin
      paths_q  <= EMPTY;
      pieces_q <= EMPTY;
    end
  end

  // Carries of count - limit - 1 and of paths - pieces; the subtrahends are added inverted. The sign is in the last
  // word. Inverted there, it makes the carry tell which number is larger; the limit has no sign.
  logic [15:0] paths_over, pieces_over, covered;  // {carry, difference, place of the carry in}
  logic paths_over_q, pieces_over_q;
  logic [13:0] paths_word, pieces_word, inverted_limit;
  logic begins, closes;
  assign begins = word_i == 2'd1;
  assign closes = word_i == 2'd0;
  assign paths_word = {paths_q[55] ^ closes, paths_q[54:42]};
  assign pieces_word = {pieces_q[55] ^ closes, pieces_q[54:42]};
  assign inverted_limit = {inverted_limit_i[13] & ~closes, inverted_limit_i[12:0]};
  assign paths_over = {1'b0, paths_word, 1'b1} + {1'b0, inverted_limit, !begins && paths_over_q};
  assign pieces_over = {1'b0, pieces_word, 1'b1} + {1'b0, inverted_limit, !begins && pieces_over_q};
  assign covered = {1'b0, paths_word, 1'b1} + {1'b0, ~pieces_word, begins || covered_o};
  always_ff @(posedge clk_i) begin
    paths_over_q <= paths_over[15];
    pieces_over_q <= pieces_over[15];
    covered_o <= covered[15];
  end
  assign geometry_short_o = !paths_over_q;
  assign feed_short_o = !pieces_over_q;

  logic unused;
  assign unused = &{1'b0, paths_over[14:0], pieces_over[14:0], covered[14:0]};
endmodule

`default_nettype wire
