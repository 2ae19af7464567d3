"""Counts of what a run has compared, from the lines that tests print and the results of scripts/mutate and
scripts/prove."""

import csv
import re
from collections import Counter
from pathlib import Path
from typing import Dict

from . import figures

# Lines "NUMBER TEXT ...", and "compared NUMBER TEXT" of scripts/test. Their numbers are added up.
COUNTED = ("clocks of random traffic", "cycles of arcs", "stops judged", "of them with random inputs",
           "frames through a bad link", "frames of random contents", "frames spoiled", "clocks of soak",
           "clocks compared in lockstep")
# As scripts/coverage prints them at its end.
POINTS = tuple(f"{kind} points{how}" for kind in ("line", "branch", "toggle") for how in ("", " covered", " waived"))
POINTS += tuple(f"C++ {what}{how}" for what in ("lines", "branches") for how in ("", " covered"))
# Figures of a placement, which are not added up.
MEASURED = ("cells", "cells at most", "kHz", "kHz at least")
LINE = re.compile(r"^(?:\d+: |compared +)?(\d+) (.+)$", re.M)
# Summaries that programs print at their end; the groups have the names of the counts.
SUMMARIES = (
    re.compile(r"tests passed, (?P<tests_failed>\d+) tests? failed out of (?P<tests>\d+)"),
    re.compile(r"^(?P<mutants>\d+) mutants: ", re.M),
    re.compile(r"^of those that lived (?P<mutants_listed>\d+) are listed as equivalent, (?P<mutants_unlisted>\d+) are not", re.M),
    re.compile(r"^(?P<seeded_bugs_found>\d+) of \d+ seeded bugs found$", re.M),
    re.compile(r"stat::number_of_executed_units: (?P<inputs_tried>\d+)"),
)
GOOGLETEST = re.compile(r"^\[  PASSED  \] (\d+) tests?\.", re.M)
SKIPPED = re.compile(r"^\t *\d+ - .* \((?:Skipped|Disabled)\)$", re.M)


def add_up(entry: dict) -> bool:
    """Whether a record's counts may be added to others'. A placement has measurements instead; a build compares
    nothing."""
    return entry["kind"] not in ("placement", "build")


def of_text(text: str) -> Dict[str, int]:
    """The counts of a log."""
    found: Counter = Counter()
    for number, words in LINE.findall(text):
        name = next((name for name in COUNTED if words.startswith(name)), words if words in MEASURED + POINTS else "")
        if name in MEASURED:
            found[name] = int(number)
        elif name:
            found[name] += int(number)
    for summary in SUMMARIES:
        for match in summary.finditer(text):
            found.update({name: int(number) for name, number in match.groupdict().items()})
    if proofs := figures.proofs(text).values():
        found.update({"proof_runs": sum(each["runs"] for each in proofs),
                      "proof_runs_as_expected": sum(each["as_expected"] for each in proofs)})
    if "tests" in found:
        found["tests_skipped"] = len(SKIPPED.findall(text))
    else:  # one program, without ctest
        programs = GOOGLETEST.findall(text)
        found.update({"tests": sum(map(int, programs))} if programs else {})
    return dict(found)


def of_mutants(path: Path) -> Dict[str, int]:
    """From results.csv: the number of mutants per verdict."""
    with path.open(newline="") as file:
        rows = [row["how"] for row in csv.DictReader(file)]
    return {"mutants": len(rows), **{f"mutants {how}": number for how, number in sorted(Counter(rows).items())}}


def of_proofs(path: Path) -> Dict[str, int]:
    """From the list of results: the number of runs, and of those that ended as expected."""
    lines = path.read_text().splitlines()
    return {"proof_runs": len(lines), "proof_runs_as_expected": lines.count("ok")}


# The points of coverage.json are in the log, too.
OF_FILES = {"results.csv": of_mutants, "results": of_proofs, "coverage.json": lambda path: {}}


def of_file(path: Path) -> Dict[str, int]:
    """Counts of a result file, by its name; empty when the run ended before writing it."""
    return OF_FILES[path.name](path) if path.exists() else {}
