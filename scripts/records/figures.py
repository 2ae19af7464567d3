"""A run's figures by module or by proof, which the evidence page shows for each module."""

import csv
import re
from pathlib import Path
from typing import Callable, Dict

# Lines of ctest's whole log: the beginning of a test of the lockstep NAME, and the count that it prints at its end.
LOCKSTEP = re.compile(r"^\d+/\d+ Testing: (?:lockstep\.(\w+)\.)?|^(\d+) clocks compared in lockstep$", re.M)
PROOF_RUN = re.compile(r"^(?:lemma|proof|bounded|cover|bug) +(\w+).* s  (ok|FAILED)", re.M)
MUTANTS = ("tried", "killed")
PROOFS = ("runs", "as_expected")


def mutants(path: Path) -> dict:
    """By module, from a campaign's results.csv; empty when the run ended before writing it."""
    found: dict = {}
    if path.exists():
        with path.open(newline="") as file:
            for row in csv.DictReader(file):
                figure = found.setdefault(row["module"], dict.fromkeys(MUTANTS, 0))
                figure["tried"] += 1
                figure["killed"] += row["how"] != "lived"
    return found


def proofs(log: str) -> dict:
    """By proof, with its covers and seeded bugs, from the output of scripts/prove."""
    found: dict = {}
    for name, result in PROOF_RUN.findall(log):
        figure = found.setdefault(name, dict.fromkeys(PROOFS, 0))
        figure["runs"] += 1
        figure["as_expected"] += result == "ok"
    return found


def clocks(log: str) -> dict:
    """Clocks that each lockstep has compared, from ctest's whole log."""
    found: dict = {}
    name = None
    for lockstep, number in LOCKSTEP.findall(log):
        if number and name:
            found[name] = found.get(name, 0) + int(number)
        elif not number:
            name = lockstep
    return found


def _has(names) -> Callable[[object], bool]:
    """A check for record fields: integers with these names, by module or proof."""
    return lambda value: isinstance(value, dict) and all(
        isinstance(figure, dict) and set(figure) == set(names) and all(type(number) is int for number in figure.values())
        for figure in value.values())


def _are_counts(value) -> bool:
    return isinstance(value, dict) and all(type(number) is int for number in value.values())


FIELDS: Dict[str, tuple] = {"mutants": (_has(MUTANTS), "tried and killed by module"),
                            "proofs": (_has(PROOFS), "runs and as_expected by proof"),
                            "clocks": (_are_counts, "integers by lockstep")}
