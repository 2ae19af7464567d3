"""The commands of scripts/farm."""

import fcntl
import shutil
import signal
import sys
from pathlib import Path
from typing import List

from records import record, results

from . import catalogue, due, local, report, slurm_command
from .choice import chosen, due_of
from .cluster import ClusterError
from .job import Job, JobError
from .options import arguments_of
from .submission import SlurmError

ERRORS = (JobError, record.RecordError, SlurmError, ClusterError)


def show_list(arguments) -> int:
    jobs = chosen(arguments)
    print(report.jobs_text(jobs), report.arithmetic_text(jobs, arguments.workers or report.WORKERS), sep="\n\n")
    return 0


def verdict(jobs: List[Job], folder: Path) -> int:
    """0 when each job has passed, now or earlier. Builds that no job of the list still needs may be without a
    record."""
    found = results.read_folder(folder)
    return 1 if due.due(jobs, found) else 0


def run(arguments) -> int:
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # so that SIGTERM ends the jobs, too
    if arguments.workers < 1:
        raise JobError(f"--workers {arguments.workers}: must be 1 or more")
    arguments.out.mkdir(parents=True, exist_ok=True)
    with (arguments.out / "lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise JobError(f"{arguments.out}: another scripts/farm run uses this folder; wait for it, or name another --out")
        jobs, todo = due_of(arguments)
        if todo:
            local.run(todo, arguments.out, arguments.workers)
        return verdict(jobs, arguments.out)


def merge(arguments) -> int:
    parts = [(folder, results.read_folder(folder)) for folder in [*arguments.folders, arguments.out]]
    merged = results.merge(part for _, part in parts)
    for job, entry in merged.items():
        folder = next(folder for folder, part in parts if part.get(job) == entry)
        if folder.resolve() != arguments.out.resolve():
            record.write(arguments.out / f"{job}.json", entry)
            if (folder / entry["log"]).exists():
                (arguments.out / entry["log"]).parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(folder / entry["log"], arguments.out / entry["log"])
    print(f"{len(merged)} records in {arguments.out}")
    return 0


def show_report(arguments) -> int:
    found = results.read_folder(arguments.folder)
    if not found:
        raise JobError(f"{arguments.folder}: no records")
    print(report.report_text(found))
    return 0 if all(entry["result"] == "passed" for entry in found.values()) else 1


def expect(arguments) -> int:
    jobs = [*catalogue.whole(), *catalogue.quick()]
    number = catalogue.measure(jobs, results.read_folder(arguments.folder), arguments.field)
    print(f"seconds of {number} jobs taken into {catalogue.EXPECTED}")
    return 0


COMMANDS = {"list": show_list, "run": run, "merge": merge, "report": show_report, "expect": expect, **slurm_command.COMMANDS}


def main(argv=None) -> int:
    arguments = arguments_of(argv)
    try:
        return COMMANDS[arguments.name](arguments)
    except ERRORS as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
