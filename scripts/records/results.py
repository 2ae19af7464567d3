"""Folders of records, and how those of several are merged."""

import json
from pathlib import Path
from typing import Dict, Iterable

from . import record

Records = Dict[str, dict]  # by job


def rank(entry: dict):
    """Orders all records of one job: a verdict before none, then the newer; with equal times the content decides, so that
    the order of merging never does."""
    return record.is_complete(entry), entry["begun"], json.dumps(entry, sort_keys=True)


def merge(parts: Iterable[Records]) -> Records:
    """Of each job the record of the highest rank. Associative and commutative; what is doubled or missing does no harm."""
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
