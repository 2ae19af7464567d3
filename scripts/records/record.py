"""The fields of a record, its file, and the checks of its values."""

import json
import os
import re
import tempfile
from pathlib import Path
from typing import Callable, Dict, Tuple

from . import coverage, figures

KINDS = ("lockstep", "mutation", "proof", "placement", "fuzz", "program", "sanitizer", "soak", "coverage", "part", "build")
RESULTS = ("passed", "failed", "timeout", "cancelled")
JOB = re.compile(r"[a-z0-9][A-Za-z0-9_.-]*")
# A fixed format, so that sorting the texts sorts the times.
BEGUN = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z")


class RecordError(Exception):
    """A record that is malformed; the text names file and field."""


def _is_text(value) -> bool:
    return isinstance(value, str)


def _is_count(value) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _is_time(value) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and value >= 0


def _matches(pattern) -> Callable[[object], bool]:
    return lambda value: _is_text(value) and re.compile(pattern).fullmatch(value) is not None


def _maps_to(check: Callable[[object], bool]) -> Callable[[object], bool]:
    return lambda value: isinstance(value, dict) and all(_is_text(key) and check(each) for key, each in value.items())


def _is_machine(value) -> bool:
    return (isinstance(value, dict) and set(value) == {"processors", "architecture"} and _is_count(value["processors"])
            and value["processors"] > 0 and _is_text(value["architecture"]))


def _is_inside(value) -> bool:
    return _is_text(value) and not Path(value).is_absolute() and ".." not in Path(value).parts


FIELDS: Dict[str, Tuple[Callable[[object], bool], str]] = {
    "job": (_matches(JOB), "the id of a job: letters, digits, '_', '.' and '-'"),
    "kind": (lambda value: value in KINDS, "one of " + ", ".join(KINDS)),
    "command": (_is_text, "a text"),
    "commit": (_matches("[0-9a-f]{40}"), "40 hexadecimal digits"),
    "clean": (lambda value: isinstance(value, bool), "true or false"),
    "inputs": (_matches("[0-9a-f]{64}"), "a SHA-256 in hexadecimal digits"),
    "begun": (_matches(BEGUN), "a time in UTC as 2026-01-31T23:59:59.999Z"),
    "seconds": (_is_time, "seconds, 0 or more"),
    "processor_seconds": (_is_time, "seconds, 0 or more"),
    "result": (lambda value: value in RESULTS, "one of " + ", ".join(RESULTS)),
    "exit_status": (_is_count, "an integer"),
    "counts": (_maps_to(_is_count), "integers by name"),
    "tools": (_maps_to(_is_text), "versions by name"),
    "machine": (_is_machine, "processors and architecture"),
    "log": (_is_inside, "a path relative to the folder of results"),
}
OPTIONAL = {
    "coverage": (coverage.is_right, "points, covered and waived of line, branch and toggle by module"),
    "tests": (_maps_to(lambda value: value in ("passed", "failed", "skipped")), "passed, failed or skipped by test"),
    **figures.FIELDS,
}


def check(record: object, where: str) -> dict:
    """Returns the record if it has exactly the known fields, each with a valid value; otherwise raises RecordError."""
    if not isinstance(record, dict):
        raise RecordError(f"{where}: is no object")
    for name, (right, text) in {**FIELDS, **OPTIONAL}.items():
        if name not in record and name in OPTIONAL:
            continue
        if name not in record:
            raise RecordError(f"{where}: field {name}: missing")
        if not right(record[name]):
            raise RecordError(f"{where}: field {name}: must be {text}, is {json.dumps(record[name])}")
    for name in record:
        if name not in FIELDS and name not in OPTIONAL:
            raise RecordError(f"{where}: field {name}: unknown")
    if (record["result"] == "passed") != (record["exit_status"] == 0):
        raise RecordError(f"{where}: field exit_status: {record['exit_status']}, though the result is {record['result']}")
    return record


def is_complete(record: dict) -> bool:
    """Whether the run reached a verdict; a cancelled run did not."""
    return record["result"] != "cancelled"


def read(path: Path) -> dict:
    try:
        content = json.loads(path.read_text())
    except (ValueError, OSError) as error:
        raise RecordError(f"{path}: no JSON file: {error}") from error
    return check(content, str(path))


def write_text(path: Path, text: str):
    """Writes a temporary file and renames it, so that readers never see a partial file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    try:
        with os.fdopen(handle, "w") as file:
            file.write(text)
        os.chmod(name, 0o644)
        os.rename(name, path)
    except BaseException:
        os.unlink(name)
        raise


def write(path: Path, record: dict):
    write_text(path, json.dumps(check(record, str(path)), indent=2, sort_keys=True) + "\n")
