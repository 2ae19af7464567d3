// Runs one feed piece after the other; the next one is swapped in at the last tick of the present one.
//
// In position streaming a piece without a successor is spent after its ticks, but continues at its rate while a path
// takes ticks, until the next piece is decoded.
//
// The ticks of a silent piece make no steps. The silence lasts until the engines have finished the last of these ticks
// and its steps have reached the axes' gate; a piece that is not silent begins no earlier. In position streaming a
// silent piece does not continue after its ticks.
`default_nettype none

module feed_sequencer #(
    parameter logic [31:0] Engines = '1  // built-in engines: bits card_map_pkg::ENGINE_*
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    // queue
    input wire logic empty_i,
    input wire logic [15:0] word_i,
    output logic read_o,
    // ticks
    input wire logic take_i,
    input wire logic wait_i,  // no piece may begin
    input wire logic finished_i,  // the engines have finished every tick given
    input wire logic [path_pkg::WIDTH-1:0] path_i,
    output logic at_barrier_o,
    output logic runs_o,  // a piece gives ticks, or a decoded one waits (combinational)
    output logic active_o,  // a piece gives ticks
    output logic decoded_o,  // a decoded piece waits (combinational)
    output logic spent_o,  // the piece runs on beyond its own ticks
    output logic moving_o,  // the piece has given a tick, or directly follows one that has
    output logic [1:0] class_o,  // class of the piece that was swapped in last
    output logic [1:0] slew_shift_o,  // doublings of SLEW in that piece, with classes
    output logic silent_o,  // the ticks of that piece make no steps
    output logic idle_o,  // nothing is read or decoded
    // feed generator
    output logic swap_o,
    output logic [feed_load_pkg::WIDTH-1:0] load_o,
    // number of commands begun
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o,
    output logic [31:0] begun_o
);
  logic piece;
  logic [1:0] piece_class;
  logic piece_silent;
  logic [1:0] piece_slew_shift;
  logic sounds;  // the decoded piece must wait for the end of the silence
  logic is_barrier;
  logic is_probe_end;
  logic dropped;
  logic valid;
  logic swap;
  logic last;
  logic ending;
  logic goes_on;
  logic drops;
  logic halt;

  assign drops = path_i[path_pkg::DROP];
  assign halt = path_i[path_pkg::HALT];
  assign decoded_o = valid && piece;
  assign dropped = valid && drops && !is_probe_end;
  assign ending = take_i && last && !spent_o;
  assign sounds = silent_o && !piece_silent;
  assign swap = decoded_o && !wait_i && !sounds && !drops && (!active_o || spent_o || ending);
  assign goes_on = path_i[path_pkg::STREAMING] && !silent_o && !swap &&
      (ending ? active_o : spent_o && path_i[path_pkg::TAKING]);
  assign runs_o = active_o || decoded_o;

  feed_decoder #(
      .Engines(Engines)
  ) decoder (
      .clk_i,
      .rst_i,
      .cut_i,
      .pop_i(swap || path_i[path_pkg::BARRIER_DONE] || dropped),
      .active_i(active_o),
      .empty_i,
      .word_i,
      .read_o,
      .load_o,
      .piece_o(piece),
      .class_o(piece_class),
      .silent_o(piece_silent),
      .slew_shift_o(piece_slew_shift),
      .barrier_o(is_barrier),
      .probe_end_o(is_probe_end),
      .idle_o,
      .valid_o(valid)
  );

  tick_counter ticks (
      .clk_i,
      .rst_i,
      .next_i (feed_load_pkg::to(load_o, load_target_pkg::FEED_TICKS)),
      .word_i (feed_load_pkg::word(load_o)),
      .count_o(),
      .zero_o (),
      .load_i (swap),
      .take_i (take_i && !spent_o),
      .left_o (),
      .last_o (last)
  );

  // A barrier that has begun is counted already.
  logic barrier_under_way;
  assign barrier_under_way = path_i[path_pkg::BARRIER_COUNTS] || path_i[path_pkg::BARRIER_DONE];

  begun_counter begun (
      .clk_i,
      .rst_i,
      .cut_i,
      .begin_i(swap_o || path_i[path_pkg::BARRIER_BEGINS] || (dropped && !barrier_under_way)),
      .snapshot_i,
      .snapshot_o,
      .begun_o
  );

  always_ff @(posedge clk_i) begin
    swap_o <= swap && !cut_i && !rst_i;
    at_barrier_o <= valid && is_barrier && !dropped && !active_o && !path_i[path_pkg::BARRIER_DONE] && !cut_i && !rst_i;
    if (rst_i || cut_i || halt) active_o <= 1'b0;
    else if (swap) active_o <= 1'b1;
    else if ((ending || spent_o) && !goes_on) active_o <= 1'b0;
    spent_o <= goes_on && !cut_i && !halt && !rst_i;
    if (rst_i || cut_i || halt) moving_o <= 1'b0;
    else if (take_i || spent_o) moving_o <= active_o && (swap || goes_on || !(ending || spent_o));
  end

  // A step of lines reaches the axes' gate 10 clocks after its tick is taken. A step of an engine reaches it 3 clocks
  // after finished_i rises; finished_i falls 2 clocks after a tick is taken.
  logic [3:0] settle_q;
  always_ff @(posedge clk_i) begin
    settle_q <= silent_o && !active_o && finished_i && !rst_i ? settle_q + 4'd1 : 4'd0;
    if (rst_i) silent_o <= 1'b0;
    else if (swap && !cut_i) silent_o <= piece_silent;
    else if (settle_q == 4'd15) silent_o <= 1'b0;
  end

  // A direct move has no pieces: it runs in the class feed with SLEW itself, and so does everything after a cut.
  if (Engines[card_map_pkg::ENGINE_CLASSES]) begin : gen_classes
    always_ff @(posedge clk_i) begin
      if (rst_i || cut_i || halt || path_i[path_pkg::DIRECT]) begin
        class_o <= 2'(card_map_pkg::CLASS_FEED);
        slew_shift_o <= 2'd0;
      end else if (swap) begin
        class_o <= piece_class;
        slew_shift_o <= piece_slew_shift;
      end
    end
  end else begin : gen_no_classes
    assign class_o = 2'(card_map_pkg::CLASS_FEED);
    assign slew_shift_o = 2'd0;

    logic unused;
    assign unused = &{1'b0, piece_class, piece_slew_shift};
  end

  logic unused_path;  // fields for gate and stops
  assign unused_path = &{1'b0, path_i};
endmodule

`default_nettype wire
