"""Coverage of the C++ libraries by their unit tests: driver, planner, G-code reader, golden model."""

import json
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Dict, List, Tuple

from records import identity

from . import gcov
from .rtl import ROOT, checked, environment, say

BUILD = ROOT / "build" / "coverage"
# Folder of the sources, folder of the library's objects in the build.
LIBRARIES = {
    "driver": ("driver", "driver/CMakeFiles/trammel_driver.dir"),
    "planner": ("host/planner", "host/CMakeFiles/trammel_planner.dir"),
    "reader": ("host/gcode", "host/CMakeFiles/trammel_gcode.dir"),
    "model": ("cpp-model/card", "cpp-model/card/CMakeFiles/trammel_model.dir"),
}
TESTS = ("driver", "planner", "gcode", "model")
# Long runs look for rare events; they cover no line that shorter tests miss.
FILTERS = {"model": "-Underrun.*:Soak.*:Run.EqualsClock*"}
LEAST = 0.95  # least share of lines, and of branches, that must be covered
LIMIT = 1800  # seconds of one test program
SHOWN = 60  # most functions that are printed; missing.txt has all


def build(jobs: int):
    checked(["cmake", "--preset", "coverage"], ROOT / "build" / "configure-coverage.log", "configuring")
    say("building the tests of driver, planner, reader and model in build/coverage")
    command = ["cmake", "--build", str(BUILD), "-j", str(jobs), "--target", *(f"test_{name}" for name in TESTS)]
    if subprocess.run(command, cwd=ROOT, stdout=sys.stderr).returncode:
        sys.exit("error: building failed")


def run_tests(out: Path, jobs: int) -> List[str]:
    """Runs the test programs with counts reset; returns the names of those that failed."""
    for old in BUILD.rglob("*.gcda"):
        old.unlink()
    say(f"running {len(TESTS)} test programs, {jobs} at a time")

    def run(name: str) -> Tuple[str, int]:
        begun = time.monotonic()
        command = [str(BUILD / "bin" / f"test_{name}"), *([f"--gtest_filter={FILTERS[name]}"] if name in FILTERS else [])]
        with (out / f"{name}.log").open("w") as log:
            try:
                status = subprocess.run(command, cwd=BUILD, env=environment(), stdout=log,
                                        stderr=subprocess.STDOUT, timeout=LIMIT).returncode
            except subprocess.TimeoutExpired:
                status = 124
        verdict = f" FAILED, exit status {status}: {out}/{name}.log" if status else ""
        print(f"test_{name} {time.monotonic() - begun:.0f} s{verdict}", file=sys.stderr, flush=True)
        return name, status

    with ThreadPoolExecutor(jobs) as pool:
        return [name for name, status in pool.map(run, TESTS) if status]


def objects() -> List[Path]:
    """Object files of the libraries, and of the tests, which instantiate the code of headers."""
    folders = [folder for _, folder in LIBRARIES.values()] + ["tests"]
    return sorted(path for folder in folders for path in (BUILD / folder).rglob("*.gcno") if is_ours(path))


def is_ours(path: Path) -> bool:
    return "tests" not in path.parts or any(f"test_{name}.dir" in path.parts for name in TESTS)


def library_figures(files: gcov.Files, folder: str) -> dict:
    """Lines and branches; a line that two functions share counts in each."""
    functions = [function for name, found in files.items() if name.startswith(f"{folder}/") for function in found.values()]
    lines = [count for function in functions for count in function.lines.values()]
    branches = [count for function in functions for count in function.branches.values()]
    return {"lines": len(lines), "lines_covered": sum(map(bool, lines)), "branches": len(branches),
            "branches_covered": sum(map(bool, branches))}


def missing(files: gcov.Files, folder: str) -> List[dict]:
    """Functions with a line or branch that no test reaches, most of them first."""
    found = []
    for name, functions in files.items():
        if not name.startswith(f"{folder}/"):
            continue
        for (line, _), function in functions.items():
            lines = sorted(number for number, count in function.lines.items() if not count)
            branches = sorted({number for (number, _), count in function.branches.items() if not count})
            if lines or branches:
                missed = sum(not count for count in function.branches.values())
                found.append({"file": name, "line": line, "function": function.name, "lines": lines, "branch_lines": branches,
                              "branches": missed})
    return sorted(found, key=lambda each: (-len(each["lines"]) - each["branches"], each["file"], each["line"]))


def rate(covered: int, all_of_them: int) -> float:
    return covered / all_of_them if all_of_them else 0.0


def below(figures: Dict[str, dict]) -> List[str]:
    return [f"{name}: {what} {rate(row[f'{what}_covered'], row[what]):.1%}, less than {LEAST:.0%}"
            for name, row in figures.items() for what in ("lines", "branches")
            if rate(row[f"{what}_covered"], row[what]) < LEAST]


def line_of(entry: dict) -> str:
    numbers = ",".join(map(str, entry["lines"])) or "-"
    branches = ",".join(map(str, entry["branch_lines"])) or "-"
    return f"{entry['file']}:{entry['line']}: {entry['function']}: lines {numbers}; {entry['branches']} branches of lines {branches}"


def count_lines(figures: Dict[str, dict]) -> List[str]:
    """For the record of the run: scripts/records/counts.py reads these."""
    return [f"{sum(row[name] for row in figures.values())} C++ {name.replace('_', ' ')}"
            for name in ("lines", "lines_covered", "branches", "branches_covered")]


def show(found: dict, out: Path) -> int:
    for name, row in found["libraries"].items():
        print(f"{name:8} lines {row['lines_covered']}/{row['lines']} {rate(row['lines_covered'], row['lines']):.1%}, "
              f"branches {row['branches_covered']}/{row['branches']} {rate(row['branches_covered'], row['branches']):.1%}")
    print(*count_lines(found["libraries"]), sep="\n")
    lines = [line_of(entry) for entry in found["missing"]]
    (out / "missing.txt").write_text("".join(f"{line}\n" for line in lines))
    print(*lines[:SHOWN], sep="\n")
    if len(lines) > SHOWN:
        print(f"{len(lines) - SHOWN} more functions: {out}/missing.txt")
    for name in found["failed"]:
        print(f"error: test_{name} failed: {out}/{name}.log")
    for text in found["below"]:
        print(f"error: {text}")
    return 1 if found["failed"] or found["below"] else 0


def run(arguments) -> int:
    out = (arguments.out / "cpp").resolve()
    out.mkdir(parents=True, exist_ok=True)
    if not arguments.no_build and not arguments.no_run:
        build(arguments.jobs)
    if arguments.build_only:
        return 0
    failed = [] if arguments.no_run else run_tests(out, arguments.jobs)
    files = gcov.read(objects(), ROOT)
    libraries = {name: library_figures(files, folder) for name, (folder, _) in LIBRARIES.items()}
    gaps = [entry for folder, _ in LIBRARIES.values() for entry in missing(files, folder)]
    found = {"libraries": libraries, "missing": gaps, "failed": failed, "below": below(libraries), "gcov": identity.version("gcov")}
    (out / "coverage.json").write_text(json.dumps(found, indent=1) + "\n")
    return show(found, out)
