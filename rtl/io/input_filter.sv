// The digital filter of the inputs. Each input has its own length, in scans of 64 clocks.
//
// A scan looks at one input every two clocks. An output changes when its input has differed from it in every clock of
// as many whole scans as its length says. So a level that lasts at most 64 * length clocks never passes, and one that
// lasts 64 * (length + 1) clocks always does. Between two scans of an input a flip-flop records whether the level came
// back. Without it, short pulses that the scans happen to meet would add up to a long one.
// With Quiet, a flag per input says that the input has equalled its output for as many whole scans. The same counter
// counts both. The flag is set as the input passes, and falls one clock after the input differs.
// Lengths are 0 after a reset. No length may be set in the 64 clocks after it, in which the lengths are cleared.
`default_nettype none

module input_filter #(
    parameter int Inputs = 8,  // 1 to 32
    parameter int Quiet  = 0   // 0: without quiet_o
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [Inputs-1:0] levels_i,  // in this clock domain
    input wire logic set_i,
    input wire logic [4:0] set_input_i,
    input wire logic [15:0] set_length_i,  // scans; 65,535 of them are at least 20 ms at up to 209 MHz
    output logic [Inputs-1:0] levels_o,
    output logic [Inputs-1:0] quiet_o
);
  logic [ 5:0] clocks_q;  // clock within the scan
  logic [ 5:0] late_q;  // clocks_q two clocks earlier, to match the latency of the RAMs
  logic        clearing_q;
  logic [15:0] length_read_q;
  logic [15:0] count_read_q;
  logic [15:0] next_q;  // scans for which the input has differed from its output, or agreed with it, up to this one
  // Comparisons made one clock before the decision, so that only these flags lie between the levels and the decision.
  logic        none_q;  // the length is 0
  logic        next_lasts_q;  // next_q has reached the length
  logic [31:0] differs;  // inputs that differ from their outputs now
  logic [31:0] differed_q;  // inputs that have differed in every clock since their last scan

  // The content of the RAMs comes two clocks after the address.
  logic        decides;
  logic [ 4:0] reads;
  logic [ 4:0] scanned;

  assign decides = !clocks_q[0];
  assign reads   = clocks_q[5:1];
  assign scanned = late_q[5:1];

  logic [31:0] agreed_q;  // inputs that have agreed in every clock since their last scan
  logic        steady;
  logic        lasts;
  logic        passes;
  logic [15:0] count;
  logic [31:0] changes;

  always_comb begin
    differs = 32'(levels_i) ^ 32'(levels_o);
    // At the greatest length, at the latest, the input passes or is quiet. While it is quiet, its count may wrap, because
    // nothing depends on it before the input differs and the count starts again.
    steady  = differs[scanned] ? differed_q[scanned] : agreed_q[scanned];
    count   = steady ? next_q : 16'd0;
    lasts   = decides && (clearing_q || (steady ? next_lasts_q : none_q));
    passes  = lasts && differs[scanned];
    changes = passes ? 32'd1 << scanned : 32'd0;
  end

  always_ff @(posedge clk_i) begin
    clocks_q <= clocks_q + 6'd1;
    late_q   <= late_q + 6'd1;
    if (clocks_q == '1) clearing_q <= 1'b0;
    levels_o   <= levels_o ^ changes[Inputs-1:0];
    differed_q <= differs & ~changes & (differed_q | (decides ? 32'd1 << scanned : 32'd0));
    if (rst_i) begin
      clocks_q   <= '0;
      late_q     <= 6'd62;
      clearing_q <= 1'b1;
      levels_o   <= '0;
      differed_q <= '0;
    end
  end

  if (Quiet != 0) begin : gen_quiet
    localparam logic [31:0] PRESENT = 32'hFFFF_FFFF >> (32 - Inputs);  // no flip-flops for absent inputs

    logic [31:0] looked_at;

    assign looked_at = decides ? PRESENT & (32'd1 << scanned) : 32'd0;

    always_ff @(posedge clk_i) begin
      agreed_q <= (~differs | changes) & (agreed_q | looked_at);
      quiet_o  <= Inputs'((32'(quiet_o) & ~differs) | changes | (lasts && steady ? ~differs & looked_at : 32'd0));
      if (rst_i) begin
        agreed_q <= '0;
        quiet_o  <= '0;
      end
    end
  end else begin : gen_no_quiet
    assign agreed_q = '0;
    assign quiet_o  = '0;
  end

  logic [15:0] lengths[0:31];
  logic [15:0] counts [0:31];

  // Each RAM has one write port and one read port, with a register behind it.
  always_ff @(posedge clk_i) begin
    if (set_i || clearing_q) lengths[clearing_q?scanned : set_input_i] <= clearing_q ? 16'd0 : set_length_i;
    length_read_q <= lengths[reads];
  end

  always_ff @(posedge clk_i) begin
    if (decides) counts[scanned] <= count;
    count_read_q <= counts[reads];
    next_q <= count_read_q + 16'd1;
    none_q <= length_read_q == 16'd0;
    next_lasts_q <= count_read_q + 16'd1 >= length_read_q;
  end
endmodule

`default_nettype wire
