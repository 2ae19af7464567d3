"""The jobs that the options of a command select, and those of them that are due."""

import sys
from typing import List, Tuple

from records import results

from . import catalogue, due
from .job import Job, JobError, read_list, with_needs


def chosen(arguments) -> List[Job]:
    """The selected jobs, with the builds that they need."""
    if arguments.list:
        jobs = read_list(arguments.list)
    else:
        jobs = catalogue.quick() if arguments.quick else catalogue.whole()
    if not arguments.kind and not arguments.job:
        return jobs
    unknown = set(arguments.kind or ()) - {job.kind for job in jobs} | set(arguments.job or ()) - {job.id for job in jobs}
    if unknown:
        raise JobError(f"no kind or job {', '.join(sorted(unknown))} (scripts/farm list shows them)")
    return with_needs(jobs, [job for job in jobs if job.kind in (arguments.kind or ()) or job.id in (arguments.job or ())])


def due_of(arguments) -> Tuple[List[Job], List[Job]]:
    """The selected jobs, and those of them that are due."""
    jobs, found = chosen(arguments), results.read_folder(arguments.out)
    todo = due.due(jobs, found)
    print(f"{len(todo)} of {len(jobs)} jobs are due", file=sys.stderr)
    return jobs, todo
