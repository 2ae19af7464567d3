"""Folders of records, and the merging of several."""

import json
from pathlib import Path
from typing import Dict, Iterable

from . import record

Records = Dict[str, dict]  # by job


def rank(entry: dict):
    """Sort key for the records of one job: records with a verdict outrank those without, then newer ones outrank older
    ones. With equal times the content decides, so that the order of merging does not matter."""
    return record.is_complete(entry), entry["begun"], json.dumps(entry, sort_keys=True)


def merge(parts: Iterable[Records]) -> Records:
    """The record of the highest rank for each job. The operation is associative and commutative; duplicates and missing
    records do no harm."""
    merged: Records = {}
    for part in parts:
        for job, entry in part.items():
            if job not in merged or rank(entry) > rank(merged[job]):
                merged[job] = entry
    return dict(sorted(merged.items()))


def read_folder(folder: Path) -> Records:
    """All records of a folder; none when it is missing."""
    found = {}
    for path in sorted(folder.glob("*.json")):
        entry = record.read(path)
        if path.name != f"{entry['job']}.json":
            raise record.RecordError(f"{path}: field job: is {entry['job']}, so the file must be {entry['job']}.json")
        found[entry["job"]] = entry
    return found


def store(folder: Path, entry: dict):
    """Puts a record into its folder. A cancelled run replaces no verdict."""
    path = folder / f"{entry['job']}.json"
    if not record.is_complete(entry) and path.exists() and record.is_complete(record.read(path)):
        return
    record.write(path, entry)
