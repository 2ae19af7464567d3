// Takes snapshots: strobes the chain of latched values, and writes its words and the time to the requester's area of
// the RAM, one word per clock.
//
// The strobe comes one clock after the request. The words follow two clocks later, the time first. By then an access
// that was let through just before a stop's request has written its setting. The order of requests is stop, rest,
// probe, captures, MARK, host. Those of a stop, of its rest and of the probe's edge interrupt any other snapshot; a
// MARK's interrupts the host's. Interrupted snapshots of captures, of a MARK and of the host are taken again. A MARK
// does not interrupt a snapshot that is being taken again.
//
// A capture interrupts no snapshot, and a waiting MARK goes before a second capture. Neither of the two directly
// follows another snapshot: there is a clock in between, in which an access gets through. The host's follows directly.
// So neither a series of MARKs nor chattering inputs keep the host waiting. A capture requests until it is told that
// its area has the snapshot; if it withdraws the request in the meantime, it is not told.
// The chain delivers its words from the last position downwards; the words below the time follow those above it.
`default_nettype none
module snapshot_writer #(
    parameter int Axes = 4  // 1 to 8
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic host_i,  // events: each requests a snapshot
    input wire logic stop_i,
    input wire logic rest_i,
    input wire logic probe_i,
    input wire logic mark_i,
    input wire logic [3:0] capture_i,  // levels, by unit: each requests a snapshot
    input wire logic [31:0] word_i,  // word at the near end of the chain
    output logic strobe_o,
    output logic rest_o,  // the snapshot under way is for REST
    output logic shift_o,
    output logic active_o,  // from the strobe until the last word is in the RAM
    output logic [3:0] captured_o,  // events, by unit (combinational): the snapshot is taken
    output logic [9:0] clocks_o,  // low bits of the clocks since reset, delayed by two clocks
    output logic unit_o,  // bit 16 of these clocks: changes once per unit of LINK_TIMEOUT
    output logic [setting_bus_pkg::WIDTH-1:0] store_o  // combinational; 0 when there is nothing to write
);

  localparam logic [3:0] FAULT = card_map_pkg::IN_AREA_FAULT[5:2];
  localparam logic [3:0] GEOMETRY_BEGUN = card_map_pkg::IN_AREA_GEOMETRY_BEGUN[5:2];
  localparam logic [3:0] TIME_HI = card_map_pkg::IN_AREA_TIME_HI[5:2];
  localparam logic [3:0] TIME_LO = card_map_pkg::IN_AREA_TIME_LO[5:2];
  localparam logic [3:0] FIRST_POSITION = card_map_pkg::IN_AREA_POSITION[5:2];
  localparam logic [3:0] LAST_POSITION = FIRST_POSITION + 4'(Axes - 1);

  // Each area has 32 words, of which the first 16 are used. REST lies behind the other four. The captures follow REST
  // with 16 words each; capture 0 begins at half of the second area.
  localparam logic [1:0] SNAP = card_map_pkg::AREA_SNAP[8:7];
  localparam logic [1:0] STOP = card_map_pkg::AREA_STOP[8:7];
  localparam logic [1:0] PROBE = card_map_pkg::AREA_PROBE[8:7];
  localparam logic [1:0] MARK = card_map_pkg::AREA_MARK[8:7];

  // Clocks since reset, as they are written: delayed by two clocks, the high word by three.
  logic        carry_q;
  logic [63:0] time_q;

  assign clocks_o = time_q[9:0];
  assign unit_o   = time_q[16];

  always_ff @(posedge clk_i) begin
    if (carry_q) time_q[63:32] <= time_q[63:32] + 32'd1;
    {carry_q, time_q[31:0]} <= {1'b0, time_q[31:0]} + 33'd1;
    if (rst_i) begin
      carry_q <= 1'b0;
      time_q  <= -64'd2;
    end
  end

  logic       host_q;  // a request of the host waits
  logic       mark_q;  // a request of a MARK waits
  logic [1:0] area_q;
  logic       odd_q;  // of a capture: the upper half of the area
  logic       again_q;  // of the host's snapshot: it is taken again
  logic       settle_q;  // the clock between the strobe and the first word
  logic       write_q;
  logic [3:0] word_q;
  logic       last_q;  // the last word is on its way into the RAM
  logic       for_host;  // the snapshot under way is the host's
  logic       begin_first;  // a snapshot of a stop, its rest or the probe begins
  logic       begin_capture;  // a snapshot of a capture begins
  logic       begin_mark;  // a snapshot of a MARK begins, unless begin_first
  logic       begin_host;  // the host's snapshot begins, unless one of the others does
  logic       breaks;
  logic       capture_q;  // the snapshot under way, or the last one, is a capture's
  logic       wanted_q;  // the unit of the capture has requested it without a break
  logic [1:0] unit;  // the first unit that requests
  logic [1:0] unit_q;  // unit of the capture under way

  assign for_host = area_q == SNAP && !rest_o;
  assign begin_first = stop_i || rest_i || probe_i;
  assign begin_capture = !active_o && capture_i != '0 && !begin_first && !(capture_q && (mark_i || mark_q));
  assign begin_mark = active_o ? mark_i && for_host && !again_q : (mark_i || mark_q) && !begin_capture;
  assign begin_host = active_o ? last_q && !for_host && host_q : host_i;
  assign breaks = begin_first || begin_mark || begin_capture;

  assign unit = capture_i[0] ? 2'd0 : capture_i[1] ? 2'd1 : capture_i[2] ? 2'd2 : 2'd3;
  assign unit_q = {area_q[1], odd_q};
  assign captured_o = 4'(last_q && capture_q && wanted_q && capture_i[unit_q]) << unit_q;

  always_ff @(posedge clk_i) begin
    if (breaks || active_o || host_i) begin
      strobe_o <= breaks || begin_host;
      settle_q <= strobe_o && !breaks;
      last_q   <= write_q && word_q == FAULT && !breaks;
      host_q   <= host_i || (host_q && !(last_q && for_host && !breaks));
      mark_q   <= begin_first ? mark_i || mark_q || (active_o && area_q == MARK) : (mark_i || mark_q) && !begin_mark;
      if (settle_q) begin
        write_q <= 1'b1;
      end else if (write_q) begin
        if (word_q == TIME_HI) shift_o <= 1'b1;
        if (word_q == FAULT) begin
          write_q <= 1'b0;
          shift_o <= 1'b0;
        end
      end
      wanted_q <= wanted_q && capture_i[unit_q];
      if (last_q) active_o <= 1'b0;
      if (breaks || begin_host) begin
        active_o <= 1'b1;
        rest_o <= rest_i && !stop_i;
        capture_q <= begin_capture;
        wanted_q <= 1'b1;
        odd_q <= begin_capture && unit[0];
        area_q   <= stop_i ? STOP : rest_i ? 2'd0 : probe_i ? PROBE : begin_capture ? {unit[1], !unit[1]} :
            begin_mark ? MARK : SNAP;
        again_q <= active_o;
        write_q <= 1'b0;
        shift_o <= 1'b0;
      end
    end
    if (rst_i) begin
      strobe_o <= 1'b0;
      shift_o <= 1'b0;
      settle_q <= 1'b0;
      write_q <= 1'b0;
      last_q <= 1'b0;
      host_q <= 1'b0;
      mark_q <= 1'b0;
      capture_q <= 1'b0;
      active_o <= 1'b0;
    end
  end

  // word_q counts only while words are written. An interruption needs no reset here: each snapshot sets word_q first.
  always_ff @(posedge clk_i) begin
    if (settle_q) begin
      word_q <= TIME_LO;
    end else if (write_q) begin
      case (word_q)
        TIME_HI: word_q <= LAST_POSITION;
        FIRST_POSITION: word_q <= GEOMETRY_BEGUN;
        default: word_q <= word_q - 4'd1;
      endcase
    end
  end

  logic [31:0] data;
  logic [ 2:0] group;

  assign data = word_q == TIME_LO ? time_q[31:0] : word_q == TIME_HI ? time_q[63:32] : word_i;
  assign group = rest_o || capture_q ? card_map_pkg::AREA_REST[11:9] : card_map_pkg::AREA_SNAP[11:9];
  assign store_o = write_q ? setting_bus_pkg::pack(1'b1, {group, area_q, odd_q, word_q}, data) : '0;

endmodule
`default_nettype wire
