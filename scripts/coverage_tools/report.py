"""Report of RTL coverage: figures of each module, missing points, and the verdict."""

from collections import Counter
from typing import Dict, List

from .points import KINDS, Point
from .waivers import MOST, Waiver


def figures(counts: Dict[Point, int], waived: Dict[Point, Waiver]) -> Dict[str, Dict[str, int]]:
    """Numbers of all, covered and waived points, for each kind that has points."""
    found = {}
    for kind in KINDS:
        points = [point for point in counts if point.kind == kind]
        if points:
            found[kind] = {"points": len(points), "covered": sum(counts[point] > 0 for point in points),
                           "waived": sum(point in waived for point in points)}
    return found


def result(counts: Dict[Point, int], waived: Dict[Point, Waiver], modules: Dict[str, str], wrong: List[str]) -> dict:
    """The report as data. `modules`: the file of each clocked module, including modules without points (only wires)."""
    missing = sorted(point for point in counts if not counts[point] and point not in waived)
    return {
        "totals": figures(counts, waived),
        "modules": {name: {"file": file, **figures({p: n for p, n in counts.items() if p.file == file}, waived)}
                    for name, file in sorted(modules.items())},
        "missing": [{"file": p.file, "line": p.line, "kind": p.kind, "what": p.what} for p in missing],
        "waived": [{"file": p.file, "line": p.line, "kind": p.kind, "what": p.what, "reason": waived[p].reason}
                   for p in sorted(waived)],
        "wrong": wrong + too_many(counts, waived),
    }


def too_many(counts: Dict[Point, int], waived: Dict[Point, Waiver]) -> List[str]:
    all_points, waivers = Counter(point.kind for point in counts), Counter(point.kind for point in waived)
    return [f"{waivers[kind]} of {all_points[kind]} {kind} points are waived, more than {MOST:.0%}"
            for kind in KINDS if waivers[kind] > MOST * all_points[kind]]


def passed(found: dict) -> bool:
    return not found["missing"] and not found["wrong"]


def shown(figure: Dict[str, int]) -> str:
    """Covered points, out of those that are not waived, and the number of waived ones."""
    if not figure:
        return "-"
    needed = figure["points"] - figure["waived"]
    rate = 100.0 * figure["covered"] / needed if needed else 100.0
    return f"{figure['covered']}/{needed} {int(rate * 10) / 10:g}%" + (f" ({figure['waived']} waived)" if figure["waived"] else "")


def text(found: dict, sources: Dict[str, List[str]]) -> str:
    """The table, then a line for each missing point with its source text."""
    kinds = list(found["totals"])
    width = max(map(len, [*found["modules"], "module"]))
    lines = ["  ".join([f"{'module':{width}}", *(f"{kind:26}" for kind in kinds)]).rstrip()]
    rows = [*found["modules"].items(), ("all", found["totals"])]
    lines += ["  ".join([f"{name:{width}}", *(f"{shown(row.get(kind, {})):26}" for kind in kinds)]).rstrip() for name, row in rows]
    if found["missing"]:
        lines += ["", f"{len(found['missing'])} points are not covered and not waived:"]
        lines += [f"{p['file']}:{p['line']}: {p['kind']} {p['what']}: {source_line(sources, p)}" for p in found["missing"]]
    return "\n".join([*lines, *(f"error: {each}" for each in found["wrong"])])


def source_line(sources: Dict[str, List[str]], point: dict) -> str:
    lines = sources.get(point["file"], [])
    return lines[point["line"] - 1].strip() if point["line"] <= len(lines) else ""


def count_lines(found: dict) -> List[str]:
    """For the record of the run: scripts/records/counts.py reads these."""
    return [f"{row[name]} {kind} points{'' if name == 'points' else ' ' + name}"
            for kind, row in found["totals"].items() for name in ("points", "covered", "waived")]
