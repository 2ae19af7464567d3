// The counters of the path, as one top for their lockstep: a count that is shifted in and counted
// down, and the commands begun.
`default_nettype none

module counters (
    input  wire logic                           clk_i,
    input  wire logic                           rst_i,
    // count of the next path
    input  wire logic                           load_i,
    input  wire logic [                   15:0] word_i,
    output logic      [                   39:0] count_o,
    output logic                                zero_o,
    // ticks
    input  wire logic                           swap_i,
    input  wire logic                           take_i,
    output logic      [                   39:0] left_o,
    output logic                                last_o,
    // commands begun
    input  wire logic                           cut_i,
    input  wire logic                           begin_i,
    input  wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic      [snapshot_pkg::WIDTH-1:0] snapshot_o,
    output logic      [                   31:0] begun_o
);
  tick_counter ticks (
      .clk_i,
      .rst_i,
      .next_i(load_i),
      .word_i,
      .count_o,
      .zero_o,
      .load_i(swap_i),
      .take_i,
      .left_o,
      .last_o
  );

  begun_counter begun (
      .clk_i,
      .rst_i,
      .cut_i,
      .begin_i,
      .snapshot_i,
      .snapshot_o,
      .begun_o
  );
endmodule

`default_nettype wire
