"""The commands of scripts/farm for Slurm."""

from . import cluster, slurm
from .choice import due_of
from .submission import Submission


def slurm_submit(arguments) -> int:
    _, todo = due_of(arguments)
    if todo:
        print(slurm.submit(todo, arguments.out, arguments.partition))
    return 0


def slurm_wait(arguments) -> int:
    passed = slurm.wait(arguments.out)
    slurm_status(arguments)
    return 0 if passed else 1


def slurm_status(arguments) -> int:
    states = Submission(arguments.out).states()
    for state in sorted(set(states.values())):
        names = sorted(job for job, each in states.items() if each == state)
        shown = "" if state == "passed" else ": " + ", ".join(names[:20]) + (" ..." if len(names) > 20 else "")
        print(f"{len(names):4} {state}{shown}")
    return 0


def slurm_cancel(arguments) -> int:
    slurm.cancel(arguments.out)
    return 0


def slurm_requeue(arguments) -> int:
    again = slurm.requeue(arguments.out)
    print(f"{len(again)} jobs run again" + (f": {', '.join(again)}" if again else ""))
    return 0


def cluster_up(arguments) -> int:
    print(cluster.up(arguments.folder, arguments.processors))
    return 0


def cluster_down(arguments) -> int:
    cluster.down(arguments.folder)
    return 0


def slurm_task(arguments) -> int:
    return slurm.task(arguments.out)


COMMANDS = {"slurm submit": slurm_submit, "slurm wait": slurm_wait, "slurm status": slurm_status, "slurm cancel": slurm_cancel,
            "slurm requeue": slurm_requeue, "slurm task": slurm_task, "cluster up": cluster_up, "cluster down": cluster_down}
