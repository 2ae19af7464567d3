"""Waivers: unreachable points, each with its reason, in verif/coverage/waivers.toml."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterable, List, Tuple

from .points import KINDS, Point

FIELDS = {"file": str, "text": str, "kind": str, "what": str, "reason": str}
MOST = 0.02  # largest share of a kind's points that may be waived
SHORTEST_REASON = 20  # characters; a shorter text is a word, not a reason


class WaiverError(Exception):
    """A waiver that is malformed, matches nothing or is not needed."""


@dataclass(frozen=True)
class Waiver:
    file: str
    text: str  # text of the line, without surrounding blanks: line numbers would change with each edit
    kind: str
    what: str  # "": matches any
    reason: str

    def __str__(self) -> str:
        return f'{self.file}: {self.kind} {self.what} at "{self.text}"'


def read(path: Path) -> List[Waiver]:
    try:
        entries = tomllib.loads(path.read_text()).get("waiver", [])
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise WaiverError(f"{path}: {error}") from error
    return [check(entry, f"{path}: waiver {number}") for number, entry in enumerate(entries, 1)]


def check(entry: dict, where: str) -> Waiver:
    unknown = set(entry) - set(FIELDS)
    if unknown:
        raise WaiverError(f"{where}: unknown field {', '.join(sorted(unknown))}")
    entry = {"what": "", **entry}
    for name, kind in FIELDS.items():
        if not isinstance(entry.get(name), kind):
            raise WaiverError(f"{where}: field {name}: must be a text")
    if entry["kind"] not in KINDS:
        raise WaiverError(f"{where}: field kind: must be one of {', '.join(KINDS)}")
    if len(entry["reason"].strip()) < SHORTEST_REASON:
        raise WaiverError(f"{where}: field reason: says too little")
    return Waiver(**entry)


def apply(waivers: Iterable[Waiver], counts: Dict[Point, int], root: Path) -> Tuple[Dict[Point, Waiver], List[str]]:
    """The waived points, and the faults of waivers: a waiver that matches no point, or one for a point that was
    reached."""
    texts: Dict[str, List[str]] = {}
    waived: Dict[Point, Waiver] = {}
    wrong = []
    for waiver in waivers:
        if waiver.kind not in {point.kind for point in counts}:
            continue  # toggles are counted only on request
        if waiver.file not in texts:
            path = root / waiver.file
            texts[waiver.file] = path.read_text().splitlines() if path.exists() else []
        lines = {number for number, text in enumerate(texts[waiver.file], 1) if text.strip() == waiver.text.strip()}
        found = [point for point in counts if (point.file, point.kind) == (waiver.file, waiver.kind) and point.line in lines
                 and waiver.what in ("", point.what)]
        if not found:
            wrong.append(f"waiver matches nothing: {waiver}")
        wrong += [f"waived, but covered {counts[point]} times: {point}" for point in found if counts[point]]
        waived.update({point: waiver for point in found if not counts[point]})
    return waived, wrong
