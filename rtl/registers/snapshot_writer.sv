// Takes snapshots: strobes the chain of latched values and writes what it brings, and the time, to the RAM's area of
// whoever asked, a word a clock.
//
// The strobe is given in the clock after the request. The words follow two clocks later, the time first: an access that
// was let through just before a stop's request has written its setting by then. A stop's request goes before the host's
// and breaks into its snapshot, which is then taken anew.
// The chain's words go down from the last position; the words below the time follow those above it.
`default_nettype none
module snapshot_writer #(
    parameter int Axes = 4  // 1 to 8
) (
    input  wire logic        clk_i,
    input  wire logic        rst_i,
    input  wire logic        host_i,      // events: a snapshot is wanted
    input  wire logic        stop_i,
    input  wire logic [31:0] chain_i,
    output logic      [ 1:0] snapshot_o,  // {shift, strobe}
    output logic             active_o,    // from the strobe until the last word is in the RAM
    output logic      [ 7:0] clocks_o,    // since reset, two clocks late: the low byte
    output logic      [40:0] store_o      // {write, address, data}, combinational; 0 when there is nothing to write
);

  localparam logic [3:0] FAULT = card_map_pkg::IN_AREA_FAULT[5:2];
  localparam logic [3:0] GEOMETRY_BEGUN = card_map_pkg::IN_AREA_GEOMETRY_BEGUN[5:2];
  localparam logic [3:0] TIME_HI = card_map_pkg::IN_AREA_TIME_HI[5:2];
  localparam logic [3:0] TIME_LO = card_map_pkg::IN_AREA_TIME_LO[5:2];
  localparam logic [3:0] FIRST_POSITION = card_map_pkg::IN_AREA_POSITION[5:2];
  localparam logic [3:0] LAST_POSITION = FIRST_POSITION + 4'(Axes - 1);

  // Clocks since reset as they are written down: two clocks late, the high word three.
  logic        carry_q;
  logic [63:0] time_q;

  assign clocks_o = time_q[7:0];

  always_ff @(posedge clk_i) begin
    if (carry_q) time_q[63:32] <= time_q[63:32] + 32'd1;
    {carry_q, time_q[31:0]} <= {1'b0, time_q[31:0]} + 33'd1;
    if (rst_i) begin
      carry_q <= 1'b0;
      time_q  <= -64'd2;
    end
  end

  logic       host_q;  // the host's request is not served yet
  logic       for_stop_q;
  logic       settle_q;  // the clock between the strobe and the first word
  logic       write_q;
  logic [3:0] word_q;
  logic       last_q;  // the last word is on its way into the RAM
  logic       begin_stop;
  logic       begin_host;

  assign begin_stop = stop_i;
  assign begin_host = (host_i && !active_o) || (last_q && for_stop_q && host_q);

  always_ff @(posedge clk_i) begin
    if (begin_stop || active_o || host_i) begin
      snapshot_o[0] <= begin_stop || begin_host;
      settle_q <= snapshot_o[0] && !begin_stop;
      last_q <= write_q && word_q == FAULT && !begin_stop;
      host_q <= host_i || (host_q && !(last_q && !for_stop_q && !begin_stop));
      if (settle_q) begin
        write_q <= 1'b1;
        word_q  <= TIME_LO;
      end else if (write_q) begin
        case (word_q)
          TIME_HI: word_q <= LAST_POSITION;
          FIRST_POSITION: word_q <= GEOMETRY_BEGUN;
          default: word_q <= word_q - 4'd1;
        endcase
        if (word_q == TIME_HI) snapshot_o[1] <= 1'b1;
        if (word_q == FAULT) begin
          write_q <= 1'b0;
          snapshot_o[1] <= 1'b0;
        end
      end
      if (last_q) active_o <= 1'b0;
      if (begin_stop || begin_host) begin
        active_o <= 1'b1;
        for_stop_q <= begin_stop;
        write_q <= 1'b0;
        snapshot_o[1] <= 1'b0;
      end
    end
    if (rst_i) begin
      snapshot_o <= 2'b00;
      settle_q <= 1'b0;
      write_q <= 1'b0;
      last_q <= 1'b0;
      host_q <= 1'b0;
      active_o <= 1'b0;
    end
  end

  logic [ 3:0] area;
  logic [31:0] data;

  assign area = for_stop_q ? card_map_pkg::AREA_STOP[9:6] : card_map_pkg::AREA_SNAP[9:6];
  assign data = word_q == TIME_LO ? time_q[31:0] : word_q == TIME_HI ? time_q[63:32] : chain_i;
  assign store_o = write_q ? {1'b1, area, word_q, data} : '0;

endmodule
`default_nettype wire
