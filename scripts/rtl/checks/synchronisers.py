"""Lists every input pin of a card with all its ports. Fails when an asynchronous input has no synchroniser: two
consecutive flip-flops, both marked async_reg, with no other load on the pin or between them.

SYNCHRONOUS and STRAPS name the inputs of the card's clock and the constant ones; every other pin needs a
synchroniser."""
import json
import subprocess
import tempfile
from pathlib import Path

from file_list import ROOT, sources

TOP = "card_with_ports"
PARAMETERS = "AxiLite=1 Wishbone=1 Uart=1 Spi=1 PathCommands=1 EmergencyStop=1 Axes=1"
# Clock, reset, and buses of the card's clock; straps.
SYNCHRONOUS = {"clk_i", "rst_i", "awvalid_i", "awaddr_i", "wvalid_i", "wdata_i", "wstrb_i", "bready_i", "arvalid_i", "araddr_i",
               "rready_i", "wishbone_i"}
STRAPS = {"clock_hz_i", "idle_level_i", "output_idle_i", "emergency_stop_level_i"}
# Inputs that also set a latch without a clock, in addition to their synchroniser.
LATCHES = {"emergency_stop_i"}
FLIP_FLOPS = ("$dff", "$sdff")
# A seeded bug that the check must find: logic between the two flip-flops.
SEED = ("rtl/host/uart/uart_port.sv", "rx_second_q <= rx_first_q;", "rx_second_q <= rx_first_q & rx_i;")


def netlist(files, folder):
    """The flattened card as Yosys writes it."""
    out = Path(folder) / "card.json"
    parameters = " ".join("-chparam " + p.replace("=", " ") for p in PARAMETERS.split())
    script = (f"read_verilog -sv {' '.join(files)}; hierarchy -check -top {TOP} {parameters}; proc; flatten; opt_expr; opt_clean; "
              f"opt_dff; opt_clean; write_json {out}")
    subprocess.run(["yosys", "-q", "-p", script], check=True)
    modules = json.loads(out.read_text())["modules"]
    return next(m for name, m in modules.items() if TOP in name)


class Card:
    def __init__(self, module):
        self.inputs = {name: port["bits"] for name, port in module["ports"].items() if port["direction"] == "input"}
        self.marked = {bit for net in module["netnames"].values() if "async_reg" in net["attributes"] for bit in net["bits"]}
        self.readers = {}
        for cell in module["cells"].values():
            for port, bits in cell["connections"].items():
                if cell["port_directions"][port] == "input":
                    for place, bit in enumerate(bits):
                        self.readers.setdefault(bit, []).append((cell, port, place))

    def flip_flop(self, bit, latches=False):
        """Output of the only flip-flop that reads the bit, if it is marked; otherwise None. With `latches`, gates may
        read the bit, too."""
        readers = self.readers.get(bit, [])
        if latches:
            readers = [reader for reader in readers if reader[0]["type"] in FLIP_FLOPS]
        if len(readers) != 1:
            return None
        cell, port, place = readers[0]
        if cell["type"] not in FLIP_FLOPS or port != "D":
            return None
        shown = cell["connections"]["Q"][place]
        return shown if shown in self.marked else None

    def synchronised(self, bit, latches=False):
        first = self.flip_flop(bit, latches)
        return first is not None and self.flip_flop(first) is not None


def without_synchroniser(seed=None):
    """The pins without a synchroniser. `seed`, a file and two texts, replaces the first text in that file by the
    second."""
    files = sources()
    with tempfile.TemporaryDirectory() as folder:
        if seed:
            name, old, new = seed
            text = (ROOT / name).read_text()
            if text.count(old) != 1:
                raise ValueError(f"{old!r} must stand exactly once in {name}")
            copy = Path(folder) / Path(name).name
            copy.write_text(text.replace(old, new))
            files = [str(copy) if file == name else file for file in files]
        card = Card(netlist(files, folder))
    asynchronous = {name: bits for name, bits in card.inputs.items() if name not in SYNCHRONOUS | STRAPS}
    return [f"{name}[{place}]" for name, bits in sorted(asynchronous.items()) for place, bit in enumerate(bits)
            if not card.synchronised(bit, name in LATCHES)]


def complaints():
    wrong = [f"{pin} has no synchroniser" for pin in without_synchroniser()]
    if not without_synchroniser(SEED):
        wrong.append(f"a pin whose synchroniser is broken is not found: {SEED}")
    return wrong
