"""Each module's coverage, from the results of scripts/coverage."""

import json
from pathlib import Path

KINDS = ("line", "branch", "toggle")
NUMBERS = ("points", "covered", "waived")


def of_file(path: Path) -> dict:
    """By module and kind. Empty for a part of the locksteps, which does not judge modules, and for a run that wrote
    nothing."""
    found = json.loads(path.read_text()) if path.exists() else {}
    if not found.get("whole"):
        return {}
    return {name: {kind: row[kind] for kind in KINDS if kind in row} for name, row in found["modules"].items()}


def is_right(value) -> bool:
    """Whether a record may have this value."""
    return isinstance(value, dict) and all(
        isinstance(kinds, dict) and all(kind in KINDS and is_figure(figure) for kind, figure in kinds.items())
        for kinds in value.values())


def is_figure(value) -> bool:
    return isinstance(value, dict) and set(value) == set(NUMBERS) and all(type(number) is int for number in value.values())
