"""The tools of synthesis, place and route, and the RTL files that they read."""
import json
import re
import subprocess
import sys
from pathlib import Path

from rtl.file_list import ROOT, RTL, listed

BUILD = ROOT / "build" / "synthesis"


def run(command, log, seconds=None):
    """Runs a tool for at most `seconds`, with its output in a file, which errors name."""
    with open(log, "w") as out:
        try:
            code = subprocess.run(command, stdout=out, stderr=subprocess.STDOUT, cwd=ROOT, timeout=seconds).returncode
        except subprocess.TimeoutExpired:
            sys.exit(f"error: {command[0]} had not ended after {seconds} s, see {log.relative_to(ROOT)}")
    text = Path(log).read_text()
    if code:
        tail = "\n".join(text.splitlines()[-15:])
        sys.exit(f"error: {command[0]} failed, exit status {code}, see {log.relative_to(ROOT)}:\n{tail}")
    return text


def last_fmax(text):
    found = re.findall(r"Max frequency for clock[^:]*: ([0-9.]+) MHz", text)
    if not found:
        sys.exit("error: the place-and-route log names no clock frequency")
    return float(found[-1])


def used_cells(text, kind):
    return int(re.findall(rf"{kind}:\s*([0-9]+)\s*/", text)[-1])


def venv_tool(name):
    tool = ROOT / ".venv" / "bin" / name
    if not tool.exists():
        sys.exit(f"error: {name} is not installed; run scripts/setup")
    return str(tool)


def version(command):
    """Name, version and revision of a tool. The rest of its version text depends on where it was built."""
    done = subprocess.run([command, "--version" if "nextpnr" in command else "-V"], capture_output=True, text=True)
    said = done.stdout + done.stderr
    yosys = re.search(r"(Yosys \S+).*?\bgit sha1 ([0-9a-f]+)", said)
    if yosys:
        return f"{yosys.group(1)} (git sha1 {yosys.group(2)})"
    nextpnr = re.search(r"(nextpnr-\w+)\b.*\(Version (?:nextpnr-)?([^)\s]+)\)", said)
    if nextpnr:
        return f"{nextpnr.group(1)} {nextpnr.group(2)}"
    sys.exit(f"error: {command} does not say which version it is: {said}")


def sources(block):
    """The files of a block and of its parts. More files would change the names that the tools choose, and so the
    result."""
    packages = [p for p in listed() if p.endswith("_pkg.sv")]
    path = {Path(p).stem: p for p in listed() if p not in packages}
    if block not in path:
        sys.exit(f"error: rtl/trammel.f has no module {block}")
    text = {m: re.sub(r"//.*", "", (RTL / p).read_text()) for m, p in path.items()}
    used, todo = set(), [block]
    while todo:
        module = todo.pop()
        used.add(module)
        todo += [m for m in text if m not in used and re.search(rf"^ *{m} +(#\(|\w+ \()", text[module], re.M)]
    return [f"rtl/{p}" for p in packages + [path[m] for m in sorted(used)]]


def read_block(block, parameters):
    """Yosys commands that read a block and make it the top, with these parameters."""
    chparam = "".join(f" -chparam {name} {value}" for name, value in parameters.items())
    return f"read_verilog -sv {' '.join(sources(block))}; hierarchy -check -top {block}{chparam}"


def ports(block, parameters, log):
    """Names, directions and widths of a block's ports, as Yosys elaborates them."""
    out = log.with_suffix(".json")
    run(["yosys", "-q", "-p", f"{read_block(block, parameters)}; proc; write_json {out.relative_to(ROOT)}"], log)
    modules = json.loads(out.read_text())["modules"]
    top = next(m for m in modules.values() if m["attributes"].get("top"))
    return [(n, p["direction"], len(p["bits"])) for n, p in top["ports"].items()]


def ice40(top, least_set=1, options=""):
    """Synthesis for the iCE40; enables and resets of fewer flip-flops than `least_set` become logic."""
    synth = f"synth_ice40 -abc9 -device hx {options}-top {top}"
    return (f"{synth} -run begin:map_ffs; "
            "dfflegalize -cell $_DFF_?_ 0 -cell $_DFFE_?P_ 0 -cell $_DFF_?P?_ 0 -cell $_DFFE_?P?P_ 0 -cell $_SDFF_?P?_ 0 "
            f"-cell $_SDFFCE_?P?P_ 0 -cell $_DLATCH_?_ x -mince {least_set} -minsrst {least_set}; "
            "techmap -map +/ice40/ff_map.v; opt_expr -mux_undef; simplemap; ice40_opt -full; "
            f"{synth} -run map_luts:")
