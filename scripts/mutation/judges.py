"""Judges: test executables that pass on the sound design. Each run is a process with the number of one mutant."""

import hashlib
import json
import math
import os
import re
import resource
import subprocess
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Dict, List, Optional

MISMATCH = "repeat with TRAMMEL_SEED="  # text in every mismatch report of a lockstep
BLOCK_SOURCES = 20  # a block's lockstep reads at most this many; the motion core's reads more than twice as many
TESTS_PASSED = re.compile(r"\[  PASSED  \] [1-9]")  # a filter that matches no test passes as well


class SoundDesignRefused(Exception):
    """A judge fails on mutant 0, the sound design."""


@dataclass
class Judge:
    name: str
    executable: str
    sources: List[str]  # relative to the folder of the RTL
    arguments: List[str] = field(default_factory=list)  # GoogleTest options that select tests
    length: str = ""  # factor for the length of random scenarios: TRAMMEL_LONG
    last_resort: bool = False  # a long run, which is not tried on mutants listed as equivalent
    seconds: Optional[float] = None  # processor time of the run on the sound design
    first: threading.Lock = field(default_factory=threading.Lock)

    def of_a_block(self) -> bool:
        return len(self.sources) <= BLOCK_SOURCES

    def limit(self) -> int:
        """Processor seconds after which a run counts as hung; unlike wall-clock time, they do not depend on the
        machine's load."""
        with self.first:
            if self.seconds is None:  # the first use of a last resort
                try_sound_design(self)
        return math.ceil(5 * self.seconds + 2)


@dataclass
class Verdict:
    how: str  # lived, mismatch, failed, crashed, timed out
    judge: str = ""
    seconds: float = 0.0
    processor_seconds: float = 0.0

    @property
    def killed(self) -> bool:
        return self.how != "lived"


def read_judges(path: Path) -> List[Judge]:
    """Judges with few sources come first, because they are fast and find most mutants of these sources. Equal ones keep
    the order of the file; last resorts come last."""
    judges = [Judge(**entry) for entry in json.loads(path.read_text())]
    return sorted(judges, key=lambda judge: (judge.last_resort, len(judge.sources)))


def fingerprint(judges: List[Judge]) -> str:
    """A hash over everything that can change a verdict."""
    digest = hashlib.sha256()
    for judge in judges:
        digest.update(f"{judge.name} {judge.arguments} {judge.length}".encode() + Path(judge.executable).read_bytes())
    return digest.hexdigest()


def run(judge: Judge, number: int, limit: int) -> Verdict:
    def limits():
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 1))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    environment: Dict[str, str] = {**os.environ, "TRAMMEL_MUTANT": str(number)}
    environment.pop("TRAMMEL_LONG", None)
    if judge.length:
        environment["TRAMMEL_LONG"] = judge.length
    start = time.monotonic()
    process = subprocess.Popen([judge.executable, "--gtest_fail_fast", "--gtest_brief=1", *judge.arguments],
                               env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, preexec_fn=limits,
                               errors="replace")
    # A process that sleeps uses no processor time, so it is killed after ten times the limit in real time.
    watch = threading.Timer(10 * limit, process.kill)
    watch.start()
    with process.stdout:
        output = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    watch.cancel()
    process.returncode = os.waitstatus_to_exitcode(status)
    return Verdict(judged(process.returncode, output), judge.name, time.monotonic() - start,
                   usage.ru_utime + usage.ru_stime)


def judged(status: int, output: str) -> str:
    if status == 0:
        return "lived" if TESTS_PASSED.search(output) else "failed"
    if -status in (24, 9):  # SIGXCPU; SIGKILL a second later
        return "timed out"
    if MISMATCH in output:
        return "mismatch"
    return "failed" if status == 1 else "crashed"


def try_sound_design(judge: Judge):
    """Mutant 0 must pass; its time determines the limit for the others."""
    verdict = run(judge, 0, 3600)
    if verdict.killed:
        raise SoundDesignRefused(f"judge {judge.name} finds fault with the sound design ({verdict.how}): "
                                 f"TRAMMEL_MUTANT=0 {judge.executable}")
    judge.seconds = verdict.processor_seconds


def try_mutant(judges: List[Judge], number: int, file: str, listed: bool) -> Verdict:
    """The verdict of the first judge that kills the mutant; "lived" when none does."""
    seconds = 0.0
    for judge in judges:
        if file not in judge.sources or (listed and judge.last_resort):
            continue
        verdict = run(judge, number, judge.limit())
        seconds += verdict.seconds
        if verdict.killed:
            return Verdict(verdict.how, judge.name, seconds)
    return Verdict("lived", "", seconds)
