// The watchdog over the host. A write to WATCHDOG restarts its time. If the time passes without another write,
// expired_o rises and stays high until the next write. A time of 0 never passes.
`default_nettype none

module watchdog #(
    parameter int UnitBits = 16  // WATCHDOG is in units of 2^UnitBits clocks; the map says 16, proofs take fewer
) (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [setting_bus_pkg::WIDTH-1:0] setting_i,
    output logic running_o,
    output logic expired_o
);
  logic [15+UnitBits:0] left_q;  // clocks left; the upper 16 bits are units
  logic [31:0] data;
  logic [15+UnitBits:0] next;
  logic none_left;

  assign data = setting_bus_pkg::data(setting_i);
  // One subtraction: its borrow is the comparison with 0.
  assign {none_left, next} = {1'b0, left_q} - 1'b1;

  always_ff @(posedge clk_i) begin
    left_q <= next;
    if (running_o && none_left) begin
      running_o <= 1'b0;
      expired_o <= 1'b1;
    end
    if (setting_bus_pkg::writes(setting_i, card_map_pkg::ADDR_WATCHDOG)) begin
      left_q <= {data[15:0], {UnitBits{1'b0}}};
      running_o <= data[15:0] != 16'd0;
      expired_o <= 1'b0;
    end
    if (rst_i) begin
      running_o <= card_map_pkg::RESET_WATCHDOG[15:0] != 16'd0;
      expired_o <= 1'b0;
    end
  end

  logic unused;
  assign unused = &{1'b0, data[31:16]};
endmodule

`default_nettype wire
