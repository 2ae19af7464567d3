"""Lines and branches of C++ from gcov's JSON."""

import json
import os
import subprocess
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path
from typing import Dict, Iterable, List, Tuple

Place = Tuple[int, int]  # line and column of a function's beginning, the same for all instances of a template


@dataclass
class Function:
    """All instances of a function. A line or branch is covered when one instance has reached it."""
    name: str
    lines: Dict[int, int] = field(default_factory=lambda: defaultdict(int))
    branches: Dict[Tuple[int, int], int] = field(default_factory=lambda: defaultdict(int))  # by line and branch


Files = Dict[str, Dict[Place, Function]]  # functions by file below the project's folder


def decisions(branches: List[dict]) -> List[int]:
    """Counts of the branches, without the pair at each call that returns or throws: that pair is no decision in the
    source."""
    found, position = [], 0
    while position < len(branches):
        if any(branch["throw"] for branch in branches[position:position + 2]):
            position += 2
        else:
            found.append(branches[position]["count"])
            position += 1
    return found


def add(files: Files, report: dict, root: Path):
    """Adds what gcov says about one object."""
    for entry in report["files"]:
        name = relative(Path(report["current_working_directory"]) / entry["file"], root)
        if name is None:
            continue
        places: Dict[str, Place] = {}
        known = files.setdefault(name, {})
        for function in entry["functions"]:
            place = (function["start_line"], function["start_column"])
            places[function["name"]] = place
            known.setdefault(place, Function(function["demangled_name"]))
        for line in entry["lines"]:
            if line.get("function_name") in places:
                add_line(known[places[line["function_name"]]], line)


def add_line(function: Function, line: dict):
    function.lines[line["line_number"]] += line["count"]
    for number, count in enumerate(decisions(line["branches"])):
        function.branches[line["line_number"], number] += count


def relative(file: Path, root: Path):
    """The path below the project's folder; None for a file outside it, and for one that the build generated."""
    path = Path(os.path.normpath(file))
    if not path.is_relative_to(root):
        return None
    path = path.relative_to(root)
    return None if path.parts[0] == "build" else str(path)


def read(objects: Iterable[Path], root: Path) -> Files:
    """Reads the coverage of .gcno files. Files of a program that never ran count zero."""
    files: Files = {}
    for path in objects:
        done = subprocess.run(["gcov", "--json-format", "--stdout", "--branch-probabilities", str(path)], cwd=path.parent,
                              check=True, capture_output=True, text=True)
        for line in done.stdout.splitlines():
            if line.startswith("{"):
                add(files, json.loads(line), root)
    return files
