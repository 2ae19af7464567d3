"""Runs the targets of rtl/trammel.core and boards/trammel-boards.core with FuseSoC; its files are below build/.

The targets that place a board are only set up: scripts/boards builds bitstreams."""
import re
import subprocess
from pathlib import Path

from file_list import CORE, ROOT

FUSESOC = ROOT / ".venv" / "bin" / "fusesoc"
BOARDS = ROOT / "boards" / "trammel-boards.core"
# Core: its targets that run, each with the tool that it must call, the options for the stages, and parameters.
RUNS = {
    CORE: [("lint", "verilator", [], []), ("icarus", "iverilog", ["--build"], []),
           ("ports", "verilator", [], ["--AxiLite", "0", "--Wishbone", "2", "--Uart", "1", "--Spi", "1", "--PathCommands", "1"])],
    BOARDS: [(f"lint-{board}", "verilator", [], []) for board in ("hx8k", "ulx3s", "colorlight-5a-75b")],
}
# Targets of the boards that are only set up, and the placer of each.
SETS_UP = {"hx8k": "nextpnr-ice40", "ulx3s": "nextpnr-ecp5", "colorlight-5a-75b": "nextpnr-ecp5"}


def fusesoc(name, target, how, parameters):
    """FuseSoC's output, and whether it succeeded."""
    command = [FUSESOC, "--cores-root", "rtl", "--cores-root", "boards", "run", "--clean", "--build-root", "build/fusesoc", "--target",
               target, *how, name, *parameters]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    return done.stdout + done.stderr, done.returncode == 0


def run(name, target, tool, how, parameters):
    """The complaint about one target; empty on success."""
    said, good = fusesoc(name, target, how, parameters)
    if not good or not re.search(rf"^{tool} ", said, re.M):
        return f"FuseSoC's target {target} of {name} fails:\n{said}"
    return ""


def set_up(name, target, placer):
    """The same for a target that is only set up."""
    said, good = fusesoc(name, target, ["--setup"], [])
    makefile = ROOT / "build" / "fusesoc" / name.replace(":", "_") / target / "Makefile"
    if not good or not makefile.exists() or f" {placer} " not in Path(makefile).read_text():
        return f"FuseSoC's target {target} of {name} is not set up for {placer}:\n{said}"
    return ""


def name_and_version(core):
    return re.search(r"^name: (\S+:(\S+))$", core.read_text(), re.M).groups()


def complaints():
    if not FUSESOC.exists():
        return ["fusesoc is not installed; run scripts/setup"]
    project = re.search(r"^project\(trammel VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.M).group(1)
    wrong = []
    for core, targets in RUNS.items():
        name, version = name_and_version(core)
        if version != project:
            wrong.append(f"{core.relative_to(ROOT)} has version {version}, the project {project}")
        wrong += [run(name, *target) for target in targets]
    wrong += [set_up(name_and_version(BOARDS)[0], *target) for target in SETS_UP.items()]
    return [complaint for complaint in wrong if complaint]
