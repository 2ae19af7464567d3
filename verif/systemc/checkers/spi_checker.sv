// Rules of the card's SPI at the pins, sampled with the card's clock: SCK at most a quarter of it, MISO on time.
`default_nettype none
module spi_checker (
    input wire logic clk_i,
    input wire logic rst_i,
    input wire logic [2:0] master_i,  // {MOSI, CS, SCK}
    input wire logic [1:0] card_i  // {MISO's enable, MISO}
);
  import "DPI-C" function void port_rule_broken(input string rule);

  logic mosi, cs_n, sck, enable, miso;
  assign {mosi, cs_n, sck} = master_i;
  assign {enable, miso} = card_i;

  // Clocks since SCK rose and since CS changed, up to 7; bits of the byte.
  logic [2:0] rose_q, turned_q, bit_q;
  logic sck_q, cs_q, miso_q;
  logic rise, turn, late;
  assign rise = sck && !sck_q && !cs_n;
  assign turn = cs_n != cs_q;
  assign late = rose_q > 3'd3 && turned_q > 3'd3;

  always_ff @(posedge clk_i) begin
    sck_q <= sck;
    cs_q <= cs_n;
    miso_q <= miso;
    rose_q <= rise ? 3'd1 : rose_q + {2'd0, rose_q != 3'd7};
    turned_q <= turn ? 3'd1 : turned_q + {2'd0, turned_q != 3'd7};
    bit_q <= cs_n ? 3'd0 : bit_q + {2'd0, rise};
    if (rst_i) begin
      rose_q   <= 3'd7;
      turned_q <= 3'd7;
      bit_q    <= 3'd0;
    end
  end

  // The master
  assert property (@(posedge clk_i) disable iff (rst_i) rise |-> rose_q >= 3'd4)
  else port_rule_broken("SPI: SCK is faster than a quarter of the clock");
  assert property (@(posedge clk_i) disable iff (rst_i) rise |-> $stable(mosi))
  else port_rule_broken("SPI: MOSI changes with SCK's rising edge");
  assert property (@(posedge clk_i) disable iff (rst_i) rise |-> turned_q >= 3'd4)
  else port_rule_broken("SPI: SCK rises less than 4 clocks after CS has fallen");
  assert property (@(posedge clk_i) disable iff (rst_i) turn |-> turned_q >= 3'd4)
  else port_rule_broken("SPI: CS turns again within 4 clocks");
  assert property (@(posedge clk_i) disable iff (rst_i) turn && cs_n |-> bit_q == 3'd0)
  else port_rule_broken("SPI: CS rises within a byte");

  // The card
  assert property (@(posedge clk_i) disable iff (rst_i) late && enable && !cs_n |-> miso == miso_q)
  else port_rule_broken("SPI: MISO changes more than 3 clocks after SCK's rising edge");
  assert property (@(posedge clk_i) disable iff (rst_i) turned_q >= 3'd4 && !turn |-> enable == !cs_n)
  else port_rule_broken("SPI: MISO's enable does not follow CS");
endmodule
`default_nettype wire
