#!/usr/bin/env python3
"""Replaces plain flip-flops after an ECP5's block RAMs by the output registers of the RAMs.

Yosys leaves these registers of a DP16KD unused. A flip-flop with only the RAM's slow output before it is placed near
its readers; across the device, the wire to it takes a third of a clock.
"""
import json
import sys
from collections import defaultdict
from pathlib import Path


def is_bare(cell, clock):
    """Whether the cell is a flip-flop on this clock that is always enabled, is never set or reset, and starts at 0, as
    a RAM's output does."""
    if cell is None or cell["type"] != "TRELLIS_FF":
        return False
    parameters = {name: value.strip() for name, value in cell["parameters"].items()}
    return (cell["connections"]["CLK"] == clock and parameters["CLKMUX"] == "CLK" and parameters["CEMUX"] == "1"
            and cell["connections"].get("LSR", ["0"]) == ["0"] and parameters["REGSET"] == "RESET")


def registers_of(ram, cells, readers):
    """The flip-flop of each used output of a RAM; {} unless each output has one as its only reader."""
    ways = ram["port_directions"]
    outputs = {port: bits[0] for port, bits in ram["connections"].items() if ways[port] == "output" and readers[bits[0]]}
    clock = ram["connections"]["CLKB"]
    of = {port: readers[bit][0] for port, bit in outputs.items()
          if len(readers[bit]) == 1 and is_bare(cells.get(readers[bit][0]), clock)}
    plain = (ram["connections"]["CLKA"] == clock and ram["parameters"]["CLKBMUX"] == "CLKB"
             and ram["connections"]["RSTA"] == ram["connections"]["RSTB"] == ["0"]
             and ram["parameters"]["REGMODE_A"] == ram["parameters"]["REGMODE_B"] == "NOREG")
    return of if plain and len(of) == len(outputs) else {}


def take_output_registers(netlist, top):
    """Rewrites the netlist, a JSON file of Yosys; returns the number of flip-flops replaced."""
    design = json.loads(Path(netlist).read_text())
    module = design["modules"][top]
    cells = module["cells"]
    readers = defaultdict(list)  # by bit: names of the cells that read it, and of ports
    for name, cell in cells.items():
        for port, bits in cell["connections"].items():
            if cell["port_directions"][port] == "input":
                for bit in bits:
                    readers[bit].append(name)
    for name, port in module["ports"].items():
        for bit in port["bits"]:
            readers[bit].append(name)
    taken = 0
    for ram in [cell for cell in cells.values() if cell["type"] == "DP16KD"]:
        registers = registers_of(ram, cells, readers)
        for port, register in registers.items():
            ram["connections"][port] = cells.pop(register)["connections"]["Q"]
            side = port[2]  # DOA0 ..., DOB0 ...; a word of 36 bits uses both
            ram["parameters"][f"REGMODE_{side}"] = "OUTREG"
            ram["connections"][f"OCE{side}"] = ["1"]
        taken += len(registers)
    Path(netlist).write_text(json.dumps(design))
    return taken


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: output_registers.py NETLIST.json TOP   (rewrites the netlist of synth_ecp5)")
    print(f"{take_output_registers(*sys.argv[1:])} flip-flops taken")
