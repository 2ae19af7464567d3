"""Builds the locksteps with coverage counters, runs them, and reads the counts."""

import json
import os
import re
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Set

from records import identity

from . import points, report, waivers

ROOT = identity.ROOT
WAIVERS = Path("verif/coverage/waivers.toml")
LIMIT = 1800  # seconds of one process
# The longest lockstep runs in this many processes.
SHARDS = {"lockstep_card": 4}
# Locksteps of whole cards take most of the time of building and running, and the locksteps of blocks should reach every
# point: a point that only a whole card reaches lacks a lockstep of its block.
WHOLE_CARDS = re.compile(r"card|stops|card_engines_.*|card_pins|.*_uart")
# Left out: repetitions of the card's random run with more seeds.
FILTERS = {"lockstep_card": "-*_1:*_2:*_3:*_4:*_5:*Around/20"}
# Signals whose toggles do not count. A model is evaluated once per clock, so no counter sees the clock change. `unused`
# only tells the linter what a module does not read; nearly everywhere it is constant by its form, &{1'b0, ...}.
NOT_TOGGLED = re.compile(r"(clk_i|unused)(\[\d+\])*")
# Removed from the environment, so that each test has its usual length and seed.
UNSET = ("TRAMMEL_LONG", "TRAMMEL_SEED", "TRAMMEL_STATE_SEED", "TRAMMEL_MUTANT")


@dataclass(frozen=True)
class Lockstep:
    name: str
    sources: List[str]  # paths relative to rtl/, as CMake has them

    @property
    def program(self) -> str:
        return f"lockstep_{self.name}"


def folder(toggle: bool) -> Path:
    return ROOT / "build" / ("rtl-coverage-toggle" if toggle else "rtl-coverage")


def configure(toggle: bool):
    command = ["cmake", "--preset", "rtl-coverage", "-B", str(folder(toggle))]
    if toggle:
        command.append("-DTRAMMEL_RTL_COVERAGE=line;toggle")
    checked(command, ROOT / "build" / "configure-coverage.log", "configuring")


def checked(command: List[str], log: Path, what: str):
    """Exits when the command fails. The log receives the command's output."""
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("w") as file:
        status = subprocess.run(command, cwd=ROOT, stdout=file, stderr=subprocess.STDOUT).returncode
    if status:
        tail = "\n".join(log.read_text(errors="replace").splitlines()[-30:])
        sys.exit(f"{tail}\nerror: {what} failed: {log}")


def locksteps(build: Path, pattern: str) -> List[Lockstep]:
    """The build's locksteps whose names match the pattern."""
    entries = json.loads((build / "verif/judges.json").read_text())["locksteps"]
    found = [Lockstep(entry["name"], entry["sources"]) for entry in entries]
    return [each for each in found if re.search(pattern, each.name)]


def sample(build: Path) -> List[Lockstep]:
    return [each for each in locksteps(build, "") if not WHOLE_CARDS.fullmatch(each.name)]


def build(where: Path, chosen: List[Lockstep], jobs: int):
    say(f"building {len(chosen)} locksteps in {where.relative_to(ROOT)}: 1 to 2 hours of processor time where nothing is built")
    command = ["cmake", "--build", str(where), "-j", str(jobs), "--target", *(each.program for each in chosen)]
    if subprocess.run(command, cwd=ROOT, stdout=sys.stderr).returncode:
        sys.exit("error: building failed")


def say(text: str):
    print(f"== {text}", file=sys.stderr, flush=True)


def environment(**more: str) -> Dict[str, str]:
    return {name: value for name, value in os.environ.items() if name not in UNSET} | more


class Runs:
    """Runs locksteps, some at a time; each process leaves its .dat and its log."""

    def __init__(self, where: Path, out: Path):
        self.where, self.out, self.total, self.ended = where, out, 0, 0
        self.failed: Set[str] = set()
        self.seconds: Dict[str, float] = {}
        for kind in ("dat", "logs"):
            (out / kind).mkdir(parents=True, exist_ok=True)

    def all(self, chosen: List[Lockstep], jobs: int):
        for lockstep in chosen:
            for old in self.files(lockstep):
                old.unlink()
        runs = [(lockstep, shard) for lockstep in chosen for shard in range(SHARDS.get(lockstep.program, 1))]
        # Whole cards first: if they came last, the longest would run alone at the end.
        runs.sort(key=lambda run: -len(run[0].sources))
        self.total = len(runs)
        with ThreadPoolExecutor(jobs) as pool:
            list(pool.map(lambda run: self.run(*run), runs))

    def run(self, lockstep: Lockstep, shard: int):
        command = [str(self.where / "bin" / lockstep.program)]
        if lockstep.program in FILTERS:
            command.append(f"--gtest_filter={FILTERS[lockstep.program]}")
        name = lockstep.name + (f"-{shard + 1}" if lockstep.program in SHARDS else "")
        variables = environment(TRAMMEL_RTL_COVERAGE=str(self.out / "dat"), GTEST_SHARD_INDEX=str(shard),
                                GTEST_TOTAL_SHARDS=str(SHARDS.get(lockstep.program, 1)))
        begun = time.monotonic()
        with (self.out / "logs" / f"{name}.log").open("w") as log:
            try:
                status = subprocess.run(command, cwd=self.out, env=variables, stdout=log, stderr=subprocess.STDOUT,
                                        timeout=LIMIT).returncode
            except subprocess.TimeoutExpired:
                status = 124
            except OSError as error:  # with --no-build the program may be missing
                log.write(f"{error}\n")
                status = 127
        self.ended += 1
        seconds = round(time.monotonic() - begun, 1)
        self.seconds[name] = seconds
        if status:
            self.failed.add(lockstep.name)
        verdict = f" FAILED, exit status {status}: {self.out}/logs/{name}.log" if status else ""
        print(f"{self.ended} of {self.total}: {name} {seconds} s{verdict}", file=sys.stderr, flush=True)

    def files(self, lockstep: Lockstep) -> List[Path]:
        return sorted((self.out / "dat").glob(f"{lockstep.program}.*.dat"))


def modules_of(chosen: List[Lockstep]) -> Dict[str, str]:
    """The file of each module in the locksteps' sources, by its name."""
    # An absolute path is a source of the tests, which may have the name of a module that it stands for.
    files = {os.path.normpath(os.path.join("rtl", source)) for each in chosen for source in each.sources}
    return {Path(file).stem: file for file in files if is_judged(file)}


def is_judged(file: str) -> bool:
    """Whether a file's points count. Simulation models of primitives and of the card belong to the tests; Verilator
    5.006 loses most counts of functions in packages."""
    return file.startswith(("rtl/", "boards/")) and not file.startswith("boards/sim/") and not file.endswith("_pkg.sv")


def counts_as(point: points.Point) -> bool:
    return is_judged(point.file) and not (point.kind == "toggle" and NOT_TOGGLED.fullmatch(point.what))


def not_clocked(modules: Dict[str, str]) -> List[str]:
    """Modules of the project that no chosen lockstep has clocked."""
    known = json.loads((ROOT / "verif/evidence/modules.json").read_text())
    return [f"module {row['module']}: no lockstep that was run has it" for row in known
            if os.path.normpath(f"rtl/{row['file']}") not in modules.values()]


def evaluate(runs: Runs, chosen: List[Lockstep], whole: bool) -> dict:
    """Reads the .dat files and writes coverage.json, missing.txt and lcov.info into the folder of results. With a part
    of the locksteps, the waivers are applied but not judged."""
    files = [file for each in chosen for file in runs.files(each)]
    for lockstep in chosen:
        if lockstep.name not in runs.failed and not runs.files(lockstep):
            print(f"{lockstep.name} has counted nothing", file=sys.stderr)
            runs.failed.add(lockstep.name)
    if not files:
        sys.exit(f"error: no .dat files in {runs.out}/dat: run without --no-run")
    counts = {point: count for point, count in points.read(files, ROOT).items() if counts_as(point)}
    waived, wrong = waivers.apply(waivers.read(ROOT / WAIVERS), counts, ROOT)
    modules = modules_of(chosen)
    found = report.result(counts, waived, modules, wrong + not_clocked(modules) if whole else [])
    found |= {"whole": whole, "locksteps": len(chosen), "failed": sorted(runs.failed), "seconds": runs.seconds,
              "verilator": identity.version("verilator")}
    (runs.out / "coverage.json").write_text(json.dumps(found, indent=1) + "\n")
    checked(["verilator_coverage", "--write-info", str(runs.out / "lcov.info"), *map(str, files)], runs.out / "lcov.log",
            "verilator_coverage")
    return found


def show(found: dict, out: Path) -> int:
    names = {point["file"] for point in found["missing"]}
    print(report.text(found, {name: (ROOT / name).read_text().splitlines() for name in names if (ROOT / name).exists()}))
    print(*report.count_lines(found), sep="\n")
    for name in found["failed"]:
        print(f"error: lockstep {name} failed: {out}/logs")
    if not found["whole"]:
        print("a part of the locksteps: the points that are missing are listed, and not judged")
        return 1 if found["failed"] else 0
    return 0 if report.passed(found) and not found["failed"] else 1


def run(arguments) -> int:
    where, out = folder(arguments.toggle), arguments.out / ("rtl-toggle" if arguments.toggle else "rtl")
    if not arguments.no_build and not arguments.no_run:
        configure(arguments.toggle)
    if not (where / "verif/judges.json").exists():
        sys.exit(f"error: {where} is not configured: run without --no-build")
    everything = locksteps(where, arguments.only)
    chosen = everything if arguments.only or arguments.cards else sample(where)
    if not chosen:
        sys.exit(f"error: no lockstep has a name with {arguments.only}")
    runs = Runs(where, out.resolve())
    if not arguments.no_run:
        if not arguments.no_build:
            build(where, chosen, arguments.jobs)
        if arguments.build_only:
            return 0
        say(f"running {len(chosen)} locksteps, {arguments.jobs} at a time")
        runs.all(chosen, arguments.jobs)
    if left_out := [each.name for each in everything if each not in chosen]:
        say(f"left out: whole cards (--cards): {' '.join(left_out)}")
    return show(evaluate(runs, chosen, all(each in chosen for each in sample(where))), out)
