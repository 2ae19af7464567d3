"""A job: one process with its arguments, what it needs, and how long it is expected to take."""

import json
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Dict, Iterable, List, Tuple

from records import record

WORK = "{work}"  # stands in a command for the folder of its job
SHORTEST, LONGEST = 20, 15 * 60  # seconds: a shorter job costs too much to start; a longer one delays the others
GUESS = 120  # seconds, for jobs that were never measured


class JobError(Exception):
    """A list of jobs that cannot be run."""


@dataclass(frozen=True)
class Job:
    id: str
    kind: str  # one of records.record.KINDS
    command: Tuple[str, ...]
    inputs: Tuple[str, ...] = ()  # folders and files, as git pathspecs, whose tracked contents decide the result
    needs: Tuple[str, ...] = ()  # ids of the builds whose result it uses
    environment: Dict[str, str] = field(default_factory=dict)
    tests: str = ""  # the build whose ctest it runs; each job has its own folder for ctest's logs
    result_file: str = ""  # file in the job's folder from which counts are read, too
    products: Tuple[str, ...] = ()  # of a build: files that must exist, or it is made again
    tools: Tuple[str, ...] = ("python3",)  # tools whose versions the record names
    seconds: float = GUESS  # expected
    measured: bool = False  # whether `seconds` was measured
    limit: int = 0  # time limit in seconds; 0: derived from the expected seconds

    def time_limit(self) -> int:
        """Seconds after which the job is ended. The limit is wide, because another machine may be slower, and busy."""
        return self.limit or max(600, int(5 * self.seconds))

    def text(self) -> str:
        """The command as a user would type it."""
        shown = [f"build/{self.tests}" if self.tests and word == WORK else word.replace(WORK, f"build/farm/work/{self.id}")
                 for word in self.command]
        quoted = [f"'{word}'" if any(c in word for c in " |*()[]$\"") else word for word in shown]
        return " ".join([*(f"{name}={value}" for name, value in sorted(self.environment.items())), *quoted])


def check(jobs: Iterable[Job]) -> List[Job]:
    """The jobs, sorted so that each follows those that it needs. Raises JobError for duplicate ids, unknown needs and
    cycles."""
    waiting: Dict[str, Job] = {}
    for job in jobs:
        if not record.JOB.fullmatch(job.id) or job.kind not in record.KINDS:
            raise JobError(f"job {job.id}: id or kind {job.kind} is none that a record can have")
        if job.id in waiting:
            raise JobError(f"job {job.id}: is there twice")
        waiting[job.id] = job
    for job in waiting.values():
        missing = set(job.needs) - set(waiting)
        if missing:
            raise JobError(f"job {job.id}: needs {', '.join(sorted(missing))}, which the list does not have")
    ordered: Dict[str, Job] = {}
    while waiting:
        ready = [job for job in waiting.values() if all(need in ordered for need in job.needs)]
        if not ready:
            raise JobError(f"jobs need each other: {', '.join(sorted(waiting))}")
        for job in ready:
            ordered[job.id] = waiting.pop(job.id)
    return list(ordered.values())


def with_needs(jobs: Iterable[Job], chosen: Iterable[Job]) -> List[Job]:
    """The chosen jobs and all jobs that they need, in the order of the list."""
    jobs = list(jobs)
    by_id = {job.id: job for job in jobs}
    wanted, waiting = set(), [job.id for job in chosen]
    while waiting:
        name = waiting.pop()
        if name not in wanted:
            wanted.add(name)
            waiting += by_id[name].needs
    return [job for job in jobs if job.id in wanted]


def write_list(path: Path, jobs: Iterable[Job]):
    record.write_text(path, json.dumps([asdict(job) for job in jobs], indent=1) + "\n")


def read_list(path: Path) -> List[Job]:
    """A list of jobs from a file, as write_list() writes it; fields that a job leaves out have their defaults."""
    try:
        entries = json.loads(path.read_text())
        jobs = [Job(**{name: tuple(value) if isinstance(value, list) else value for name, value in entry.items()})
                for entry in entries]
    except (OSError, ValueError, TypeError) as error:
        raise JobError(f"{path}: no list of jobs: {error}") from error
    return check(jobs)


def with_seconds(jobs: Iterable[Job], measured: Dict[str, float]) -> List[Job]:
    return [replace(job, seconds=measured[job.id], measured=True) if job.id in measured else job for job in jobs]
