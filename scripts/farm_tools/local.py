"""Runs jobs on this machine, several at a time."""

import sys
import threading
import time
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from pathlib import Path
from typing import Dict, List

from records import results

from . import plan
from .job import Job
from .run_job import Run


class Progress:
    """Reports the beginning and the end of jobs; on a terminal, the last line shows the remaining ones."""

    def __init__(self, jobs: List[Job], workers: int):
        self.waiting, self.workers = {job.id: job for job in jobs}, workers
        self.count = len(jobs)
        self.terminal = sys.stderr.isatty()
        self.lock = threading.Lock()

    def ended(self, job: Job, text: str):
        with self.lock:
            self.waiting.pop(job.id, None)
            done = self.count - len(self.waiting)
            left = plan.makespan(list(self.waiting.values()), self.workers)
            start = "\r\033[K" if self.terminal else ""
            print(f"{start}{done:4} of {self.count}  {job.id:32} {text}", file=sys.stderr, flush=True)
            if self.terminal and self.waiting:
                print(f"{len(self.waiting)} left, some {left / 60:.0f} minutes", end="", file=sys.stderr, flush=True)


class Machine:
    """Runs a list of jobs. stop() ends the running ones; a signal handler or another thread may call it."""

    def __init__(self, jobs: List[Job], folder: Path, workers: int):
        self.jobs, self.folder, self.workers = jobs, folder, workers
        self.order = plan.urgency(jobs)
        self.progress = Progress(jobs, workers)
        self.running: Dict[object, Run] = {}
        self.records: results.Records = {}
        self.stopped = False

    def stop(self):
        self.stopped = True
        runs = list(self.running.values())
        enders = [threading.Thread(target=run.cancel) for run in runs]
        for thread in enders:
            thread.start()
        for thread in enders:
            thread.join()

    def run(self) -> results.Records:
        """Runs the jobs and returns the records of those that ended. A job does not start unless all that it needs has
        passed."""
        waiting, unfinished = list(self.jobs), {job.id for job in self.jobs}
        with ThreadPoolExecutor(self.workers) as pool:
            try:
                while (waiting and not self.stopped) or self.running:
                    self._begin(pool, waiting, unfinished)
                    if self.running:
                        self._await(unfinished)
                    elif waiting:
                        break  # no job can start any more, because a build has failed
            except KeyboardInterrupt:
                self.stop()
                self._await_all(unfinished)
        self._say_what_is_left(waiting)
        return self.records

    def _say_what_is_left(self, waiting: List[Job]):
        """Prints the number of jobs that were not started, and the failed builds that they need."""
        failed = [job for job, entry in self.records.items() if entry["result"] != "passed" and any(
            job in each.needs for each in waiting)]
        if waiting:
            why = f": {', '.join(failed)} did not pass" if failed else ""
            print(f"{len(waiting)} jobs were not begun{why}", file=sys.stderr)

    def _begin(self, pool, waiting: List[Job], unfinished: set):
        for job in plan.ready(waiting, unfinished, self.order):
            # A build takes all processors, and two builds write into the same folders.
            alone = job.kind == "build" or any(run.job.kind == "build" for run in self.running.values())
            if self.stopped or len(self.running) >= self.workers or (alone and self.running):
                return
            waiting.remove(job)
            run = Run(job, self.folder)
            self.running[pool.submit(run.run)] = run

    def _await(self, unfinished: set):
        ended, _ = wait(list(self.running), return_when=FIRST_COMPLETED)
        for future in ended:
            job = self.running.pop(future).job
            entry = future.result()
            self.records[job.id] = entry
            if entry["result"] == "passed":
                unfinished.discard(job.id)
            self.progress.ended(job, f"{entry['result']:9} {entry['seconds']:8.1f} s" + where(entry, self.folder))

    def _await_all(self, unfinished: set):
        while self.running:
            self._await(unfinished)


def where(entry: dict, folder: Path) -> str:
    return "" if entry["result"] == "passed" else f"  log: {folder / entry['log']}"


def run(jobs: List[Job], folder: Path, workers: int) -> results.Records:
    begun = time.monotonic()
    machine = Machine(jobs, folder, workers)
    found = machine.run()
    passed = sum(entry["result"] == "passed" for entry in found.values())
    print(f"{passed} of {len(jobs)} jobs passed in {time.monotonic() - begun:.0f} s, {workers} at once", file=sys.stderr)
    return found
