"""Keeps records in the tracked file of a release candidate, verif/evidence/RELEASE.json."""

import json
import re
from pathlib import Path
from typing import Iterable, List

from . import identity, record, results

FOLDER = identity.ROOT / identity.EVIDENCE
MADE_BY_PARTS = identity.ROOT / "build" / "evidence"
RELEASE = re.compile(r"(\d+)\.(\d+)\.(\d+)-rc(\d+)")


class KeepError(Exception):
    """A record that cannot be kept; the text says what to do."""


def project_version() -> str:
    found = re.search(r"^project\(\w+ VERSION (\d+\.\d+\.\d+)", (identity.ROOT / "CMakeLists.txt").read_text(), re.M)
    if not found:
        raise KeepError("CMakeLists.txt: no version in project()")
    return found.group(1)


def newest(folder: Path) -> str:
    """The release candidate with the highest numbers; the first candidate of this version if there is none."""
    releases = [match for path in folder.glob("*.json") if (match := RELEASE.fullmatch(path.stem))]
    if not releases:
        return f"{project_version()}-rc1"
    return max(releases, key=lambda match: tuple(map(int, match.groups()))).group(0)


def read_release(path: Path) -> results.Records:
    if not path.exists():
        return {}
    try:
        content = json.loads(path.read_text())
    except ValueError as error:
        raise record.RecordError(f"{path}: no JSON file: {error}") from error
    if not isinstance(content, dict) or not isinstance(content.get("records"), list):
        raise record.RecordError(f"{path}: field records: must be a list")
    checked = [record.check(entry, f"{path}: record {number}") for number, entry in enumerate(content["records"], 1)]
    return results.merge({entry["job"]: entry} for entry in checked)


def release_text(records: results.Records) -> str:
    """Sorted, a line for each record's identity, run, result, counts and tools, so that differences are readable."""
    lines = (("job", "kind", "command"), ("commit", "clean", "inputs"), ("begun", "seconds", "processor_seconds"),
             ("result", "exit_status", "log"), ("counts",), ("machine", "tools"), ("tests",), ("coverage",), ("mutants",), ("proofs",),
             ("clocks",))
    texts = []
    for job in sorted(records):
        entry = records[job]
        fields = [", ".join(f"{json.dumps(name)}: {json.dumps(entry[name], sort_keys=True)}" for name in line)
                  for line in lines if line[0] in entry]
        texts.append("    {" + ",\n     ".join(fields) + "}")
    return '{\n  "records": [\n' + ",\n".join(texts) + "\n  ]\n}\n"


def files_of(names: Iterable[Path]) -> List[Path]:
    """Records by file or folder."""
    found = [file for name in names for file in ([name] if name.is_file() else sorted(name.glob("*.json")))]
    if not found:
        raise KeepError("no records: scripts/test --long PART leaves them in build/evidence, scripts/farm run in its --out folder")
    return found


def keep(names: Iterable[Path], release: str, folder: Path = FOLDER) -> str:
    """Merges the records into the release's file; returns a summary. Writes nothing when it refuses a record."""
    if not RELEASE.fullmatch(release):
        raise KeepError(f"release {release}: must be VERSION-rcNUMBER, {project_version()}-rc1 for instance")
    entries = [record.read(file) for file in files_of(names)]
    dirty = sorted(entry["job"] for entry in entries if not entry["clean"])
    if dirty:
        raise KeepError(f"of a work tree with changes: {', '.join(dirty)}; commit the changes and run these again, or name the "
                        "files of the other records. Nothing was kept")
    cancelled = sorted(entry["job"] for entry in entries if not record.is_complete(entry))
    if cancelled:
        raise KeepError(f"cancelled before a result: {', '.join(cancelled)}; run these again, or name the files of the other "
                        "records. Nothing was kept")
    path = folder / f"{release}.json"
    before = read_release(path)
    merged = results.merge([before, *({entry["job"]: entry} for entry in entries)])
    record.write_text(path, release_text(merged))
    new = sum(merged[job] != before.get(job) for job in merged)
    return f"{path}: {len(merged)} records, {new} of them new or newer"
