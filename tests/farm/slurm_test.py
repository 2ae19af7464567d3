#!/usr/bin/env python3
"""The farm under a real Slurm cluster of one node, which the test starts and ends: submission, failures, requeueing,
cancelling, time-outs, a failing build, merging. Installs Slurm if it is missing (Debian). scripts/test --long farm runs
it; it takes some minutes."""
import os
import shlex
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from support import SCRIPTS, processes_with

from farm_tools import cluster, job  # noqa: E402
from records import results  # noqa: E402

FARM = SCRIPTS / "farm"


class UnderSlurm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(holder.cleanup)
        cls.folder = Path(holder.name)
        cls.folder.chmod(0o755)  # munged requires that all users can enter its socket's folder
        cls.begun = time.monotonic()
        line = subprocess.run([FARM, "cluster", "up", cls.folder / "cluster", "--processors", "2"], check=True,
                              stdout=subprocess.PIPE, text=True).stdout.splitlines()[-1]
        cls.addClassCleanup(subprocess.run, [FARM, "cluster", "down", cls.folder / "cluster"], check=True)
        os.environ["SLURM_CONF"] = shlex.split(line)[1].partition("=")[2]
        print(f"cluster up in {time.monotonic() - cls.begun:.1f} s", flush=True)

    def setUp(self):
        self.out = self.folder / self.id().rpartition(".")[2]
        self.begun = time.monotonic()
        self.addCleanup(lambda: print(f"{self.out.name}: {time.monotonic() - self.begun:.1f} s", flush=True))

    def farm(self, *arguments):
        done = subprocess.run([FARM, *arguments, "--out", self.out], capture_output=True, text=True, timeout=300)
        self.said = done.stdout + done.stderr
        return done.returncode

    def submit(self, *jobs):
        job.write_list(self.folder / "jobs.json", jobs)
        self.assertEqual(self.farm("slurm", "submit", "--list", self.folder / "jobs.json"), 0, "see below")

    def shell(self, name, script, **fields):
        return job.Job(name, fields.pop("kind", "program"), ("bash", "-c", script), **{"limit": 60, "seconds": 1.0, **fields})

    def found(self):
        return {name: entry["result"] for name, entry in results.read_folder(self.out).items()}

    def await_true(self, what, text, seconds=60):
        until = time.monotonic() + seconds
        while not what():
            self.assertLess(time.monotonic(), until, text)
            time.sleep(0.2)

    def test_builds_come_first_one_fails_and_is_requeued(self):
        built, mended = self.folder / "built", self.folder / "mended"
        build = self.shell("build-all", f"sleep 2; touch {built}", kind="build", products=(str(built),))
        jobs = [self.shell(f"job-{number}", f"test -e {built}", needs=("build-all",)) for number in range(6)]
        jobs.append(self.shell("sometimes", f"test -e {mended}", kind="proof", needs=("build-all",)))
        self.submit(build, *jobs)
        self.assertEqual(self.farm("slurm", "wait"), 1, self.said)
        self.assertEqual(self.found(), {"build-all": "passed", **{f"job-{number}": "passed" for number in range(6)},
                                        "sometimes": "failed"})
        self.assertIn("1 failed: sometimes", self.said)
        mended.touch()
        self.farm("slurm", "requeue")
        self.assertIn("1 jobs run again: sometimes", self.said)
        self.assertEqual(self.farm("slurm", "wait"), 0, self.said)
        self.assertEqual(self.found()["sometimes"], "passed")
        # No job is due any more.
        self.submit(build, *jobs)
        self.assertIn("0 of 8 jobs are due", self.said)
        # One job is due, and the build that it needs exists.
        (self.out / "job-3.json").unlink()
        self.submit(build, *jobs)
        self.assertEqual(self.farm("slurm", "wait"), 0, self.said)
        self.assertEqual(self.found()["job-3"], "passed")

    def test_a_job_that_runs_out_of_time_leaves_a_record_and_no_process(self):
        marker = f"6{os.getpid()}"
        self.submit(self.shell("long", f"sleep {marker} & sleep {marker}", limit=2), self.shell("short", "true"))
        self.assertEqual(self.farm("slurm", "wait"), 1, self.said)
        self.assertEqual(self.found(), {"long": "timeout", "short": "passed"})
        self.assertEqual(processes_with(f"sleep\0{marker}"), [])

    def test_cancel_ends_what_runs_and_what_waits(self):
        marker = f"5{os.getpid()}"
        self.submit(*(self.shell(f"job-{number}", f"sleep {marker}") for number in range(4)))
        self.await_true(lambda: len(processes_with(f"sleep\0{marker}")) >= 2, "two jobs run")
        self.assertNotEqual(self.farm("slurm", "submit", "--list", self.folder / "jobs.json"), 0)
        self.assertIn("under way", self.said)
        self.assertEqual(self.farm("slurm", "cancel"), 0, self.said)
        self.assertEqual(self.farm("slurm", "wait"), 1, self.said)
        self.assertEqual(sorted(self.found().values()), ["cancelled", "cancelled"])
        self.assertEqual(processes_with(f"sleep\0{marker}"), [])

    def test_behind_a_build_that_fails_nothing_runs(self):
        self.submit(self.shell("build-all", "false", kind="build"), self.shell("job", "true", needs=("build-all",)))
        self.assertEqual(self.farm("slurm", "wait"), 1, self.said)
        self.assertEqual(self.found(), {"build-all": "failed"})

    def test_results_of_two_submissions_merge(self):
        first, second, both = (self.folder / name for name in ("first", "second", "both"))
        for self.out, names in ((first, "ab"), (second, "bc")):
            self.submit(*(self.shell(name, "true") for name in names))
            self.assertEqual(self.farm("slurm", "wait"), 0, self.said)
        self.out = both
        self.assertEqual(self.farm("merge", first, second), 0, self.said)
        self.assertEqual(self.found(), {"a": "passed", "b": "passed", "c": "passed"})
        self.assertEqual(results.read_folder(both)["b"], results.read_folder(second)["b"])
        self.assertTrue((both / "logs" / "a.log").exists())


if __name__ == "__main__":
    unittest.main(verbosity=2)
