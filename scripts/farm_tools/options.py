"""The options of scripts/farm. The field `name` of the result is the command, "slurm submit" for instance."""

import argparse
import os
from pathlib import Path

OUT = Path("build/farm")


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

    def command(name, text, into=commands, group=""):
        made = into.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
        made.set_defaults(name=group + name)
        return made

    listing = command("list", "list the jobs, the critical path, and the time that N workers need")
    add_choice(listing)
    listing.add_argument("--workers", type=int, action="append", metavar="N", help="for so many workers; repeatable")
    running = command("run", "run jobs on this machine")
    add_choice(running)
    add_out(running)
    running.add_argument("-j", "--workers", type=int, default=len(os.sched_getaffinity(0)), metavar="N",
                         help="jobs at once (default: as many as processors); builds run alone")
    merging = command("merge", "merge folders of results, of each job the newest verdict")
    merging.add_argument("folders", nargs="+", type=Path, metavar="DIR")
    add_out(merging, "where the merged results go")
    reporting = command("report", "say what a folder of results holds")
    reporting.add_argument("folder", type=Path, metavar="DIR")
    expecting = command("expect", "take the measured seconds of a folder of results into the list")
    expecting.add_argument("folder", type=Path, metavar="DIR")
    expecting.add_argument("--processor", dest="field", action="store_const", const="processor_seconds", default="seconds",
                           help="take processor seconds: for results of a machine that had other work")
    add_slurm(commands.add_parser("slurm", help="run jobs as Slurm job arrays", description="Runs jobs as Slurm job arrays. The "
                                  "checkout and the folder of results must be shared by all nodes."), command)
    add_cluster(commands.add_parser("cluster", help="a Slurm cluster of one node, for trying", description="Starts and ends a "
                                    "Slurm cluster of one node in a folder, for trying. Installs Slurm (Debian)."), command)
    return parser.parse_args(argv)


def add_slurm(parser, command):
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    submitting = command("submit", "submit what is due, each kind behind the builds that it needs", actions, "slurm ")
    add_choice(submitting)
    add_out(submitting)
    submitting.add_argument("--partition", default="", metavar="NAME", help="Slurm's partition (default: the cluster's)")
    for name, text in (("wait", "wait until all has ended"), ("status", "say how the jobs stand"),
                       ("cancel", "cancel what has not ended"),
                       ("requeue", "run again what did not pass, while Slurm still knows it"),
                       ("task", "run the job of this array's task; Slurm calls this")):
        add_out(command(name, text, actions, "slurm "))


def add_cluster(parser, command):
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    starting = command("up", "start it and print the line that a shell needs to use it", actions, "cluster ")
    starting.add_argument("--processors", type=int, default=os.cpu_count(), metavar="N", help="jobs at once (default: all)")
    ending = command("down", "end it", actions, "cluster ")
    for each in (starting, ending):
        each.add_argument("folder", type=Path, metavar="DIR")
