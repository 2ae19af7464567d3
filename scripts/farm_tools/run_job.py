"""Runs one job and writes its record."""

import os
import subprocess
import threading
import time
from pathlib import Path
from typing import Optional

from records import counts, coverage, figures, identity, record, results

from . import processes
from .job import WORK, Job

ROOT = identity.ROOT
TIMEOUT_STATUS, CANCELLED_STATUS = 124, 130
# Removed from the environment, unless a job sets them.
UNSET = ("TRAMMEL_LONG", "TRAMMEL_SEED", "TRAMMEL_STATE_SEED", "TRAMMEL_MUTANT")


class Run:
    """One run of a job. cancel() may be called from another thread."""

    def __init__(self, job: Job, folder: Path):
        self.job, self.folder = job, folder.resolve()
        self.work = self.folder / "work" / job.id
        self.log = self.folder / "logs" / f"{job.id}.log"
        self.lock = threading.Lock()
        self.process: Optional[subprocess.Popen] = None
        self.why = ""  # reason for ending the job early: timeout or cancelled

    def cancel(self):
        self._end("cancelled")

    def _end(self, why: str):
        with self.lock:
            self.why = self.why or why
            process = self.process
        if process is not None:
            processes.end(process.pid)

    def run(self) -> dict:
        """Runs the job; returns its record and stores it in the folder."""
        identity.forget()
        begun, commit, clean, digest = identity.now(), identity.commit(), identity.is_clean(), inputs_of(self.job)
        start = time.monotonic()
        status, used = self._process()
        seconds = time.monotonic() - start
        result, status = self._verdict(status)
        entry = {
            "job": self.job.id, "kind": self.job.kind, "command": self.job.text(), "commit": commit,
            "clean": clean and identity.is_clean() and identity.commit() == commit,
            "inputs": digest, "begun": begun, "seconds": round(seconds, 3),
            "processor_seconds": round(used, 3), "result": result, "exit_status": status,
            "counts": self._counts(), "tools": identity.versions(self.job.tools), "machine": identity.machine(),
            "log": str(self.log.relative_to(self.folder)),
        }
        entry |= {name: found for name, found in self._figures().items() if found}
        results.store(self.folder, record.check(entry, self.job.id))
        return entry

    def _process(self):
        """Exit status, and the processor seconds of the process and of the children that it waited for."""
        self._prepare()
        command = [word.replace(WORK, str(self.work)) for word in self.job.command]
        environment = {name: value for name, value in os.environ.items() if name not in UNSET} | self.job.environment
        with self.log.open("w") as log:
            with self.lock:
                if self.why:
                    return CANCELLED_STATUS, 0.0
                try:
                    self.process = subprocess.Popen(command, cwd=ROOT, env=environment, stdin=subprocess.DEVNULL, stdout=log,
                                                    stderr=subprocess.STDOUT, start_new_session=True)
                except OSError as error:
                    log.write(f"error: {command[0]}: {error}\n")
                    return 127, 0.0
            watch = threading.Timer(self.job.time_limit(), self._end, ["timeout"])
            watch.start()
            _, status, usage = os.wait4(self.process.pid, 0)
            watch.cancel()
        self.process.returncode = os.waitstatus_to_exitcode(status)
        processes.end(self.process.pid)  # children that the job left running
        return self.process.returncode, usage.ru_utime + usage.ru_stime

    def _prepare(self):
        self.work.mkdir(parents=True, exist_ok=True)
        self.log.parent.mkdir(parents=True, exist_ok=True)
        if self.job.result_file:
            (self.work / self.job.result_file).unlink(missing_ok=True)
        if self.job.tests:
            # ctest writes its logs below its test folder, so each concurrent job needs its own.
            (self.work / "CTestTestfile.cmake").write_text(f'subdirs("{ROOT}/build/{self.job.tests}")\n')

    def _verdict(self, status: int):
        """Result and exit status; a signal counts as 128 plus its number, as in a shell."""
        if self.why:
            return self.why, TIMEOUT_STATUS if self.why == "timeout" else CANCELLED_STATUS
        status = status if status >= 0 else 128 - status
        return ("passed" if status == 0 else "failed"), status

    def _figures(self) -> dict:
        """Figures by module or by proof."""
        path = self.work / self.job.result_file
        return {"coverage": coverage.of_file(path) if path.name == "coverage.json" else {},
                "mutants": figures.mutants(path) if path.name == "results.csv" else {},
                "proofs": figures.proofs(self.log.read_text(errors="replace")) if self.job.kind == "proof" else {}}

    def _counts(self):
        found = counts.of_text(self.log.read_text(errors="replace"))
        return found | counts.of_file(self.work / self.job.result_file) if self.job.result_file else found


def inputs_of(job: Job) -> str:
    arguments = [*job.command, *(f"{name}={value}" for name, value in sorted(job.environment.items()))]
    return identity.inputs(job.inputs, arguments)
