"""Texts about lists of jobs and folders of results."""

import statistics
from collections import Counter, defaultdict
from typing import Dict, List

from records import counts, results

from . import plan
from .job import LONGEST, SHORTEST, Job

WORKERS = (1, 2, 4, 8, 16, 32, 64)


def minutes(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 120 else f"{seconds / 60:.1f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"


def jobs_text(jobs: List[Job]) -> str:
    """A line for each job."""
    lines = [f"{job.kind:10} {job.id:34} {'' if job.measured else '~'}{job.seconds:>.0f} s".ljust(56)
             + (f"  needs {', '.join(job.needs)}" if job.needs else "") for job in jobs]
    return "\n".join(lines)


def arithmetic_text(jobs: List[Job], workers=WORKERS) -> str:
    """Total, critical path, exceptions, and the time for so many workers."""
    length, chain = plan.critical_path(jobs)
    guessed = sum(not job.measured for job in jobs)
    lines = [f"{len(jobs)} jobs, {minutes(plan.total(jobs))} of one worker; {guessed} of the times are guesses (~)",
             f"critical path {minutes(length)}: {' > '.join(chain)}"]
    lines += [f"{count:4} workers: {minutes(plan.makespan(jobs, count))}" for count in workers]
    odd = plan.exceptions(jobs)
    short = [job for job in odd if job.seconds < SHORTEST]
    lines.append(f"outside {SHORTEST} s to {minutes(LONGEST)}: {len(short)} shorter, {minutes(sum(job.seconds for job in short))} "
                 f"in all; {len(odd) - len(short)} longer")
    lines += [f"  {job.id}: {minutes(job.seconds)}" for job in odd]
    return "\n".join(lines)


def kinds_text(found: results.Records) -> str:
    """For each kind: the number of jobs per result, their times and their counts."""
    by_kind: Dict[str, List[dict]] = defaultdict(list)
    for entry in found.values():
        by_kind[entry["kind"]].append(entry)
    lines = []
    for kind, entries in sorted(by_kind.items()):
        ends = ", ".join(f"{number} {result}" for result, number in sorted(Counter(e["result"] for e in entries).items()))
        wall, used = (sum(entry[name] for entry in entries) for name in ("seconds", "processor_seconds"))
        lines.append(f"{kind:10} {ends}; {minutes(wall)} of workers, {minutes(used)} of processors")
        counted: Counter = Counter()
        for entry in filter(counts.add_up, entries):
            counted.update(entry["counts"])
        lines += [f"{'':10}   {number:,} {name}" for name, number in sorted(counted.items())]
    return "\n".join(lines)


def placements_text(found: results.Records) -> str:
    """Medians of the seeds of each placed build, against its targets."""
    seeds: Dict[str, List[dict]] = defaultdict(list)
    for job, entry in found.items():
        if entry["kind"] == "placement" and entry["result"] == "passed":
            seeds[job.rpartition("-s")[0] or job].append(entry["counts"])
    return "\n".join(placement_line(name, each) for name, each in sorted(seeds.items()))


def placement_line(name: str, seeds: List[dict]) -> str:
    cells = statistics.median_low(each["cells"] for each in seeds)
    clock = statistics.median(each["kHz"] for each in seeds)
    missed = cells > seeds[0].get("cells at most", cells) or clock < seeds[0].get("kHz at least", clock)
    wanted = ", ".join(f"{seeds[0][key]} {key}" for key in ("cells at most", "kHz at least") if key in seeds[0])
    return f"{name}: {cells} cells, median {clock:.0f} kHz of {len(seeds)} seeds" + (
        f" ({wanted}{': MISSED' if missed else ''})" if wanted else "")


def failures_text(found: results.Records) -> str:
    return "\n".join(f"{entry['result'].upper()} {job}: {entry['command']}\n  log: {entry['log']}"
                     for job, entry in sorted(found.items()) if entry["result"] != "passed")


def report_text(found: results.Records) -> str:
    dirty = sum(not entry["clean"] for entry in found.values())
    commits = Counter(entry["commit"][:12] for entry in found.values())
    head = f"{len(found)} records of {', '.join(f'{commit} ({number})' for commit, number in sorted(commits.items()))}"
    head += f"; {dirty} of work trees with changes" if dirty else ""
    return "\n".join(filter(None, (head, kinds_text(found), placements_text(found), failures_text(found))))
