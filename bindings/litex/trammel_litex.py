"""Trammel's card as a peripheral of a LiteX SoC: a Wishbone slave of 4 KiB, whose registers docs/reference/registers.md lists.

    self.card = TrammelCard(platform, clock_hz=sys_clk_freq, ArcGenerator=1)
    self.bus.add_slave("card", self.card.bus, SoCRegion(origin=0x3000_0000, size=0x1000, cached=False))
    self.comb += pads.step.eq(self.card.step)

A write that the card refuses ends with ERR; REFUSAL then says why.
"""
from pathlib import Path

from litex.gen import LiteXModule
from litex.soc.interconnect import wishbone
from migen import C, Cat, ClockSignal, Instance, ResetSignal, Signal

RTL = Path(__file__).resolve().parents[2] / "rtl"


def add_sources(platform):
    """The card's sources, packages first, as rtl/trammel.f lists them."""
    for line in (RTL / "trammel.f").read_text().splitlines():
        if line and not line.startswith("//"):
            platform.add_source(str(RTL / line), "systemverilog")


class TrammelCard(LiteXModule):
    """`parameters`: any of docs/reference/integration.md except axes, inputs and outputs. `*_idle`: levels during
    reset, one bit per pin."""

    def __init__(self, platform, clock_hz, axes=4, inputs=4, outputs=4, step_idle=0, dir_idle=0, output_idle=0, emergency_stop_level=1,
                 **parameters):
        self.bus = wishbone.Interface(data_width=32, address_width=32, addressing="word")
        self.step = Signal(axes)
        self.dir = Signal(axes)
        self.inputs = Signal(inputs)
        self.outputs = Signal(outputs)
        self.emergency_stop = Signal(reset=1 - emergency_stop_level)
        self.irq = Signal()

        # # #

        add_sources(platform)
        bus = self.bus
        address = Cat(C(0, 2), bus.adr[:10])
        stall = Signal()  # only a pipelined bus uses it
        self.specials += Instance(
            "card_with_ports",
            p_Axes=axes, p_Inputs=inputs, p_Outputs=outputs, p_AxiLite=0, p_Wishbone=1,
            **{f"p_{name}": value for name, value in parameters.items()},
            i_clk_i=ClockSignal("sys"), i_rst_i=ResetSignal("sys"),
            i_clock_hz_i=C(int(clock_hz), 32),
            i_idle_level_i=C(dir_idle << axes | step_idle, 2 * axes), i_output_idle_i=C(output_idle, outputs),
            i_emergency_stop_level_i=C(emergency_stop_level, 1), i_emergency_stop_i=self.emergency_stop,
            i_wishbone_i=Cat(bus.dat_w, address, bus.sel, bus.we, bus.stb, bus.cyc),
            o_wishbone_o=Cat(bus.dat_r, stall, bus.err, bus.ack),
            i_input_i=self.inputs, o_output_o=self.outputs, o_step_o=self.step, o_dir_o=self.dir, o_irq_o=self.irq,
            # Ports that this card is built without.
            i_awvalid_i=0, i_awaddr_i=C(0, 12), i_wvalid_i=0, i_wdata_i=C(0, 32), i_wstrb_i=C(0, 4), i_bready_i=0,
            i_arvalid_i=0, i_araddr_i=C(0, 12), i_rready_i=0, i_rx_i=1,
            i_sck_i=0, i_cs_n_i=1, i_mosi_i=0,
        )
