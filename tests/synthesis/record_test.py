#!/usr/bin/env python3
"""scripts/synthesise --record: which measurements of --check it writes to boards/results, and which it refuses. Seen to
fail: with measurements of other or uncommitted RTL taken, with an older one preferred, with the other builds' records
lost, with only one device written."""
import importlib.util
import json
import pathlib
import sys
import tempfile
import unittest
from importlib.machinery import SourceFileLoader
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
sys.dont_write_bytecode = True
loader = SourceFileLoader("synthesise", str(ROOT / "scripts" / "synthesise"))
synthesise = importlib.util.module_from_spec(importlib.util.spec_from_loader("synthesise", loader))
sys.modules["synthesise"] = synthesise  # its data classes look for their module there
loader.exec_module(synthesise)


def measured(area, rtl="0123abc"):
    return {"tools": "Yosys 1; nextpnr 2", "seeds": [1, 2, 3], "synthesis": "synth", "area": area, "wrapper": 10, "memory": 4,
            "fmax_mhz": [80.0, 81.0, 82.0], "median_fmax_mhz": 81.0, "rtl": rtl}


class Record(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.results = pathlib.Path(folder.name)
        for name, value in (("RESULTS", self.results), ("CHECKED", self.results / "checked.json"), ("rtl_commit", lambda: "0123abc")):
            patch = mock.patch.object(synthesise, name, value)
            patch.start()
            self.addCleanup(patch.stop)

    def record(self):
        """What --record says when it ends; None when it has written."""
        try:
            return synthesise.write_results(synthesise.checked())
        except SystemExit as end:
            return str(end)

    def builds(self, device):
        return json.loads((self.results / f"{device}.json").read_text())["builds"]

    def test_without_a_measurement_says_what_to_run(self):
        self.assertIn("run scripts/synthesise --check first", self.record())

    def test_writes_what_two_runs_have_measured_for_both_devices(self):
        synthesise.keep_checked({"hx8k-card": measured(6700)})
        synthesise.keep_checked({"ecp5-card": measured(5400)})
        self.assertIsNone(self.record())
        self.assertEqual(self.builds("hx8k")["hx8k-card"]["area"], 6700)
        self.assertEqual(self.builds("ecp5-25k")["ecp5-card"]["area"], 5400)
        page = (self.results / "README.md").read_text()
        self.assertIn("| hx8k-card | 6700 | 4 | **81** (80 81 82) |", page)
        self.assertIn("RTL of commit 0123abc: ecp5-card.", page)

    def test_takes_the_newer_of_two_measurements(self):
        synthesise.keep_checked({"hx8k-card": measured(6700)})
        synthesise.keep_checked({"hx8k-card": measured(6690)})
        self.assertIsNone(self.record())
        self.assertEqual(self.builds("hx8k")["hx8k-card"]["area"], 6690)

    def test_keeps_the_records_of_builds_that_were_not_measured(self):
        synthesise.write_results({"hx8k-axis": measured(500, "7654321")})
        synthesise.keep_checked({"hx8k-card": measured(6700)})
        self.assertIsNone(self.record())
        self.assertEqual(set(self.builds("hx8k")), {"hx8k-axis", "hx8k-card"})
        self.assertIn("RTL of commit 7654321: hx8k-axis.", (self.results / "README.md").read_text())

    def test_refuses_all_when_one_is_of_other_rtl(self):
        synthesise.keep_checked({"hx8k-card": measured(6700), "paths": measured(7300, "7654321")})
        self.assertIn("measured from other RTL than the present: paths", self.record())
        self.assertFalse((self.results / "hx8k.json").exists())

    def test_refuses_rtl_that_was_not_committed(self):
        """Two states of it are named alike, so the measurement may be of another one than the present."""
        synthesise.keep_checked({"hx8k-card": measured(6700, "0123abc and changes")})
        with mock.patch.object(synthesise, "rtl_commit", lambda: "0123abc and changes"):
            self.assertIn("commit the changes in rtl/", self.record())
        self.assertFalse((self.results / "hx8k.json").exists())


if __name__ == "__main__":
    unittest.main()
