// The registers that read as the card stands, STATUS and REFUSAL among them, the interrupt, and the far end of the
// snapshot chain: FAULT and STATUS. data_o is, a clock after sample_i, the live register that is read; four bits of its
// address tell the live registers apart.
//
// Each port has a REFUSAL of its own, which keeps the port's first refusal until the port clears it. Refusals and clears
// never meet: one access is carried through at a time.
`default_nettype none
module register_live #(
    parameter int          Ports   = 1,  // 1 to 4
    parameter logic [31:0] Engines = '1  // what is built in, as the register ENGINES shows it
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [40:0] setting_i,
    input wire logic [1:0] snapshot_i,  // {shift, strobe}
    input wire logic sample_i,
    input wire logic [13:0] access_i,  // {port, address}
    // refusals
    input wire logic clear_refusal_i,
    input wire logic refuse_i,
    input wire logic [15:0] reason_i,  // {number, reason}
    // STATUS
    input wire logic [5:0] motion_i,  // {stopping, ended, feed active, path active, direct, busy}
    input wire logic held_i,
    input wire logic [65:0] late_i,  // {a line goes on beyond its period, ticks; held for under-run, how often}
    input wire logic snapshotting_i,
    input wire logic incomplete_i,
    input wire logic [1:0] low_i,  // {feed, geometry}: below their watermarks
    // the other live registers
    input wire logic [31:0] fault_i,
    input wire logic [31:0] room_i,  // {geometry, feed}
    input wire logic [63:0] begun_i,  // {geometry, feed}
    input wire logic [66:0] io_i,  // {waiting, probe missed, probed, marks, outputs, inputs}
    output logic [31:0] status_o,  // combinational; refused is any port's
    output logic [31:0] data_o,
    output logic [31:0] chain_o,
    output logic irq_o
);

  logic [  3:0] refused;
  logic [111:0] refusal;

  for (genvar p = 0; p < 4; p++) begin : gen_port
    if (p < Ports) begin : gen_refusal
      logic        refused_q;
      logic [27:0] refusal_q;

      always_ff @(posedge clk_i) begin
        if (access_i[13:12] == 2'(p)) begin
          if (refuse_i && !refused_q) begin
            refused_q <= 1'b1;
            refusal_q <= {access_i[11:0], reason_i};
          end else if (clear_refusal_i) begin
            refused_q <= 1'b0;
            refusal_q <= '0;
          end
        end
        if (rst_i) begin
          refused_q <= 1'b0;
          refusal_q <= '0;
        end
      end

      assign refused[p] = refused_q;
      assign refusal[28*p+:28] = refusal_q;
    end else begin : gen_absent
      assign refused[p] = 1'b0;
      assign refusal[28*p+:28] = '0;
    end
  end

  assign status_o = 32'(motion_i[0]) << card_map_pkg::BIT_STATUS_BUSY |
      32'(motion_i[1]) << card_map_pkg::BIT_STATUS_DIRECT |
      32'(motion_i[2]) << card_map_pkg::BIT_STATUS_PATH_ACTIVE |
      32'(motion_i[3]) << card_map_pkg::BIT_STATUS_FEED_ACTIVE |
      32'(held_i) << card_map_pkg::BIT_STATUS_HELD |
      32'(motion_i[4]) << card_map_pkg::BIT_STATUS_ENDED |
      32'(fault_i != 32'd0) << card_map_pkg::BIT_STATUS_FAULTED |
      32'(refused != '0) << card_map_pkg::BIT_STATUS_REFUSED |
      32'(snapshotting_i) << card_map_pkg::BIT_STATUS_SNAPSHOT |
      32'(incomplete_i) << card_map_pkg::BIT_STATUS_INCOMPLETE |
      32'(motion_i[5]) << card_map_pkg::BIT_STATUS_STOPPING |
      32'(low_i[0]) << card_map_pkg::BIT_STATUS_GEOMETRY_LOW |
      32'(low_i[1]) << card_map_pkg::BIT_STATUS_FEED_LOW |
      32'(late_i[32]) << card_map_pkg::BIT_STATUS_UNDERRUN |
      32'(io_i[64]) << card_map_pkg::BIT_STATUS_PROBED |
      32'(io_i[65]) << card_map_pkg::BIT_STATUS_PROBE_MISSED |
      32'(io_i[66]) << card_map_pkg::BIT_STATUS_WAITING |
      32'(late_i[65]) << card_map_pkg::BIT_STATUS_STALE;

  always_ff @(posedge clk_i) begin
    if (sample_i) begin
      case (access_i[5:2])
        card_map_pkg::ADDR_STATUS[5:2]: begin
          data_o <= status_o;
          data_o[card_map_pkg::BIT_STATUS_REFUSED] <= refused[access_i[13:12]];
        end
        card_map_pkg::ADDR_FAULT[5:2]: data_o <= fault_i;
        card_map_pkg::ADDR_REFUSAL[5:2]: data_o <= {4'd0, refusal[28*access_i[13:12]+:28]};
        card_map_pkg::ADDR_GEOMETRY_ROOM[5:2]: data_o <= {16'd0, room_i[31:16]};
        card_map_pkg::ADDR_FEED_ROOM[5:2]: data_o <= {16'd0, room_i[15:0]};
        card_map_pkg::ADDR_GEOMETRY_BEGUN[5:2]: data_o <= begun_i[63:32];
        card_map_pkg::ADDR_INPUTS[5:2]: data_o <= {16'd0, io_i[15:0]};
        card_map_pkg::ADDR_OUTPUTS[5:2]: data_o <= {16'd0, io_i[31:16]};
        card_map_pkg::ADDR_MARKS[5:2]: data_o <= io_i[63:32];
        card_map_pkg::ADDR_FEED_BEGUN[5:2]: data_o <= begun_i[31:0];
        default:
        if (Engines[card_map_pkg::ENGINE_STREAMING] && access_i[5:2] == card_map_pkg::ADDR_STALE_TICKS[5:2])
          data_o <= late_i[64:33];
        else data_o <= late_i[31:0];
      endcase
    end
  end

  logic [31:0] enable_q;

  always_ff @(posedge clk_i) begin
    irq_o <= ((status_o ^ (32'd1 << card_map_pkg::BIT_STATUS_BUSY)) & enable_q) != '0;
    if (setting_i[40] && setting_i[39:32] == card_map_pkg::ADDR_IRQ_ENABLE[9:2]) enable_q <= setting_i[31:0];
    if (rst_i) begin
      irq_o <= 1'b0;
      enable_q <= card_map_pkg::RESET_IRQ_ENABLE;
    end
  end

  logic [31:0] chain;

  snapshot_slice #(
      .Width(16)
  ) i_fault (
      .clk_i,
      .snapshot_i,
      .value_i(fault_i[15:0]),
      .chain_i(32'd0),
      .chain_o(chain)
  );

  snapshot_slice #(
      .Width(18)
  ) i_status (
      .clk_i,
      .snapshot_i,
      .value_i(status_o[17:0] & ~(18'd1 << card_map_pkg::BIT_STATUS_SNAPSHOT)),
      .chain_i(chain),
      .chain_o
  );

endmodule
`default_nettype wire
