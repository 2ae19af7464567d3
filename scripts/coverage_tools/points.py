"""Coverage points of Verilator's .dat files. lcov shows only lines, so this module reads the files itself."""

import re
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterable

KINDS = ("line", "branch", "toggle")
ENTRY = re.compile(r"C '(.*)' (\d+)")


class PointError(Exception):
    """A .dat file whose format differs from that of Verilator 5.006."""


@dataclass(frozen=True, order=True)
class Point:
    """A place in the source of a module, for all instances and parameters. It is covered when one instance is."""
    file: str  # below the project's folder
    line: int
    column: int
    kind: str
    what: str  # for a line: block, elsif, case; for a branch: if, else; for a toggle: the signal's bit
    module: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.kind} {self.what}"


def of_text(text: str, where: str, root: Path) -> Dict[Point, int]:
    """Counts by point, summed over all instances."""
    found: Dict[Point, int] = defaultdict(int)
    lines = text.splitlines()
    if not lines or not lines[0].startswith("# SystemC::Coverage"):
        raise PointError(f"{where}: no coverage file of Verilator")
    for number, line in enumerate(lines[1:], 2):
        entry = ENTRY.fullmatch(line)
        if not entry:
            raise PointError(f"{where}:{number}: no coverage point")
        keys = dict(part.split("\2", 1) for part in entry.group(1).split("\1") if "\2" in part)
        try:
            kind, _, module = keys["page"].partition("/")
            point = Point(relative(keys["f"], root), int(keys["l"]), int(keys["n"]), kind.removeprefix("v_"), keys["o"],
                          module.partition("__")[0])
        except (KeyError, ValueError) as error:
            raise PointError(f"{where}:{number}: a point without {error}") from error
        if point.kind not in KINDS:
            raise PointError(f"{where}:{number}: a point of the kind {point.kind}")
        found[point] += int(entry.group(2))
    return found


def relative(file: str, root: Path) -> str:
    path = Path(file)
    return str(path.relative_to(root)) if path.is_absolute() and path.is_relative_to(root) else file


def merge(parts: Iterable[Dict[Point, int]]) -> Dict[Point, int]:
    merged: Dict[Point, int] = defaultdict(int)
    for part in parts:
        for point, count in part.items():
            merged[point] += count
    return merged


def read(files: Iterable[Path], root: Path) -> Dict[Point, int]:
    return merge(of_text(file.read_text(), str(file), root) for file in files)
