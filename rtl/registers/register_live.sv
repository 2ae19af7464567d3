// The live registers, which show the present state of the card (STATUS and REFUSAL are among them), the interrupt, and
// the far end of the snapshot chain: FAULT and STATUS. One clock after sample_i, data_o is the live register that is
// read. Four address bits tell the live registers apart, except for CAPTURE_STATE and CAPTURE_QUEUE.
//
// Each port has its own REFUSAL, which keeps the port's first refusal until the port clears it. A refusal and a clear
// never come together, since accesses are carried out one at a time.
`default_nettype none
module register_live #(
    parameter int          Ports   = 1,  // 1 to 4
    parameter logic [31:0] Engines = '1  // built-in engines: bits card_map_pkg::ENGINE_*
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    input wire logic [register_access_pkg::WIDTH-1:0] access_i,
    input wire logic sample_i,
    input wire logic [refusal_pkg::WIDTH-1:0] refusal_i,
    // state that the registers show
    input wire logic busy_i,
    input wire logic [time_state_pkg::WIDTH-1:0] time_state_i,
    input wire logic [geometry_state_pkg::WIDTH-1:0] geometry_state_i,
    input wire logic [pins_state_pkg::WIDTH-1:0] pins_state_i,
    input wire logic [queue_state_pkg::WIDTH-1:0] queue_state_i,
    input wire logic [input_levels_pkg::WIDTH-1:0] inputs_i,
    input wire logic [input_roles_pkg::WIDTH-1:0] roles_i,
    input wire logic [31:0] capture_state_i,
    input wire logic [31:0] capture_queue_i,
    input wire logic snapshotting_i,
    input wire logic incomplete_i,  // the stream is inside a command
    output logic [31:0] status_o,  // combinational; its bit REFUSED shows a refusal of any port
    output logic [31:0] data_o,
    output logic irq_o,
    input wire logic [snapshot_pkg::WIDTH-1:0] snapshot_i,
    output logic [snapshot_pkg::WIDTH-1:0] snapshot_o
);

  logic [  3:0] refused;
  logic [111:0] refusal;
  logic [  1:0] port;
  logic [ 11:0] address;
  logic [ 31:0] fault;

  assign port = register_access_pkg::port(access_i);
  assign address = register_access_pkg::address(access_i);
  assign fault = time_state_pkg::fault(time_state_i);

  for (genvar p = 0; p < 4; p++) begin : gen_port
    if (p < Ports) begin : gen_refusal
      logic        refused_q;
      logic [27:0] refusal_q;

      always_ff @(posedge clk_i) begin
        if (port == 2'(p)) begin
          if (refusal_i[refusal_pkg::REFUSE] && !refused_q) begin
            refused_q <= 1'b1;
            refusal_q <= {address, refusal_pkg::why(refusal_i)};
          end else if (refusal_i[refusal_pkg::CLEAR]) begin
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

  assign status_o = 32'(busy_i) << card_map_pkg::BIT_STATUS_BUSY |
      32'(geometry_state_i[geometry_state_pkg::DIRECT]) << card_map_pkg::BIT_STATUS_DIRECT |
      32'(geometry_state_i[geometry_state_pkg::PATH_ACTIVE]) << card_map_pkg::BIT_STATUS_PATH_ACTIVE |
      32'(time_state_i[time_state_pkg::FEED_ACTIVE]) << card_map_pkg::BIT_STATUS_FEED_ACTIVE |
      32'(time_state_i[time_state_pkg::HELD]) << card_map_pkg::BIT_STATUS_HELD |
      32'(geometry_state_i[geometry_state_pkg::ENDED]) << card_map_pkg::BIT_STATUS_ENDED |
      32'(fault != 32'd0) << card_map_pkg::BIT_STATUS_FAULTED |
      32'(refused != '0) << card_map_pkg::BIT_STATUS_REFUSED |
      32'(snapshotting_i) << card_map_pkg::BIT_STATUS_SNAPSHOT |
      32'(incomplete_i) << card_map_pkg::BIT_STATUS_INCOMPLETE |
      32'(time_state_i[time_state_pkg::STOPPING]) << card_map_pkg::BIT_STATUS_STOPPING |
      32'(queue_state_i[queue_state_pkg::GEOMETRY_LOW]) << card_map_pkg::BIT_STATUS_GEOMETRY_LOW |
      32'(queue_state_i[queue_state_pkg::FEED_LOW]) << card_map_pkg::BIT_STATUS_FEED_LOW |
      32'(time_state_i[time_state_pkg::UNDERRUN]) << card_map_pkg::BIT_STATUS_UNDERRUN |
      32'(pins_state_i[pins_state_pkg::PROBED]) << card_map_pkg::BIT_STATUS_PROBED |
      32'(pins_state_i[pins_state_pkg::PROBE_MISSED]) << card_map_pkg::BIT_STATUS_PROBE_MISSED |
      32'(geometry_state_i[geometry_state_pkg::WAITING]) << card_map_pkg::BIT_STATUS_WAITING |
      32'(geometry_state_i[geometry_state_pkg::STALE]) << card_map_pkg::BIT_STATUS_STALE |
      32'(time_state_i[time_state_pkg::BUTTON_HOLD]) << card_map_pkg::BIT_STATUS_BUTTON_HOLD |
      32'(time_state_i[time_state_pkg::SETTLED]) << card_map_pkg::BIT_STATUS_SETTLED |
      32'(time_state_i[time_state_pkg::ENABLED]) << card_map_pkg::BIT_STATUS_ENABLED |
      32'(time_state_i[time_state_pkg::ENABLE_WAITS]) << card_map_pkg::BIT_STATUS_ENABLE_WAITS;

  always_ff @(posedge clk_i) begin
    if (sample_i) begin
      case (address[5:2])
        card_map_pkg::ADDR_STATUS[5:2]: begin
          data_o <= status_o;
          data_o[card_map_pkg::BIT_STATUS_REFUSED] <= refused[port];
        end
        card_map_pkg::ADDR_FAULT[5:2]: data_o <= fault;
        card_map_pkg::ADDR_REFUSAL[5:2]: data_o <= {4'd0, refusal[28*port+:28]};
        card_map_pkg::ADDR_GEOMETRY_ROOM[5:2]: data_o <= {16'd0, queue_state_pkg::geometry_room(queue_state_i)};
        card_map_pkg::ADDR_FEED_ROOM[5:2]: data_o <= {16'd0, queue_state_pkg::feed_room(queue_state_i)};
        card_map_pkg::ADDR_GEOMETRY_BEGUN[5:2]: data_o <= geometry_state_pkg::geometry_begun(geometry_state_i);
        card_map_pkg::ADDR_INPUTS[5:2]: data_o <= pins_state_pkg::inputs(pins_state_i);
        card_map_pkg::ADDR_OUTPUTS[5:2]: data_o <= {16'd0, pins_state_pkg::outputs(pins_state_i)};
        card_map_pkg::ADDR_MARKS[5:2]: data_o <= pins_state_pkg::marks(pins_state_i);
        card_map_pkg::ADDR_PLACE[5:2]: data_o <= {16'd0, time_state_pkg::place(time_state_i)};
        card_map_pkg::ADDR_FEED_BEGUN[5:2]: data_o <= time_state_pkg::feed_begun(time_state_i);
        default:
        if (Engines[card_map_pkg::ENGINE_STREAMING] && address[5:2] == card_map_pkg::ADDR_STALE_TICKS[5:2])
          data_o <= geometry_state_pkg::stale_ticks(geometry_state_i);
        else if (Engines[card_map_pkg::ENGINE_MACHINE_INPUTS] && address[5:2] == card_map_pkg::ADDR_LIMIT_STATE[5:2])
          data_o <= {4'd0, time_state_pkg::limit_state(time_state_i)};
        else if (Engines[card_map_pkg::ENGINE_MACHINE_INPUTS] && address[5:2] == card_map_pkg::ADDR_RAW_INPUTS[5:2])
          data_o <= input_levels_pkg::raw(inputs_i);
        else if (Engines[card_map_pkg::ENGINE_MACHINE_INPUTS] && address[5:2] == card_map_pkg::ADDR_ROLES[5:2])
          data_o <= 32'(roles_i);
        else data_o <= time_state_pkg::underruns(time_state_i);
      endcase
      // CAPTURE_STATE and CAPTURE_QUEUE lie next to the areas of the captures.
      if (Engines[card_map_pkg::ENGINE_CAPTURES] && address[11:6] == card_map_pkg::ADDR_CAPTURE_STATE[11:6]) begin
        data_o <= capture_state_i;
        if (Engines[card_map_pkg::ENGINE_CAPTURE_FIFO] && address[5:2] == card_map_pkg::ADDR_CAPTURE_QUEUE[5:2])
          data_o <= capture_queue_i;
      end
    end
  end

  logic [31:0] enable_q;

  always_ff @(posedge clk_i) begin
    irq_o <= ((status_o ^ (32'd1 << card_map_pkg::BIT_STATUS_BUSY)) & enable_q) != '0;
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_IRQ_ENABLE)) enable_q <= setting_bus_pkg::data(setting_i);
    if (rst_i) begin
      irq_o <= 1'b0;
      enable_q <= card_map_pkg::RESET_IRQ_ENABLE;
    end
  end

  logic [snapshot_pkg::WIDTH-1:0] behind_fault;

  snapshot_slice #(
      .Width(19)
  ) i_fault (
      .clk_i,
      .snapshot_i,
      .value_i(fault[18:0]),
      .snapshot_o(behind_fault)
  );

  snapshot_slice #(
      .Width(22)
  ) i_status (
      .clk_i,
      .value_i(status_o[21:0] & ~(22'd1 << card_map_pkg::BIT_STATUS_SNAPSHOT)),
      .snapshot_i(behind_fault),
      .snapshot_o
  );

endmodule
`default_nettype wire
