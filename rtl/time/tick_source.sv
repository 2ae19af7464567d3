// Where the card's ticks come from: the time base's enabled clocks, the feed pieces, the gate that takes their ticks.
`default_nettype none

module tick_source #(
    parameter logic [31:0] Engines = '1  // what is built in, as the register ENGINES shows it
) (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic        cut_i,
    input  wire logic        hold_i,
    input  wire logic [40:0] setting_i,
    // queue
    input  wire logic        empty_i,
    input  wire logic [15:0] word_i,
    output logic             read_o,
    // ticks
    input  wire logic        direct_i,         // a direct move is under way
    input  wire logic        taking_i,         // a path takes ticks
    input  wire logic        ready_i,          // and so does its engine
    output logic             take_o,           // combinational
    output logic             tick_o,
    output logic             swap_o,           // of the feed piece
    // barriers
    input  wire logic        barrier_begin_i,
    input  wire logic        barrier_done_i,
    output logic             at_barrier_o,
    output logic             runs_o,           // a piece gives ticks, or a decoded one waits (combinational)
    // status
    output logic             active_o,         // a piece gives ticks
    output logic             moving_o,         // and has, or the one before it in one go
    output logic             fixed_o,          // the piece's class is fixed (combinational)
    output logic             idle_o,           // nothing runs, is decoded or queued (combinational)
    output logic      [16:0] ratio_o,
    output logic      [31:0] rate_o,
    output logic      [31:0] begun_o,
    input  wire logic [ 1:0] snapshot_i,
    input  wire logic [31:0] chain_i,
    output logic      [31:0] chain_o
);
  logic [ 1:0] class_now;
  logic        enable;
  logic        feed_tick;
  logic        feed_enable;
  logic        feed_clear;
  logic [19:0] load;
  logic        decoder_idle;
  logic [31:0] ratio_chain;
  logic [31:0] rate_chain;

  assign idle_o  = decoder_idle && empty_i && !active_o;
  assign fixed_o = class_now == 2'(card_map_pkg::CLASS_FIXED);

  time_base #(
      .Engines(Engines)
  ) base (
      .*,
      .class_i (class_now),
      .chain_o (ratio_chain),
      .enable_o(enable)
  );

  feed_sequencer #(
      .Engines(Engines)
  ) pieces (
      .*,
      .class_o(class_now),
      .take_i (take_o),
      .idle_o (decoder_idle),
      .load_o (load),
      .chain_i(rate_chain)
  );

  feed_generator generator (
      .*,
      .clear_i (feed_clear),
      .enable_i(feed_enable),
      .load_i  (load),
      .swap_i  (swap_o),
      .chain_i (ratio_chain),
      .chain_o (rate_chain),
      .tick_o  (feed_tick)
  );

  tick_gate gate (
      .*,
      .enable_i     (enable),
      .feed_tick_i  (feed_tick),
      .feed_active_i(active_o),
      .feed_enable_o(feed_enable),
      .feed_clear_o (feed_clear)
  );
endmodule

`default_nettype wire
