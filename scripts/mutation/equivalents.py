"""Equivalent mutants, which cannot change any output, each with its reason: verif/mutation/equivalents."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Optional

KEYS = [{"module", "original", "mutated", "reason"}, {"module", "part", "reason"}]


class EquivalentsError(Exception):
    """An entry that is incomplete, or that matches no mutant."""


@dataclass
class Equivalent:
    modules: List[str]
    original: str
    mutated: List[str]
    nth: Optional[int]  # None: every mutant with these texts
    part: str  # part of the mutated text that a family of mutants has in common; replaces `original` and `mutated`
    reason: str

    def covers(self, mutant: dict) -> bool:
        if mutant["module"] not in self.modules or self.nth not in (None, mutant["nth"]):
            return False
        if self.part:
            return self.part in mutant["mutated"] and self.part not in mutant["original"]
        return mutant["original"] == self.original and mutant["mutated"] in self.mutated


def read(folder: Path) -> List[Equivalent]:
    """The entries of all files of the folder."""
    files = sorted(folder.glob("*.toml"))
    if not files:
        raise EquivalentsError(f"{folder}: no file NAME.toml")
    return [entry for file in files for entry in _read_file(file)]


def _read_file(path: Path) -> List[Equivalent]:
    result = []
    for entry in tomllib.loads(path.read_text()).get("equivalent", []):
        if set(entry) - {"nth"} not in KEYS or not entry["reason"].strip() or not entry.get("part", "-"):
            raise EquivalentsError(f"{path.name}: {entry}: needs module, reason and original with mutated, or part; may have nth")
        result.append(Equivalent(as_list(entry["module"]), entry.get("original", ""), as_list(entry.get("mutated", [])),
                                 entry.get("nth"), entry.get("part", ""), entry["reason"]))
    return result


def as_list(value) -> List[str]:
    return value if isinstance(value, list) else [value]


def by_mutant(entries: List[Equivalent], mutants: List[dict]) -> Dict[str, Equivalent]:
    """The entry of each listed mutant, by the mutant's id. Every text and module of every entry must match a mutant."""
    listed = {}
    for entry in entries:
        covered = [mutant for mutant in mutants if entry.covers(mutant)]
        stale = set(entry.mutated) - {mutant["mutated"] for mutant in covered}
        empty = set(entry.modules) - {mutant["module"] for mutant in covered}
        if stale or empty:
            raise EquivalentsError(f"equivalents: no such mutant of {', '.join(sorted(empty) or entry.modules)}: "
                                   f"{entry.original}  ->  {entry.part or ' / '.join(sorted(stale) or entry.mutated)}")
        for mutant in covered:
            if mutant["id"] in listed:
                raise EquivalentsError(f"equivalents: listed twice: {mutant['module']}: {mutant['original']}  ->  {mutant['mutated']}")
            listed[mutant["id"]] = entry
    return listed
