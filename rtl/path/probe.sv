// The probe: armed by PROBE, tripped by an input. A trip stops the motion on a ramp; then all commands up to PROBE_END
// are dropped.
//
// PROBE waits until no path has run for 8 clocks, so that the last step of the path before it is out. If the input is
// tripped then, the card stops at once, since nothing moves: nothing after the PROBE begins. Otherwise the next
// commands run, and an edge (the input reaches the level that trips) brings the time base to rest, requests the
// snapshot one clock later, and ends the motion. PROBE_END then waits until the host has seen the edge and cleared it.
// A PROBE that is taken in the clock of the edge of the one before is dropped with the commands after it: otherwise the
// path from the input to the queues would be the card's longest.
//
// With FirstTouch the snapshot is that of the first touch, which the input's filter has still to confirm: the first raw
// change of the armed input since the PROBE, or since the input was quiet (capture_unit). A touch that is withdrawn
// leaves a snapshot that does not count. The request comes one clock after the edge, because the path from a filtered
// level to the snapshot would be one of the card's longest.
//
// No edge is taken while a fault's stop is under way, because its snapshot is being written, nor in the clock of a cut.
`default_nettype none

module probe #(
    parameter int FirstTouch = 0  // 1: the snapshot is that of the first touch
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic cut_i,
    input wire logic [31:0] level_i,  // levels after the filters
    input wire logic [31:0] raw_i,
    input wire logic [31:0] quiet_i,
    input wire logic [load_bus_pkg::WIDTH-1:0] load_i,
    input wire logic waits_i,  // a PROBE is decoded and no path runs
    input wire logic ends_i,  // PROBE_END has begun
    input wire logic at_rest_i,  // the ratio is 0
    input wire logic stopping_i,  // a fault's stop is under way
    input wire logic clear_i,  // event: CONTROL.probe_clear
    output logic met_o,  // the condition decoded last is met (combinational)
    output logic taken_o,  // the PROBE is taken now (combinational)
    output logic stays_o,  // PROBE_END must wait (combinational)
    output logic snapshot_o,  // event: requests a snapshot
    output logic hold_o,  // the time base slows down to rest
    output logic halt_o,  // event: the path and the piece under way end here
    output logic drop_o,  // from halt_o to PROBE_END commands are dropped
    output logic busy_o,
    output logic probed_o,
    output logic missed_o  // PROBE_END came before an edge
);
  // {level, input} of the command decoded last, and of the PROBE that is armed.
  logic [ 5:0] decoded_q;
  logic [ 5:0] condition_q;
  logic [ 2:0] settle_q;
  logic        armed_q;
  logic        look;  // the PROBE is carried out and checks whether its input is tripped already
  logic        edge_now;
  logic        trips;
  logic        touch;
  logic        touched_q;  // the snapshot of a touch is taken
  logic        late_q;  // a trip one clock ago requests its snapshot

  logic [15:0] word;

  // A condition names one of 32 inputs; inputs that the card lacks are 0.
  function automatic logic level_of(input logic [4:0] number);
    level_of = level_i[number];
  endfunction

  assign word = load_bus_pkg::word(load_i);
  assign met_o = level_of(decoded_q[4:0]) == decoded_q[5];
  assign edge_now = armed_q && level_of(condition_q[4:0]) == condition_q[5] && !stopping_i && !cut_i;
  assign taken_o = waits_i && settle_q == 3'd7 && !hold_o && !drop_o && !stopping_i && !cut_i;
  assign look = taken_o && !edge_now;
  assign trips = edge_now || (look && met_o);
  assign stays_o = edge_now || hold_o || (drop_o && probed_o);
  assign busy_o = armed_q || hold_o || drop_o;

  always_ff @(posedge clk_i) begin
    if (load_bus_pkg::to(load_i, load_target_pkg::COMMAND)) decoded_q <= word[5:0];
    if (look) condition_q <= decoded_q;
    if (!waits_i) settle_q <= 3'd0;
    else if (settle_q != 3'd7) settle_q <= settle_q + 3'd1;
  end

  always_ff @(posedge clk_i) begin
    halt_o   <= (hold_o && at_rest_i) || (look && met_o);
    probed_o <= trips || (probed_o && !clear_i);
    missed_o <= (ends_i && armed_q && !edge_now) || (missed_o && !look && !clear_i);
    armed_q  <= look ? !met_o : armed_q && !edge_now && !ends_i;
    hold_o   <= edge_now || (hold_o && !at_rest_i);
    drop_o   <= (hold_o && at_rest_i) || (look && met_o) || (drop_o && (!ends_i || probed_o));
    if (cut_i || rst_i) begin
      halt_o  <= 1'b0;
      armed_q <= 1'b0;
      hold_o  <= 1'b0;
      drop_o  <= 1'b0;
    end
    if (rst_i) begin
      probed_o <= 1'b0;
      missed_o <= 1'b0;
    end
  end

  // A cut has its own snapshot under way (REST), which this one would interrupt.
  assign snapshot_o = touch || (late_q && !cut_i);

  always_ff @(posedge clk_i) late_q <= trips && !touched_q && !touch && !cut_i && !rst_i;

  if (FirstTouch != 0) begin : gen_first_touch
    logic touched;  // the input is at the level that trips
    logic before_q;  // `touched` one clock ago
    logic quiet;  // quiet again; not as the filter passes, since the input was touched before

    assign quiet   = quiet_i[condition_q[4:0]] && !before_q;
    assign touched = raw_i[condition_q[4:0]] == condition_q[5];
    assign touch   = armed_q && touched && (!touched_q || quiet) && !stopping_i && !cut_i;

    always_ff @(posedge clk_i) begin
      before_q  <= armed_q && touched && !rst_i;
      touched_q <= armed_q && !edge_now && !look && (touch || (touched_q && !quiet));
      if (cut_i || rst_i) touched_q <= 1'b0;
    end
  end else begin : gen_no_first_touch
    assign touch = 1'b0;
    assign touched_q = 1'b0;

    logic unused_levels;
    assign unused_levels = &{1'b0, raw_i, quiet_i};
  end

  logic unused;
  assign unused = &{1'b0, word[15:6]};
endmodule

`default_nettype wire
