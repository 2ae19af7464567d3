#!/usr/bin/env python3
"""The farm on this machine: reruns, time-outs, failures, Ctrl-C, arithmetic, the quick sample. seeded_bugs.py lists the
error that each test finds."""
import contextlib
import io
import json
import os
import signal
import subprocess
import sys
import time
import unittest
from unittest import mock

from support import SCRIPTS, InAFolder, processes_with

from farm_tools import catalogue, command, due, job, plan  # noqa: E402
from records import results  # noqa: E402

Job = job.Job


def shell(name, script, **fields):
    """A job that runs a shell command."""
    return Job(name, fields.pop("kind", "program"), ("bash", "-c", script), **{"seconds": 1.0, "limit": 60, **fields})


class OnThisMachine(InAFolder):
    def setUp(self):
        super().setUp()
        self.out, self.list = self.folder / "out", self.folder / "jobs.json"

    def farm(self, *jobs, options=()):
        """The exit status of a run of the jobs; self.said has the output."""
        job.write_list(self.list, jobs)
        said = io.StringIO()
        handler = signal.getsignal(signal.SIGTERM)
        with contextlib.redirect_stderr(said):
            status = command.main(["run", "--list", str(self.list), "--out", str(self.out), "-j", "2", *options])
        signal.signal(signal.SIGTERM, handler)
        self.said = said.getvalue()
        return status

    def found(self):
        return {name: entry["result"] for name, entry in results.read_folder(self.out).items()}

    def marker(self):
        """A number of seconds that no other process sleeps. Processes that sleep so long are ended with the test."""
        text = f"7{os.getpid()}{self.id().count('t')}"
        self.addCleanup(lambda: [os.kill(process, signal.SIGKILL) for process in processes_with(f"sleep\0{text}")])
        return text

    def runs(self, name):
        """The number of runs of a job of counting()."""
        path = self.folder / name
        return len(path.read_text()) if path.exists() else 0

    def counting(self, name, **fields):
        return shell(name, f"printf x >>{self.folder}/{name}", **fields)

    def test_a_rerun_does_only_what_is_needed(self):
        product = self.folder / "product"
        build = shell("build-all", f"printf x >>{self.folder}/build-all; touch {product}", kind="build", products=(str(product),))
        jobs = [build, *(self.counting(name, needs=("build-all",)) for name in "abc")]
        self.assertEqual(self.farm(*jobs), 0)
        self.assertEqual(self.farm(*jobs), 0)
        self.assertEqual([self.runs(name) for name in ("build-all", "a", "b", "c")], [1, 1, 1, 1])
        (self.out / "b.json").unlink()
        changed = self.counting("c", needs=("build-all",), environment={"TRAMMEL_SEED": "2"})
        self.assertEqual(self.farm(*jobs[:3], changed), 0)
        self.assertEqual([self.runs(name) for name in ("build-all", "a", "b", "c")], [1, 1, 2, 2])
        product.unlink()
        (self.out / "a.json").unlink()
        self.assertEqual(self.farm(*jobs[:3], changed), 0)
        self.assertEqual([self.runs(name) for name in ("build-all", "a", "b", "c")], [2, 2, 2, 2])

    def test_builds_alone_are_run_with_what_they_need(self):
        first = shell("build-a", f"printf x >>{self.folder}/build-a", kind="build")
        second = shell("build-b", f"test -e {self.folder}/build-a", kind="build", needs=("build-a",))
        self.assertEqual(self.farm(first, second), 0)
        self.assertEqual(self.runs("build-a"), 1)

    def test_changed_inputs_and_failures_are_due(self):
        tried = self.counting("a", inputs=("scripts/farm",))
        self.farm(tried)
        found = results.read_folder(self.out)
        self.assertEqual(due.why(tried, found), "")
        found["a"]["inputs"] = "0" * 64
        self.assertEqual(due.why(tried, found), "older than its inputs")
        for result in ("failed", "timeout", "cancelled"):
            found["a"]["result"] = result
            self.assertEqual(due.why(tried, found), result)

    def test_a_time_out_ends_the_job_and_its_children(self):
        marker = self.marker()
        # One child in its own process group, and one that ignores the first signal.
        script = f"set -m; sleep {marker}.1 & (trap '' TERM; sleep {marker}.2) & sleep {marker}.3"
        begun = time.monotonic()
        with mock.patch("farm_tools.processes.GRACE", 0.5):
            self.assertEqual(self.farm(shell("long", script, limit=1)), 1)
        self.assertLess(time.monotonic() - begun, 8)
        self.assertEqual(self.found(), {"long": "timeout"})
        self.assertEqual(processes_with(marker), [])

    def test_a_failing_job_makes_the_exit_status_1(self):
        self.assertEqual(self.farm(shell("bad", "exit 3"), shell("good", "true")), 1)
        self.assertEqual(self.found(), {"bad": "failed", "good": "passed"})
        self.assertEqual(results.read_folder(self.out)["bad"]["exit_status"], 3)
        self.assertEqual(self.farm(shell("missing", "true", kind="proof"), Job("none", "proof", ("/nonexistent",))), 1)

    def test_nothing_begins_behind_a_build_that_failed(self):
        self.assertEqual(self.farm(shell("build-all", "false", kind="build"), self.counting("a", needs=("build-all",))), 1)
        self.assertEqual((self.found(), self.runs("a")), ({"build-all": "failed"}, 0))
        self.assertIn("1 jobs were not begun: build-all did not pass", self.said)

    def test_processor_seconds_are_those_of_the_children(self):
        burn = "import time\nwhile time.process_time() < 0.4: pass"
        self.farm(Job("burn", "program", ("sh", "-c", f"{sys.executable} -c '{burn}'; sleep 0.3"), limit=60))
        entry = results.read_folder(self.out)["burn"]
        self.assertGreater(entry["processor_seconds"], 0.39)
        self.assertGreater(entry["seconds"], entry["processor_seconds"])

    def test_ctrl_c_ends_the_children_and_leaves_what_had_ended(self):
        marker = self.marker()
        job.write_list(self.list, [shell("build-a", "true", kind="build"), shell("slow", f"sleep {marker}", needs=("build-a",), limit=10)])
        farm = subprocess.Popen([SCRIPTS / "farm", "run", "--list", self.list, "--out", self.out, "-j", "2"],
                                stderr=subprocess.DEVNULL)
        until = time.monotonic() + 20
        while not processes_with(marker) and time.monotonic() < until:
            time.sleep(0.05)
        self.assertNotEqual(self.farm(shell("other", "true")), 0)
        self.assertIn("another scripts/farm run", self.said)
        farm.send_signal(signal.SIGINT)
        self.assertEqual(farm.wait(20), 1)
        self.assertEqual(processes_with(marker), [])
        self.assertEqual(self.found(), {"build-a": "passed", "slow": "cancelled"})

    def test_lists_that_cannot_be_run_are_refused(self):
        for jobs, text in (([shell("a", "true"), shell("a", "true")], "twice"),
                           ([shell("a", "true", needs=("b",))], "needs b"),
                           ([shell("a", "true", needs=("b",)), shell("b", "true", needs=("a",))], "need each other"),
                           ([shell("a/b", "true")], "id or kind")):
            self.assertEqual(self.farm(*jobs), 1)
            self.assertIn(text, self.said)
        self.assertEqual(self.farm(shell("a", "true"), options=("--job", "b")), 1)
        self.assertIn("no kind or job b", self.said)


class Arithmetic(unittest.TestCase):
    JOBS = [Job("z0", "build", (), seconds=10), Job("build-a", "build", (), seconds=100), Job("build-b", "build", (), needs=("build-a",), seconds=50),
            Job("x", "proof", (), needs=("build-a",), seconds=200), Job("y", "proof", (), needs=("build-b", "z0"), seconds=160),
            *(Job(f"z{number}", "proof", (), seconds=10) for number in range(1, 4))]

    def test_total_and_critical_path(self):
        self.assertEqual(plan.total(self.JOBS), 550)
        self.assertEqual(plan.critical_path(self.JOBS), (310, ["build-a", "build-b", "y"]))
        self.assertEqual(plan.critical_path([]), (0.0, []))

    def test_time_of_n_workers(self):
        self.assertEqual(plan.makespan(self.JOBS, 1), 550)
        # Two workers: build-a parallel to z0; build-b parallel to x; y after build-b.
        self.assertEqual(plan.makespan(self.JOBS, 2), 310)
        self.assertEqual(plan.makespan(self.JOBS, 50), 310)
        self.assertEqual(plan.makespan([Job(name, "proof", (), seconds=20 if name == "a" else 10) for name in "abcd"], 2), 30)
        self.assertEqual(plan.urgency(self.JOBS)["build-a"], 310)

    def test_exceptions_are_the_short_and_the_long(self):
        jobs = [Job("a", "proof", (), seconds=19), Job("b", "proof", (), seconds=20), Job("c", "proof", (), seconds=900),
                Job("d", "proof", (), seconds=901), Job("build-e", "build", (), seconds=5)]
        self.assertEqual([each.id for each in plan.exceptions(jobs)], ["a", "d"])


class Catalogue(unittest.TestCase):
    def test_the_quick_sample_has_every_kind(self):
        whole, quick = catalogue.whole(), catalogue.quick()
        self.assertEqual({each.kind for each in quick}, {each.kind for each in whole})
        spent = sum(each.seconds for each in quick if each.kind != "build")
        self.assertLess(spent, 600)

    def test_seeds_and_shards_differ(self):
        whole = catalogue.whole()
        texts = [each.text() for each in whole]
        self.assertEqual(len(set(texts)), len(texts))
        self.assertGreater(len([each for each in whole if each.kind == "mutation"]), 10)

    def test_measured_seconds_replace_the_guess(self):
        tried = job.with_seconds([Job("a", "proof", ()), Job("b", "proof", ())], {"b": 33.0})
        self.assertEqual([(each.seconds, each.measured) for each in tried], [(job.GUESS, False), (33.0, True)])

    def test_expected_seconds_are_of_jobs_that_there_are(self):
        known = {each.id for each in (*catalogue.whole(), *catalogue.quick())}
        self.assertLessEqual(set(json.loads(catalogue.EXPECTED.read_text())), known)


if __name__ == "__main__":
    unittest.main()
