"""Verdicts from ctest's results in JUnit format."""

import re
import tomllib
from pathlib import Path
from typing import Dict, Iterator, Tuple
from xml.etree import ElementTree

from . import identity

JUDGES = identity.ROOT / identity.EVIDENCE / "foreign_judges.toml"
VERDICTS = {"run": "passed", "fail": "failed", "notrun": "skipped", "disabled": "skipped"}


def tests_of(junit: Path) -> Iterator[Tuple[str, str]]:
    """Name and verdict of each test."""
    for case in ElementTree.parse(junit).getroot().iter("testcase"):
        yield case.get("name", ""), VERDICTS.get(case.get("status", ""), "failed")


def counts_of(junit: Path) -> Dict[str, int]:
    tests = list(tests_of(junit))
    ended = [verdict for _, verdict in tests]
    # By name: ctest 3.25 writes no labels.
    found = sum(verdict == "passed" and name.startswith("seeded_bug.") for name, verdict in tests)
    return {"tests": len(tests), "tests_passed": ended.count("passed"), "tests_failed": ended.count("failed"),
            "tests_skipped": ended.count("skipped"), "seeded_bugs_found": found}


def foreign(junit: Path, judges: Path = JUDGES) -> Dict[str, str]:
    """The verdicts of the tests in which a third-party program judges; empty without the list of such programs."""
    if not judges.exists():
        return {}
    patterns = [judge["tests"] for judge in tomllib.loads(judges.read_text()).get("judge", []) if "tests" in judge]
    return {name: verdict for name, verdict in tests_of(junit) if any(re.search(each, name) for each in patterns)}
