"""The four readers of SystemVerilog that the card must pass: Verilator, Icarus, Yosys and slang."""
import subprocess

from file_list import ROOT, sources


def commands(top, own=(), parameters=(), warnings=True, waivers=(), last=""):
    """The command of each reader for a module of the card, or for one in the files `own` beside the card's.

    parameters: NAME=VALUE of that module. Without `warnings`, a linter's warnings do not stop it before it reports
    impossible parameters. `last` has commands that Yosys runs at the end."""
    every = [*sources(), *own]
    lint = ["-Wall", "rtl/lint/waivers.vlt", *waivers] if warnings else ["-Wno-lint", "-Wno-fatal"]
    set_parameters = "".join("chparam -set {} {} ".format(*p.split("=")) + f"{top}; " for p in parameters)
    yosys = f"read_verilog -sv {' '.join(every)}; {set_parameters}hierarchy -check -top {top}{last}"
    return {
        "Verilator": ["verilator", "--lint-only", *lint, "--top-module", top, *(f"-G{p}" for p in parameters), *every],
        "Icarus": ["iverilog", "-g2012", "-tnull", "-s", top, *(f"-P{top}.{p}" for p in parameters), *every],
        "Yosys": ["yosys", "-q", "-p", yosys],
        "slang": ["scripts/rtl/slang", "--top", top, *(f"-G{p}" for p in parameters), *own],
    }


def run(command):
    """The output of a reader, and whether it succeeded."""
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    return done.stdout + done.stderr, done.returncode == 0
