"""The whole list of jobs, and the quick one. A new kind of job needs a function in LISTS and a sample in samples()."""

import json
from pathlib import Path
from typing import Dict, List

from records import record, results

from . import hardware, tested
from .job import Job, check, with_seconds

EXPECTED = Path(__file__).with_name("expected.json")
LISTS = (tested.builds, hardware.tools, tested.locksteps, hardware.mutations, hardware.proofs, hardware.placements,
         tested.soaks, tested.fuzzers, tested.programs, tested.sanitizers, tested.coverages)


def samples() -> List[Job]:
    """One or two short jobs of every kind, with the builds that they need: a sample of the long ones."""
    long_builds = ("build-mutation", "build-dev", "build-coverage", "build-coverage-toggle")
    jobs = [job for job in (*tested.builds(), *hardware.tools()) if job.id not in long_builds]
    blocks = "^lockstep[.](feed_generator|arc_generator|motion_core_4)[.].*Random"
    jobs += [tested.ctest("quick-lockstep", "lockstep", "release", "-R", blocks, inputs=tested.LOCKSTEP, TRAMMEL_SEED="7",
                          TRAMMEL_LONG="4"),
             hardware.mutation("quick-mutation", 1, 8, "--module", "feed_generator", "--judges",
                               "build/release/mutation/sample_judges.json", build="mutation-sample"),
             hardware.proof("frame_sender", "quick-proof"),
             hardware.netlist("hx8k-axis"),
             hardware.placement("hx8k-axis", 1, "quick-placement"),
             tested.soak("quick-soak", 7, "10"),
             tested.fuzzer("quick-fuzz", "gcode", 99, 30),
             tested.sanitizer_sample(), tested.coverage_sample()]
    if tested.has_programs():
        jobs.append(tested.program("arc-yz-plane", "quick-program", long_run=False))
    return jobs


def expected() -> Dict[str, float]:
    return json.loads(EXPECTED.read_text()) if EXPECTED.exists() else {}


def whole() -> List[Job]:
    return check(with_seconds((job for each in LISTS for job in each()), expected()))


def quick() -> List[Job]:
    return check(with_seconds(samples(), expected()))


def measure(jobs: List[Job], found: results.Records, field: str) -> int:
    """Writes the seconds of passed jobs, from this field of their records, to the data file, and removes jobs that no
    longer exist. Fuzzers are left out, because their time is given. Returns the number of jobs measured."""
    known = {name: seconds for name, seconds in expected().items() if name in {job.id for job in jobs}}
    new = {job.id: round(found[job.id][field], 1) for job in jobs
           if job.id in found and found[job.id]["result"] == "passed" and job.kind != "fuzz"}
    record.write_text(EXPECTED, json.dumps({**known, **new}, indent=1, sort_keys=True) + "\n")
    return len(new)
