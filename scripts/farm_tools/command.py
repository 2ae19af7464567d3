"""The command line of scripts/farm."""

import argparse
import fcntl
import os
import shutil
import signal
import sys
from pathlib import Path
from typing import List

from records import record, results

from . import catalogue, cluster, due, local, report, slurm
from .job import Job, JobError, read_list, with_needs

OUT = Path("build/farm")
ERRORS = (JobError, record.RecordError, slurm.SlurmError, cluster.ClusterError)


def add_choice(parser):
    parser.add_argument("--kind", action="append", metavar="KIND", help="only jobs of this kind and the builds that they need; "
                        "repeatable")
    parser.add_argument("--job", action="append", metavar="ID", help="only this job and the builds that it needs; repeatable")
    parser.add_argument("--quick", action="store_true", help="a sample of every kind of job instead of the whole list")
    parser.add_argument("--list", type=Path, metavar="FILE", help="a list of jobs of your own, in JSON, instead of the project's")


def add_out(parser, text="folder of results: JOB.json for each job, logs/JOB.log"):
    parser.add_argument("--out", type=Path, default=OUT, metavar="DIR", help=f"{text} (default {OUT})")


def arguments_of(argv):
    parser = argparse.ArgumentParser(prog="scripts/farm", description="Runs the project's long checks as jobs, here or under "
                                     "Slurm: docs/developer/farm.md. A run does only what is missing, did not pass or is older "
                                     "than its inputs. Exit status 1 when a job did not pass.")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    def command(name, text, function, into=commands):
        made = into.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
        made.set_defaults(function=function)
        return made

    listing = command("list", "list the jobs, the critical path, and the time that N workers need", show_list)
    add_choice(listing)
    listing.add_argument("--workers", type=int, action="append", metavar="N", help="for so many workers; repeatable")
    running = command("run", "run jobs on this machine", run)
    add_choice(running)
    add_out(running)
    running.add_argument("-j", "--workers", type=int, default=len(os.sched_getaffinity(0)), metavar="N",
                         help="jobs at once (default: as many as processors); builds run alone")
    merging = command("merge", "merge folders of results, of each job the newest verdict", merge)
    merging.add_argument("folders", nargs="+", type=Path, metavar="DIR")
    add_out(merging, "where the merged results go")
    reporting = command("report", "say what a folder of results holds", show_report)
    reporting.add_argument("folder", type=Path, metavar="DIR")
    expecting = command("expect", "take the measured seconds of a folder of results into the list", expect)
    expecting.add_argument("folder", type=Path, metavar="DIR")
    add_slurm(commands.add_parser("slurm", help="run jobs as Slurm job arrays", description="Runs jobs as Slurm job arrays. The "
                                  "checkout and the folder of results must be shared by all nodes."), command)
    add_cluster(commands.add_parser("cluster", help="a Slurm cluster of one node, for trying", description="Starts and ends a "
                                    "Slurm cluster of one node in a folder, for trying. Installs Slurm (Debian)."), command)
    return parser.parse_args(argv)


def add_slurm(parser, command):
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    submitting = command("submit", "submit what is due, each kind behind the builds that it needs", slurm_submit, actions)
    add_choice(submitting)
    add_out(submitting)
    submitting.add_argument("--partition", default="", metavar="NAME", help="Slurm's partition (default: the cluster's)")
    for name, text, function in (
            ("wait", "wait until all has ended", slurm_wait), ("status", "say how the jobs stand", slurm_status),
            ("cancel", "cancel what has not ended", slurm_cancel),
            ("requeue", "run again what did not pass, while Slurm still knows it", slurm_requeue),
            ("task", "run the job of this array's task; Slurm calls this", lambda a: slurm.task(a.out))):
        add_out(command(name, text, function, actions))


def add_cluster(parser, command):
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    starting = command("up", "start it and print the line that a shell needs to use it", cluster_up, actions)
    starting.add_argument("--processors", type=int, default=os.cpu_count(), metavar="N", help="jobs at once (default: all)")
    ending = command("down", "end it", lambda arguments: cluster.down(arguments.folder) or 0, actions)
    for each in (starting, ending):
        each.add_argument("folder", type=Path, metavar="DIR")


def chosen(arguments) -> List[Job]:
    """The jobs that the options name, with the builds that they need."""
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


def show_list(arguments) -> int:
    jobs = chosen(arguments)
    print(report.jobs_text(jobs), report.arithmetic_text(jobs, arguments.workers or report.WORKERS), sep="\n\n")
    return 0


def due_of(arguments):
    jobs, found = chosen(arguments), results.read_folder(arguments.out)
    todo = due.due(jobs, found)
    print(f"{len(todo)} of {len(jobs)} jobs are due", file=sys.stderr)
    return jobs, todo


def verdict(jobs: List[Job], folder: Path) -> int:
    """0 when each job has passed, now or before. A build that nothing asked for need not have run."""
    found = results.read_folder(folder)
    return 1 if due.due(jobs, found) else 0


def run(arguments) -> int:
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # ends the jobs, too
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
    print(f"seconds of {catalogue.measure(jobs, results.read_folder(arguments.folder))} jobs taken into {catalogue.EXPECTED}")
    return 0


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
    states = slurm.Submission(arguments.out).states()
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


def main(argv=None) -> int:
    arguments = arguments_of(argv)
    try:
        return arguments.function(arguments)
    except ERRORS as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
