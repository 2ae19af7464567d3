#!/usr/bin/env python3
"""A SoC without a CPU for the Colorlight 5A-75B 7.0: LiteX's UART bridge, on the pins of button and LED, is the master,
and the card is the slave.

Writes sources and scripts for Yosys and nextpnr into a folder, but runs none of them. With --simulated the clock comes
from a pin instead of a PLL, for a simulator that reads the generated Verilog."""
import argparse

from litex.build.generic_platform import IOStandard, Pins, Subsignal
from litex.build.lattice import LatticeECP5Platform
from litex.gen import LiteXModule
from litex.soc.cores.clock import ECP5PLL
from litex.soc.integration.builder import Builder
from litex.soc.integration.soc import SoCRegion
from litex.soc.integration.soc_core import SoCMini
from litex_boards.platforms import colorlight_5a_75b
from migen import ClockDomain, Signal

from trammel_litex import TrammelCard

CARD_AT = 0x3000_0000
CLOCK_HZ = 80_000_000
BAUD = 115_200
SIMULATED_BAUD = CLOCK_HZ // 16  # quick to simulate
# STEP and DIR on the pins that docs/user/boards.md lists, as connector:pin.
MOTORS = [("motors", 0, Subsignal("step", Pins("j1:0 j1:2 j1:5 j2:0")), Subsignal("dir", Pins("j1:1 j1:4 j1:6 j2:1")),
           IOStandard("LVCMOS33"))]
# Arbitrary pins, because this SoC is not placed.
SIMULATED = [("clk", 0, Pins("A2")), ("rst", 0, Pins("A3")), ("serial", 0, Subsignal("tx", Pins("A4")), Subsignal("rx", Pins("A5"))),
             ("motors", 0, Subsignal("step", Pins("B1 B2 B3 B4")), Subsignal("dir", Pins("C1 C2 C3 C4")))]


class Clock(LiteXModule):
    def __init__(self, platform):
        self.rst = Signal()
        self.cd_sys = ClockDomain()
        self.pll = pll = ECP5PLL()
        self.comb += pll.reset.eq(self.rst)
        pll.register_clkin(platform.request("clk25"), 25e6)
        pll.create_clkout(self.cd_sys, CLOCK_HZ)


class SimulatedClock(LiteXModule):
    def __init__(self, platform):
        self.rst = Signal()
        self.cd_sys = ClockDomain()
        self.comb += [self.cd_sys.clk.eq(platform.request("clk")), self.cd_sys.rst.eq(platform.request("rst") | self.rst)]


class TrammelSoC(SoCMini):
    def __init__(self, platform, clock, baud, **parameters):
        SoCMini.__init__(self, platform, CLOCK_HZ, ident="Trammel", ident_version=False)
        self.crg = clock(platform)
        self.add_uartbone(baudrate=baud)
        self.card = TrammelCard(platform, CLOCK_HZ, **parameters)
        self.bus.add_slave("card", self.card.bus, SoCRegion(origin=CARD_AT, size=0x1000, cached=False))
        pads = platform.request("motors")
        self.comb += [pads.step.eq(self.card.step), pads.dir.eq(self.card.dir)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="where the files go")
    parser.add_argument("--simulated", action="store_true")
    arguments = parser.parse_args()
    if arguments.simulated:
        platform = LatticeECP5Platform("LFE5U-25F-6BG256C", SIMULATED, toolchain="trellis")
        soc = TrammelSoC(platform, SimulatedClock, SIMULATED_BAUD)
    else:
        platform = colorlight_5a_75b.Platform(revision="7.0", toolchain="trellis")
        platform.add_extension(MOTORS)
        soc = TrammelSoC(platform, Clock, BAUD, ArcGenerator=1, PathCommands=1)
    Builder(soc, output_dir=arguments.folder, compile_software=False, compile_gateware=False).build(
        build_name="trammel_soc", run=False)


if __name__ == "__main__":
    main()
