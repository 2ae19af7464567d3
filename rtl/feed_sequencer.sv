// Runs one feed piece after the other; the next one is swapped in at the last tick of the present one.
`default_nettype none

module feed_sequencer (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic        clear_i,
    input  wire logic        go_i,            // no fault
    // queue
    input  wire logic        empty_i,
    input  wire logic [15:0] word_i,
    output logic             read_o,
    // ticks
    input  wire logic        take_i,          // only while active_o
    input  wire logic        barrier_done_i,
    output logic             at_barrier_o,
    output logic             piece_waits_o,   // a decoded piece waits
    output logic             active_o,        // a piece gives ticks
    output logic             idle_o,          // nothing read or decoded
    output logic      [ 7:0] number_o,        // of the command under way
    // feed generator
    output logic             swap_o,
    output logic      [ 3:0] load_o,
    output logic      [15:0] load_word_o
);
  logic        load_count;
  logic        piece;
  logic        is_barrier;
  logic        valid;
  logic        swap;
  logic        last;
  logic [39:0] count;
  logic        mid_zero;
  logic        top_zero;
  logic [ 7:0] next_number;

  assign swap          = valid & piece & go_i & (~active_o | (take_i & last));
  assign piece_waits_o = valid & piece;

  feed_fetch fetch (
      .clk_i,
      .rst_i,
      .clear_i,
      .pop_i       (swap | barrier_done_i),
      .empty_i,
      .word_i,
      .read_o,
      .load_word_o,
      .load_count_o(load_count),
      .load_o,
      .piece_o     (piece),
      .barrier_o   (is_barrier),
      .idle_o,
      .valid_o     (valid)
  );

  count_chain next_count (
      .clk_i,
      .load_i    (load_count),
      .word_i    (load_word_o),
      .count_o   (count),
      .number_o  (next_number),
      .mid_zero_o(mid_zero),
      .top_zero_o(top_zero),
      .zero_o    ()
  );

  tick_counter ticks (
      .clk_i,
      .rst_i,
      .load_i    (swap),
      .count_i   (count),
      .mid_zero_i(mid_zero),
      .top_zero_i(top_zero),
      .take_i,
      .last_o    (last)
  );

  always_ff @(posedge clk_i) begin
    swap_o       <= swap & ~clear_i & ~rst_i;
    at_barrier_o <= valid & is_barrier & ~active_o & ~barrier_done_i & ~clear_i & ~rst_i;
    if (rst_i | clear_i) number_o <= 8'd0;
    else if (swap | barrier_done_i) number_o <= next_number;
    if (rst_i | clear_i) active_o <= 1'b0;
    else if (swap) active_o <= 1'b1;
    else if (take_i & last) active_o <= 1'b0;
  end
endmodule

`default_nettype wire
