"""The arithmetic of a list of jobs: total, critical path, and how long N workers need."""

import heapq
from typing import Dict, List, Tuple

from .job import LONGEST, SHORTEST, Job


def total(jobs: List[Job]) -> float:
    """Seconds that one worker needs."""
    return sum(job.seconds for job in jobs)


def critical_path(jobs: List[Job]) -> Tuple[float, List[str]]:
    """Seconds of the longest chain of dependent jobs, and the chain. The list has each job after those that it
    needs."""
    ends: Dict[str, Tuple[float, List[str]]] = {}
    for job in jobs:
        before = max((ends[need] for need in job.needs if need in ends), default=(0.0, []))
        ends[job.id] = (before[0] + job.seconds, [*before[1], job.id])
    return max(ends.values(), default=(0.0, []))


def urgency(jobs: List[Job]) -> Dict[str, float]:
    """For each job, the seconds of the longest chain that begins with it: the larger, the sooner it should start."""
    found = {job.id: job.seconds for job in jobs}
    for job in reversed(jobs):
        for need in job.needs:
            if need in found:
                seconds = next(each.seconds for each in jobs if each.id == need)
                found[need] = max(found[need], seconds + found[job.id])
    return found


def ready(waiting: List[Job], unfinished: set, order: Dict[str, float]) -> List[Job]:
    """The waiting jobs that can start, the most urgent first; builds before others."""
    free = [job for job in waiting if not unfinished.intersection(job.needs)]
    return sorted(free, key=lambda job: (job.kind != "build", -order[job.id], job.id))


def makespan(jobs: List[Job], workers: int) -> float:
    """Seconds until the last of so many workers is done, if each takes the most urgent job that can start."""
    order, waiting, unfinished = urgency(jobs), list(jobs), {job.id for job in jobs}
    running: List[Tuple[float, str]] = []
    now = 0.0
    while waiting or running:
        for job in ready(waiting, unfinished, order)[:workers - len(running)]:
            waiting.remove(job)
            heapq.heappush(running, (now + job.seconds, job.id))
        now, ended = heapq.heappop(running)
        unfinished.discard(ended)
    return now


def exceptions(jobs: List[Job]) -> List[Job]:
    """Jobs outside SHORTEST to LONGEST; builds are exempt."""
    return [job for job in jobs if job.kind != "build" and not SHORTEST <= job.seconds <= LONGEST]
