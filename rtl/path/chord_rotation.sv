// The rotation of an arc in chords, 16 bits per clock: moves one coordinate by the other one / 2^k, rounded. The
// movement plus the closing increment is the increment of the coordinate's axis.
//
// Source and target exchange places in every half chord: the source's words go where the target was, the moved target's
// words where the source was. So the next half chord finds its own source in the same place, and no coordinate is
// selected.
//
// A half chord has four clocks in which the source passes the funnel shifter and circulates, a fifth clock if k
// >= 16 (the funnel then needs one more word), and four clocks in which the words are added. Loads come only at rest;
// all chains are loaded before a start.
`default_nettype none

module chord_rotation (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic clear_i,
    input wire logic [load_bus_pkg::WIDTH-1:0] load_i,
    input wire logic [4:0] k_i,
    input wire logic minus_i,  // the coordinate moves against the other one's sign; constant in a half chord
    input wire logic begin_i,  // at rest or with last_o: the next clock is a half chord's first
    output logic busy_o,
    output logic last_o,  // last clock of the half chord
    output logic loading_o,  // the next clock has a halfword of the increment
    output logic first_o,  // that halfword is the first of three
    output logic [15:0] word_o
);
  // Clocks of a half chord, one-hot.
  logic [3:0] pass_q;
  logic       gap_q;
  logic [3:0] add_q;
  logic       passing_q;
  logic       adding_q;
  logic       enter;  // the last clock before the first word is added

  assign enter = gap_q | (pass_q[3] & ~k_i[4]);
  assign busy_o = passing_q | gap_q | adding_q;
  assign last_o = add_q[3];
  assign first_o = add_q[0];
  assign loading_o = |add_q[2:0];

  always_ff @(posedge clk_i) begin
    pass_q    <= {pass_q[2:0], begin_i};
    passing_q <= begin_i | (|pass_q[2:0]);
    gap_q     <= pass_q[3] & k_i[4];
    add_q     <= {add_q[2:0], enter};
    adding_q  <= enter | (|add_q[2:0]);
    if (rst_i | clear_i) begin
      pass_q <= '0;
      gap_q  <= 1'b0;
      add_q  <= '0;
    end
  end

  logic        load_state;
  logic        load_closing;
  logic [15:0] loaded;
  assign load_state = load_bus_pkg::to(load_i, load_target_pkg::CHORD_STATE);
  assign load_closing = load_bus_pkg::to(load_i, load_target_pkg::CHORD_CLOSING);
  assign loaded = load_bus_pkg::word(load_i);

  // Funnel: two words of the source, and the bit below them, which rounds. A subtraction adds the complement plus one,
  // and this one is the complement of the rounding bit: complementing the source provides both. After the last word its
  // sign is extended.
  logic [63:0] source_q;  // X and Y alternate
  logic [15:0] word_q;
  logic [15:0] before_q;
  logic        below_q;
  logic [19:0] coarse_q;  // shifted by multiples of 4; the lowest bit rounds
  logic [16:0] fine;
  logic [15:0] moved_q;  // zero except while words are added, so that a load passes the adder unchanged

  assign fine = 17'(coarse_q >> k_i[1:0]);

  always_ff @(posedge clk_i) begin
    word_q   <= passing_q ? source_q[15:0] ^ {16{minus_i}} : {16{word_q[15]}};
    before_q <= word_q;
    below_q  <= k_i[4] ? before_q[15] : minus_i;
    coarse_q <= 20'({word_q, before_q, below_q} >> {k_i[3:2], 2'b00});
    if (enter | loading_o) moved_q <= fine[16:1];
    else moved_q <= '0;
  end

  // The words of the target, least significant first, and of the closing increments: y's and x's alternate, y's first,
  // though x's is loaded first.
  logic [63:0] target_q;
  logic [95:0] closing_q;
  logic [16:0] sum;
  logic [16:0] increment;
  logic        carry_q;
  logic        increment_carry_q;
  assign sum = {1'b0, target_q[15:0]} + {1'b0, moved_q} + {16'd0, carry_q};
  assign increment = {1'b0, closing_q[63:48]} + {1'b0, moved_q} + {16'd0, increment_carry_q};

  always_ff @(posedge clk_i) begin
    carry_q <= enter ? fine[0] : adding_q & sum[16];
    increment_carry_q <= enter ? fine[0] : increment[16];
    word_o <= increment[15:0];
    if (passing_q | adding_q | load_state) source_q <= {passing_q ? source_q[15:0] : sum[15:0], source_q[63:16]};
    if (adding_q | load_state) target_q <= {adding_q ? source_q[15:0] : loaded, target_q[63:16]};
    if (loading_o | load_closing) closing_q <= {loading_o ? closing_q[15:0] : loaded, closing_q[95:16]};
  end
endmodule

`default_nettype wire
