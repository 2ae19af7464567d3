// The source of the card's ticks: the time base's enabled clocks, the feed pieces, the gate that takes their ticks.
`default_nettype none

module tick_source #(
    parameter logic [31:0] Engines = '1  // built-in engines: bits card_map_pkg::ENGINE_*
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic hold_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    // queue
    input wire logic empty_i,
    input wire logic [15:0] word_i,
    output logic read_o,
    input wire logic [arrival_pkg::WIDTH-1:0] arrival_i,
    // ticks
    input wire logic [path_pkg::WIDTH-1:0] path_i,
    input wire logic ready_i,  // the path's engine accepts ticks
    input wire logic finished_i,  // the path's engine has finished all ticks given so far
    input wire logic shut_i,  // no tick may be taken
    input wire logic wait_i,  // no tick may be taken or made: the drives are not enabled
    input wire logic settled_i,  // nothing has moved for 31 clocks
    output logic take_o,  // combinational
    output logic tick_o,
    output logic swap_o,  // event: a feed piece begins
    input wire logic card_idle_i,  // nothing runs, is decoded or queued; delayed by up to four clocks
    input wire logic session_gone_i,  // the session that wrote the stream has been replaced by another
    // barriers
    output logic at_barrier_o,
    output logic runs_o,  // a piece gives ticks, or a decoded one waits (combinational)
    // under-run
    output logic underrun_hold_o,
    output logic underrun_o,  // the under-run guard holds, or keeps a piece waiting
    output logic [31:0] underruns_o,  // number of under-run holds so far
    // status
    output logic active_o,  // a piece gives ticks
    output logic moving_o,  // the piece has given a tick, or directly follows one that has
    output logic fixed_o,  // the present piece's class is fixed (combinational)
    output logic silent_o,  // the present piece's ticks make no steps
    output logic idle_o,  // nothing runs, is decoded or queued (combinational)
    output logic [16:0] ratio_o,
    output logic [31:0] rate_o,
    output logic [31:0] begun_o,
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o
);
  logic [                     1:0] piece_class;
  logic [                     1:0] slew_shift;
  logic                            enable;
  logic                            feed_tick;
  logic                            feed_enable;
  logic                            feed_clear;
  logic [feed_load_pkg::WIDTH-1:0] load;
  logic                            decoder_idle;
  logic                            decoded;
  logic                            spent;
  logic                            must_wait;
  logic [ snapshot_pkg::WIDTH-1:0] behind_ratio;
  logic [ snapshot_pkg::WIDTH-1:0] behind_rate;

  // Ticks left of the path, for the snapshot REST.
  logic [                    39:0] left;
  assign left = path_i[path_pkg::UNFINISHED] && settled_i ? path_i[path_pkg::LEFT+:40] : '0;

  assign idle_o = decoder_idle && empty_i && !active_o;
  assign fixed_o = piece_class == 2'(card_map_pkg::CLASS_FIXED);

  time_base #(
      .Engines(Engines)
  ) base (
      .clk_i,
      .rst_i,
      .setting_i,
      .hold_i,
      .class_i(piece_class),
      .left_i(left[39:32]),
      .slew_shift_i(slew_shift),
      .snapshot_i,
      .snapshot_o(behind_ratio),
      .enable_o(enable),
      .ratio_o
  );

  feed_sequencer #(
      .Engines(Engines)
  ) pieces (
      .clk_i,
      .rst_i,
      .cut_i,
      .empty_i,
      .word_i,
      .read_o,
      .take_i(take_o),
      .wait_i(must_wait),
      .finished_i,
      .path_i,
      .at_barrier_o,
      .runs_o,
      .active_o,
      .decoded_o(decoded),
      .spent_o(spent),
      .moving_o,
      .class_o(piece_class),
      .slew_shift_o(slew_shift),
      .silent_o,
      .idle_o(decoder_idle),
      .swap_o,
      .load_o(load),
      .snapshot_i(behind_rate),
      .snapshot_o,
      .begun_o
  );

  if (Engines[card_map_pkg::ENGINE_UNDERRUN_HOLD]) begin : gen_underrun_hold
    underrun_guard #(
        .Probing(Engines[card_map_pkg::ENGINE_PATH_COMMANDS])
    ) guard (
        .clk_i,
        .rst_i,
        .cut_i(cut_i || path_i[path_pkg::STREAMING]),
        .lost_i(path_i[path_pkg::HALT]),
        .idle_i(card_idle_i),
        .gone_i(session_gone_i),
        .arrival_i,
        .load_i(load),
        .take_i(take_o && active_o),
        .swap_i(swap_o),
        .active_i(active_o),
        .decoded_i(decoded),
        .ratio_i(ratio_o),
        .wait_o(must_wait),
        .hold_o(underrun_hold_o),
        .shown_o(underrun_o),
        .underruns_o
    );
  end else begin : gen_no_underrun_hold
    assign {must_wait, underrun_hold_o, underrun_o, underruns_o} = '0;

    logic unused;
    assign unused = &{1'b0, arrival_i, decoded, card_idle_i, session_gone_i};
  end

  feed_generator generator (
      .clk_i,
      .rst_i,
      .clear_i(feed_clear),
      .enable_i(feed_enable),
      .freeze_i(spent),
      .load_i(load),
      .swap_i(swap_o),
      .left_i(left[31:0]),
      .snapshot_i(behind_ratio),
      .snapshot_o(behind_rate),
      .tick_o(feed_tick),
      .rate_o
  );

  tick_gate gate (
      .clk_i,
      .rst_i,
      .cut_i,
      .enable_i(enable),
      .feed_tick_i(feed_tick),
      .feed_active_i(active_o),
      .silent_i(silent_o),
      .direct_i(path_i[path_pkg::DIRECT]),
      .taking_i(path_i[path_pkg::TAKING]),
      .ready_i,
      .shut_i,
      .wait_i,
      .take_o,
      .tick_o,
      .feed_enable_o(feed_enable),
      .feed_clear_o(feed_clear)
  );
endmodule

`default_nettype wire
