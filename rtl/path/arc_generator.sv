// Arc generator: makes a circle from chords. It computes their increments and loads them into the plane's two axes,
// whose own pulse generators make the steps. Half chords of y and x alternate: y's start at half chord times, x's at
// whole chord times.
//
// Each axis's shadow holds one chord ahead. The next half chord of an axis begins as soon as its shadow is free. It has
// the time of two half chords and needs 13 clocks at most, so from the first chord on path ticks may come in every
// clock.
`default_nettype none

module arc_generator #(
    parameter int Axes = 4
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic clear_i,  // the arc is over, or cut
    input wire logic [load_bus_pkg::WIDTH-1:0] load_i,  // this unit's targets only while loadable_o
    input wire logic start_i,  // event: the state is loaded; the axes swap three clocks later
    input wire logic tick_i,  // path tick: at most one between start_i and ready_o
    output logic [15:0] chord_word_o,
    output logic [Axes-1:0] chord_load_o,  // by axis: shifts a halfword of the next increment in
    output logic [Axes-1:0] chord_swap_o,  // by axis: the next chord begins, a clock after the old one's last path tick
    output logic ready_o,  // path ticks may come
    output logic loadable_o
);
  logic [     4:0] k_q;
  logic [     4:0] m_q;
  logic            clockwise_q;
  logic [Axes-1:0] axis_x_q;
  logic [Axes-1:0] axis_y_q;
  logic [    15:0] word;

  assign word = load_bus_pkg::word(load_i);

  always_ff @(posedge clk_i) begin
    if (load_bus_pkg::to(load_i, load_target_pkg::CHORD_SHIFTS)) begin
      k_q <= word[4:0];
      m_q <= word[12:8];
    end
    if (load_bus_pkg::to(load_i, load_target_pkg::CHORD_PLANE)) begin
      clockwise_q <= word[0];
      for (int i = 0; i < Axes; i++) begin
        axis_x_q[i] <= word[6:4] == 3'(i);
        axis_y_q[i] <= word[10:8] == 3'(i);
      end
    end
  end

  logic in_x_q;  // 1: x moves, or waits to move; 0: y
  logic full_x_q;  // the axis's shadow holds an increment that is not yet swapped in
  logic full_y_q;
  logic ticked_q;
  logic begun_q;  // the first chords of both axes are swapped in
  logic begin_half;
  logic busy;
  logic last;
  logic loading;
  logic first;
  logic odd;
  logic even;
  logic begin_arc;
  logic swap_x;
  logic swap_y;

  assign begin_half = start_i | (~loadable_o & (~busy | last) & ~(in_x_q ^ last ? full_x_q : full_y_q));
  // The first chord of y is loaded before that of x. The one tick that may come before both are loaded ends no half
  // chord.
  assign begin_arc = full_x_q & (ticked_q | tick_i) & ~begun_q;
  assign swap_x = begin_arc | (tick_i & even);
  assign swap_y = begin_arc | (tick_i & odd);

  chord_rotation rotation (
      .clk_i,
      .rst_i,
      .clear_i,
      .load_i,
      .k_i(k_q),
      .minus_i(in_x_q ^ clockwise_q),
      .begin_i(begin_half),
      .busy_o(busy),
      .last_o(last),
      .loading_o(loading),
      .first_o(first),
      .word_o(chord_word_o)
  );

  chord_counter counter (
      .clk_i,
      .start_i,
      .tick_i,
      .m_i(m_q),
      .odd_o(odd),
      .even_o(even)
  );

  always_ff @(posedge clk_i) begin
    chord_load_o <= {Axes{loading}} & (in_x_q ? axis_x_q : axis_y_q);
    chord_swap_o <= ({Axes{swap_x}} & axis_x_q) | ({Axes{swap_y}} & axis_y_q);
    ticked_q <= ticked_q | tick_i;
    begun_q <= begun_q | begin_arc;
    full_x_q <= (full_x_q & ~swap_x) | (last & in_x_q);
    full_y_q <= (full_y_q & ~swap_y) | (last & ~in_x_q);
    if (last) in_x_q <= ~in_x_q;
    if (first & in_x_q) ready_o <= 1'b1;
    if (rst_i | clear_i) begin
      chord_load_o <= '0;
      chord_swap_o <= '0;
      loadable_o <= 1'b1;
      ready_o <= 1'b1;
    end else if (start_i) begin
      loadable_o <= 1'b0;
      ready_o <= 1'b0;
    end
    // full_y_q needs no reset: it is used only after y's first chord.
    if (rst_i | clear_i) begin
      in_x_q   <= 1'b0;
      ticked_q <= 1'b0;
      begun_q  <= 1'b0;
      full_x_q <= 1'b0;
    end
  end

  logic unused;
  assign unused = &{1'b0, word[15:13], word[7]};
endmodule

`default_nettype wire
