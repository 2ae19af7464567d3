"""Code that the tests of records and farm share."""
import os
import random
import sys
import tempfile
import unittest
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
# seeded_bugs.py runs the tests on a copy of the scripts with an error.
SCRIPTS = Path(os.environ.get("FARM_TEST_SCRIPTS", PROJECT / "scripts"))
sys.path.insert(0, str(SCRIPTS))
sys.dont_write_bytecode = True


def a_record(job="proof-axis", **changes):
    """A valid record with these fields changed."""
    return {"job": job, "kind": "proof", "command": "scripts/prove axis", "commit": "0123456789" * 4, "clean": True,
            "inputs": "ab" * 32, "begun": "2026-11-28T20:47:02.123Z", "seconds": 12.5, "processor_seconds": 11.0,
            "result": "passed", "exit_status": 0, "counts": {"proof_runs": 3}, "tools": {"yosys": "0.23"},
            "machine": {"processors": 2, "architecture": "x86_64"}, "log": f"logs/{job}.log", **changes}


def random_records(draw: random.Random):
    """A folder's records, with few different jobs and times, so that many of them collide."""
    found = {}
    for job in draw.sample(["a", "b", "c", "d"], draw.randint(0, 4)):
        result = draw.choice(["passed", "failed", "timeout", "cancelled"])
        found[job] = a_record(job, result=result, exit_status=0 if result == "passed" else draw.choice([1, 2]),
                              begun=f"2026-11-28T20:47:0{draw.randint(0, 2)}.000Z", seconds=draw.randint(0, 2))
    return found


def processes_with(text):
    """Processes whose command line has the text."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if text.encode() in path.read_bytes() and int(path.parent.name) != os.getpid():
                found.append(int(path.parent.name))
        except OSError:
            pass
    return found


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
