"""Mutants that cannot change anything visible, each with its reason: verif/mutation/equivalents.toml."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Optional

KEYS = {"module", "original", "mutated", "nth", "reason"}


class EquivalentsError(Exception):
    """An entry that says too little, or that matches nothing."""


@dataclass
class Equivalent:
    module: str
    original: str
    mutated: List[str]
    nth: Optional[int]  # none: every one with these texts
    reason: str

    def covers(self, mutant: dict) -> bool:
        return (mutant["module"] == self.module and mutant["original"] == self.original
                and mutant["mutated"] in self.mutated and self.nth in (None, mutant["nth"]))


def read(path: Path) -> List[Equivalent]:
    result = []
    for entry in tomllib.loads(path.read_text()).get("equivalent", []):
        unknown, missing = set(entry) - KEYS, KEYS - {"nth"} - set(entry)
        if unknown or missing or not entry["reason"].strip():
            raise EquivalentsError(f"{path.name}: {entry}: needs module, original, mutated and reason, may have nth")
        mutated = entry["mutated"] if isinstance(entry["mutated"], list) else [entry["mutated"]]
        result.append(Equivalent(entry["module"], entry["original"], mutated, entry.get("nth"), entry["reason"]))
    return result


def by_mutant(entries: List[Equivalent], mutants: List[dict]) -> Dict[str, Equivalent]:
    """For the id of each mutant that is listed its entry. Every text of every entry must match a mutant."""
    listed = {}
    for entry in entries:
        covered = [mutant for mutant in mutants if entry.covers(mutant)]
        stale = set(entry.mutated) - {mutant["mutated"] for mutant in covered}
        if stale:
            raise EquivalentsError(
                f"equivalents: no such mutant of {entry.module}: {entry.original}  ->  {' / '.join(sorted(stale))}")
        for mutant in covered:
            if mutant["id"] in listed:
                raise EquivalentsError(f"equivalents: listed twice: {entry.module}: {entry.original}  ->  {mutant['mutated']}")
            listed[mutant["id"]] = entry
    return listed
