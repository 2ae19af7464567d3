"""The list of jobs as Slurm job arrays. The index of a task is its place in the list. Results come from the records
only, so the cluster needs no accounting."""

import json
import os
import shlex
import signal
import sys
import threading
import time
from dataclasses import replace
from itertools import groupby
from pathlib import Path
from typing import Dict, List, Set

from records import identity, record, results

from .due import why
from .job import Job, JobError, read_list, write_list
from .run_job import Run
from .submission import SlurmError, Submission, call

MARGIN = 2  # minutes of Slurm's limit beyond the job's own limit, which comes first and leaves a record


def submit(jobs: List[Job], folder: Path, partition: str = "") -> str:
    """Submits the jobs, each kind as an array that depends on the builds that it needs."""
    place = folder.resolve() / "slurm"
    if (place / "arrays.json").exists() and Submission(folder).active():
        raise SlurmError(f"{folder}: jobs of an earlier submission are under way: scripts/farm slurm wait or cancel first")
    (place / "logs").mkdir(parents=True, exist_ok=True)
    # Builds that are not due exist already.
    submitted = {job.id for job in jobs}
    jobs = [replace(job, needs=tuple(need for need in job.needs if need in submitted)) for job in jobs]
    write_list(place / "jobs.json", jobs)
    arrays: Dict[str, List[int]] = {}
    array_of: Dict[str, str] = {}
    indices = sorted(range(len(jobs)), key=lambda index: group_of(jobs[index], index))
    for _, group in groupby(indices, key=lambda index: group_of(jobs[index], index)):
        members = list(group)
        needs = {array_of[need] for index in members for need in jobs[index].needs if need in array_of}
        array = call(*command_of([jobs[index] for index in members], members, needs, place, partition)).strip().split(";")[0]
        arrays[array] = members
        array_of.update({jobs[index].id: array for index in members})
        record.write_text(place / "arrays.json", json.dumps(arrays) + "\n")
    return f"{len(jobs)} jobs submitted as {len(arrays)} arrays"


def group_of(job: Job, index: int):
    """Sort key of the arrays. Each build is an array of its own and comes first, in the order of the list; other jobs
    share an array if they have the same kind and the same needs."""
    return (0, index, ()) if job.kind == "build" else (1, job.kind, job.needs)


def command_of(jobs: List[Job], indices: List[int], needs: Set[str], place: Path, partition: str) -> List[str]:
    minutes = max(job.time_limit() for job in jobs) // 60 + MARGIN
    task = shlex.join([sys.executable, "-B", str(identity.ROOT / "scripts" / "farm"), "slurm", "task", "--out", str(place.parent)])
    return ["sbatch", "--parsable", "--requeue", f"--job-name=trammel-{jobs[0].kind}", f"--chdir={identity.ROOT}",
            f"--array={','.join(map(str, indices))}", f"--time={minutes}", f"--output={place}/logs/%a.log", "--open-mode=append",
            "--kill-on-invalid-dep=yes", *([f"--dependency=afterok:{':'.join(sorted(needs))}"] if needs else []),
            *(["--exclusive"] if jobs[0].kind == "build" else ["--cpus-per-task=1"]),
            *([f"--partition={partition}"] if partition else []), f"--wrap=exec {task}"]


def task(folder: Path) -> int:
    """Runs the job of this array's task. When Slurm sends a signal to end, the job leaves a record, too."""
    jobs = read_list(folder / "slurm" / "jobs.json")
    index = os.environ.get("SLURM_ARRAY_TASK_ID", "")
    if not index.isdigit() or int(index) >= len(jobs):
        raise JobError(f"SLURM_ARRAY_TASK_ID is {index or 'not set'}; this is for tasks of scripts/farm slurm submit")
    run = Run(jobs[int(index)], folder)
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: threading.Thread(target=run.cancel).start())
    entry = run.run()
    print(f"{entry['job']}: {entry['result']}")
    return 0 if entry["result"] == "passed" else 1


def wait(folder: Path, seconds: float = 2.0) -> bool:
    """Waits until all tasks have ended; returns whether all submitted jobs have passed."""
    submission, last = Submission(folder), ""
    while active := submission.active():
        running = sum(state == "RUNNING" for state in active.values())
        text = f"{len(submission.submitted()) - len(active)} of {len(submission.submitted())} ended, {running} running"
        if text != last:
            print(f"\r\033[K{text}" if sys.stderr.isatty() else text, end="" if sys.stderr.isatty() else "\n", file=sys.stderr,
                  flush=True)
        last = text
        time.sleep(seconds)
    return all(state == "passed" for state in submission.states().values())


def cancel(folder: Path):
    call("scancel", *Submission(folder).arrays)


def requeue(folder: Path) -> List[str]:
    """Requeues the jobs that have ended without a pass, while Slurm still knows them; returns their ids."""
    submission = Submission(folder)
    active, found = submission.active(), results.read_folder(submission.folder)
    again = []
    for array, indices in submission.arrays.items():
        for index in indices:
            if index not in active and why(submission.jobs[index], found):
                call("scontrol", "requeue", f"{array}_{index}")
                again.append(submission.jobs[index].id)
    return again
