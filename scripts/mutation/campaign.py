"""Tries every mutant of the RTL and lists those that no judge kills. Exit status 1 when one of them has no reason in
verif/mutation/equivalents. One build holds all mutants; each run is a process with the number of one mutant."""

import argparse
import csv
import hashlib
import json
import os
import sys
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import Dict, List, Tuple

from . import equivalents, judges

COLUMNS = ["id", "how", "judge", "seconds", "module", "file", "line", "kind", "nth", "original", "mutated"]


def shard_of(text: str) -> Tuple[int, int]:
    """K and N of "K/N"."""
    number, slash, count = text.partition("/")
    if not (slash and number.isdigit() and count.isdigit() and 1 <= int(number) <= int(count)):
        raise argparse.ArgumentTypeError(f"{text}: must be K/N with K from 1 to N")
    return int(number), int(count)


def arguments_of(argv):
    parser = argparse.ArgumentParser(prog="scripts/mutate", description=__doc__)
    parser.add_argument("--sample", type=int, metavar="N",
                        help="N mutants of blocks with a lockstep of their own, chosen at random, none of them listed as equivalent")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="of the random choice (default 1)")
    parser.add_argument("--shard", type=shard_of, metavar="K/N",
                        help="the K-th of N parts of equal length, in the order of files; a judge is first tried on the sound design "
                        "when a mutant needs it")
    parser.add_argument("--module", action="append", metavar="NAME", help="only mutants of this module; may be repeated")
    parser.add_argument("--list", action="store_true", help="list the mutants, try none")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)), metavar="N",
                        help="runs at a time (default: all cores that it may use)")
    parser.add_argument("--resume", action="store_true",
                        help="keep the verdicts of an interrupted run of the same build")
    places = parser.add_argument_group("places, for the tool's own test")
    places.add_argument("--mutants", type=Path, default=Path("build/release/mutation/rtl/mutants.json"))
    places.add_argument("--judges", type=Path, default=Path("build/release/mutation/judges.json"))
    places.add_argument("--equivalents", type=Path, default=Path("verif/mutation/equivalents"))
    places.add_argument("--out", type=Path, help="folder of results.csv (default build/mutation, a shard's its own in there)")
    arguments = parser.parse_args(argv)
    if arguments.out is None:
        arguments.out = Path("build/mutation")
        if arguments.shard:
            arguments.out /= "shard-{}-of-{}".format(*arguments.shard)
    return arguments


def chosen(mutants: List[dict], all_judges: List[judges.Judge], arguments, listed) -> List[dict]:
    if arguments.module:
        unknown = set(arguments.module) - {mutant["module"] for mutant in mutants}
        if unknown:
            sys.exit(f"mutate: no mutants of a module {', '.join(sorted(unknown))}")
        mutants = [mutant for mutant in mutants if mutant["module"] in arguments.module]
    if arguments.sample is not None and arguments.sample < len(mutants):
        # Drawn by id, so that a change of the RTL leaves the rest of the sample as it was. Listed mutants are left out,
        # because one that lives takes as long as twenty others. So are mutants of modules that only connect blocks,
        # because only locksteps of the whole card judge them.
        blocks = {file for judge in all_judges if judge.of_a_block() for file in judge.sources}
        mutants = [mutant for mutant in mutants if mutant["id"] not in listed and mutant["file"] in blocks]
        drawn = {mutant["id"]: hashlib.sha256(f"{arguments.seed} {mutant['id']}".encode()).digest() for mutant in mutants}
        mutants = sorted(mutants, key=lambda mutant: drawn[mutant["id"]])[:arguments.sample]
    if arguments.shard:
        # A shard takes neighbours: mutants of one file have the same judges, and a judge's run on the sound design
        # costs as much as many mutants.
        number, count = arguments.shard
        mutants = sorted(mutants, key=lambda mutant: (mutant["file"], mutant["number"]))
        mutants = mutants[len(mutants) * (number - 1) // count:len(mutants) * number // count]
    return mutants


class Results:
    """results.csv; a row is written as soon as there is a verdict."""

    def __init__(self, folder: Path, build: str, resume: bool):
        folder.mkdir(parents=True, exist_ok=True)
        self.path = folder / "results.csv"
        stamp = folder / "results.build"
        self.rows: Dict[str, dict] = {}
        if resume and self.path.exists() and stamp.exists() and stamp.read_text() == build:
            with self.path.open(newline="") as file:
                self.rows = {row["id"]: row for row in csv.DictReader(file) if row["mutated"] is not None}
        self.file = self.path.open("w", newline="")
        self.writer = csv.DictWriter(self.file, COLUMNS)
        self.writer.writeheader()
        for row in self.rows.values():
            self.writer.writerow(row)
        self.file.flush()
        stamp.write_text(build)

    def add(self, mutant: dict, verdict: judges.Verdict):
        row = {key: mutant[key] for key in COLUMNS if key in mutant}
        row.update(how=verdict.how, judge=verdict.judge, seconds=f"{verdict.seconds:.2f}")
        self.rows[mutant["id"]] = row
        self.writer.writerow(row)
        self.file.flush()

    def how(self, mutant: dict) -> str:
        return self.rows[mutant["id"]]["how"]


class Progress:
    def __init__(self, total: int):
        self.total, self.done, self.lived = total, 0, 0
        self.start = self.last = time.monotonic()

    def step(self, lived: bool):
        self.done += 1
        self.lived += lived
        now = time.monotonic()
        terminal = sys.stderr.isatty()
        if self.done == self.total or now - self.last > (0.2 if terminal else 30):
            self.last = now
            begin = "\r" if terminal else ""
            end = "\n" if not terminal or self.done == self.total else ""
            left = (now - self.start) / self.done * (self.total - self.done)
            print(f"{begin}{self.done} of {self.total} mutants, {self.lived} lived, {left:.0f} s left ",
                  end=end, file=sys.stderr, flush=True)


def try_all(mutants, all_judges, results, listed, jobs):
    waiting = [mutant for mutant in mutants if mutant["id"] not in results.rows]
    progress = Progress(len(waiting))
    with ThreadPoolExecutor(jobs) as pool:
        runs = {pool.submit(judges.try_mutant, all_judges, m["number"], m["file"], m["id"] in listed): m for m in waiting}
        try:
            for run in as_completed(runs):
                results.add(runs[run], run.result())
                progress.step(not run.result().killed)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def show(mutant: dict) -> str:
    mutated = mutant["mutated"] or "(dropped)"
    nth = f"  (number {mutant['nth']} of these)" if mutant["nth"] > 1 else ""
    return f"rtl/{mutant['file']}:{mutant['line']}: {mutant['kind']}{nth}\n    {mutant['original']}\n    {mutated}"


def report(mutants, results, listed) -> int:
    """Prints the summary; returns the number of findings."""
    lived = [mutant for mutant in mutants if results.how(mutant) == "lived"]
    unlisted = [mutant for mutant in lived if mutant["id"] not in listed]
    wrong = [mutant for mutant in mutants if mutant["id"] in listed and results.how(mutant) != "lived"]
    for mutant in sorted(unlisted, key=lambda m: (m["file"], m["line"], m["number"])):
        print(f"LIVES {show(mutant)}")
    for mutant in wrong:
        print(f"KILLED, though listed as equivalent: {show(mutant)}\n    reason given: {listed[mutant['id']].reason}")
    how = Counter(results.how(mutant) for mutant in mutants)
    print(f"\n{len(mutants)} mutants: " + ", ".join(f"{how[key]} {key}" for key in
                                                    ("mismatch", "failed", "crashed", "timed out", "lived") if how[key]))
    print(f"of those that lived {len(lived) - len(unlisted)} are listed as equivalent, {len(unlisted)} are not")
    modules = Counter(mutant["module"] for mutant in mutants)
    live_by_module = Counter(mutant["module"] for mutant in unlisted)
    for module, count in sorted(live_by_module.items(), key=lambda item: (-item[1], item[0])):
        print(f"  {module:24} {count:4} of {modules[module]:4} live")
    return len(unlisted) + len(wrong)


def main(argv=None) -> int:
    arguments = arguments_of(argv)
    mutants = json.loads(arguments.mutants.read_text())
    try:
        listed = equivalents.by_mutant(equivalents.read(arguments.equivalents), mutants)
    except equivalents.EquivalentsError as error:
        sys.exit(f"mutate: {error}")
    all_judges = judges.read_judges(arguments.judges)
    mutants = chosen(mutants, all_judges, arguments, listed)
    if arguments.list:
        for mutant in mutants:
            print(show(mutant))
        return 0
    files = {mutant["file"] for mutant in mutants}
    all_judges = [judge for judge in all_judges if files & set(judge.sources)]
    results = Results(arguments.out, judges.fingerprint(all_judges), arguments.resume)
    try:
        at_once = [] if arguments.shard else [judge for judge in all_judges if not judge.last_resort]
        with ThreadPoolExecutor(arguments.jobs) as pool:
            list(pool.map(judges.try_sound_design, at_once))
    except judges.SoundDesignRefused as error:
        sys.exit(f"mutate: {error}")
    start = time.monotonic()
    try:
        try_all(mutants, all_judges, results, listed, arguments.jobs)
    except judges.SoundDesignRefused as error:
        sys.exit(f"mutate: {error}")
    findings = report(mutants, results, listed)
    print(f"{time.monotonic() - start:.0f} s with {arguments.jobs} runs at a time; verdicts in {results.path}")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
