"""The jobs that a run has to do: those without a passed record of the same inputs."""

from typing import Dict, Iterable, List

from records import identity, results

from .job import Job
from .run_job import inputs_of


def why(job: Job, found: results.Records) -> str:
    """Why the job is due; empty when it is not."""
    if job.id not in found:
        return "missing"
    if found[job.id]["result"] != "passed":
        return found[job.id]["result"]
    if found[job.id]["inputs"] != inputs_of(job):
        return "older than its inputs"
    if not all((identity.ROOT / product).exists() for product in job.products):
        return "its product is gone"
    return ""


def due(jobs: Iterable[Job], found: results.Records) -> List[Job]:
    """The jobs that are due, in order. A build whose dependent jobs are all up to date is not due."""
    jobs = list(jobs)
    reasons: Dict[str, str] = {job.id: why(job, found) for job in jobs}
    wanted = {job.id for job in jobs if reasons[job.id] and (job.kind != "build" or is_alone(job, jobs))}
    for job in reversed(jobs):  # jobs come after those that they need
        if job.id in wanted:
            wanted |= set(job.needs)
    return [job for job in jobs if reasons[job.id] and job.id in wanted]


def is_alone(job: Job, jobs: List[Job]) -> bool:
    """Whether no other job needs it, so that it was asked for by itself."""
    return not any(job.id in other.needs for other in jobs)
