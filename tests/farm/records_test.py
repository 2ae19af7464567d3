#!/usr/bin/env python3
"""Records: refusals, merging, counts, and keeping. seeded_bugs.py lists the error that each test finds."""
import json
import random
import unittest

from support import InAFolder, a_record, random_records

from records import counts, figures, keep, record, results, suite  # noqa: E402

WRONG = {
    "job": ["", "../x", 3], "kind": ["other"], "command": [None], "commit": ["0123", "z" * 40], "clean": [1, "true"],
    "inputs": ["ab"], "begun": ["2026-11-28 20:47:02", "2026-11-28T20:47:02+01:00"], "seconds": [-1, "1", True],
    "processor_seconds": [-0.1], "result": ["ok"], "exit_status": ["0", 1, False], "counts": [{"a": 1.5}, []],
    "tools": [{"yosys": 1}], "machine": [{"processors": 2}, {"processors": 0, "architecture": "a"}],
    "log": ["/tmp/log", "../log"],
}


class Malformed(InAFolder):
    def refusal(self, content):
        path = self.folder / "x.json"
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        with self.assertRaises(record.RecordError) as caught:
            record.read(path)
        self.assertIn(str(path), str(caught.exception))
        return str(caught.exception)

    def test_wrong_values_are_refused_by_file_and_field(self):
        self.assertEqual(set(WRONG), set(record.FIELDS))
        for name, values in WRONG.items():
            for value in values:
                self.assertIn(f"field {name}", self.refusal(a_record(**{name: value})), value)

    def test_missing_and_unknown_fields_are_refused(self):
        for name in record.FIELDS:
            entry = a_record()
            del entry[name]
            self.assertIn(f"field {name}: missing", self.refusal(entry))
        self.assertIn("field more: unknown", self.refusal(a_record(more=1)))

    def test_coverage_is_integers_by_module_and_kind(self):
        right = {"axis": {"line": {"points": 3, "covered": 2, "waived": 1}}, "motion_part": {}}
        record.check(a_record(coverage=right), "right")
        for wrong in ([], {"axis": 1}, {"axis": {"magic": right["axis"]["line"]}}, {"axis": {"line": {"points": 3}}},
                      {"axis": {"line": {"points": 3, "covered": "2", "waived": 1}}}):
            self.assertIn("field coverage", self.refusal(a_record(coverage=wrong)))

    def test_figures_of_mutants_and_proofs_are_integers_with_their_names(self):
        for field, right in (("mutants", {"tried": 3, "killed": 2}), ("proofs", {"runs": 3, "as_expected": 3})):
            record.check(a_record(**{field: {"axis": right}}), "right")
            for wrong in ([], {"axis": 1}, {"axis": {}}, {"axis": dict.fromkeys(right, "1")}, {"axis": {**right, "more": 1}}):
                self.assertIn(f"field {field}", self.refusal(a_record(**{field: wrong})))

        record.check(a_record(clocks={"axis_0": 3}), "right")
        self.assertIn("field clocks", self.refusal(a_record(clocks={"axis_0": "3"})))

    def test_what_is_no_record_is_refused(self):
        for content in ("", "{", "[1]", "3"):
            self.refusal(content)

    def test_a_file_of_another_job_is_refused(self):
        record.write(self.folder / "a.json", a_record("b"))
        with self.assertRaisesRegex(record.RecordError, "b.json"):
            results.read_folder(self.folder)

    def test_nothing_wrong_is_written(self):
        with self.assertRaises(record.RecordError):
            record.write(self.folder / "a.json", a_record("a", seconds=-1))
        self.assertEqual(list(self.folder.iterdir()), [])


class Merge(InAFolder):
    def test_is_associative_commutative_and_idempotent(self):
        draw = random.Random(1)
        for _ in range(2000):
            a, b, c = (random_records(draw) for _ in range(3))
            whole = results.merge([a, b, c])
            self.assertEqual(results.merge([results.merge([a, b]), c]), whole)
            self.assertEqual(results.merge([a, results.merge([b, c])]), whole)
            self.assertEqual(results.merge([c, b, a]), whole)
            self.assertEqual(results.merge([whole, a]), whole)
            self.assertEqual(set(whole), set(a) | set(b) | set(c))

    def test_the_newer_verdict_stays(self):
        old, new = a_record("a"), a_record("a", begun="2026-11-28T20:47:02.124Z", result="failed", exit_status=1)
        later = a_record("a", begun="2026-11-29T00:00:00.000Z", result="cancelled", exit_status=130)
        self.assertEqual(results.merge([{"a": later}, {"a": new}, {"a": old}]), {"a": new})

    def test_a_cancelled_run_replaces_no_verdict_in_its_folder(self):
        results.store(self.folder, a_record("a", result="cancelled", exit_status=130))
        results.store(self.folder, a_record("a"))
        results.store(self.folder, a_record("a", result="cancelled", exit_status=130))
        self.assertEqual(results.read_folder(self.folder), {"a": a_record("a")})


JUNIT = """<testsuite>
<testcase name="gcode.A" status="run"/>
<testcase name="gcode.B" status="fail"/>
<testcase name="seeded_bug.C" status="run"/>
<testcase name="seeded_bug.F" status="fail"/>
<testcase name="panel.D" status="notrun"/><testcase name="E" status="disabled"/>
</testsuite>"""


class Suite(InAFolder):
    def setUp(self):
        super().setUp()
        self.junit = self.folder / "tests.xml"
        self.junit.write_text(JUNIT)

    def test_counts_and_seeded_bugs(self):
        self.assertEqual(suite.counts_of(self.junit), {"tests": 6, "tests_passed": 2, "tests_failed": 2, "tests_skipped": 2,
                                                       "seeded_bugs_found": 1})

    def test_verdicts_of_judges_from_elsewhere(self):
        judges = self.folder / "judges.toml"
        self.assertEqual(suite.foreign(self.junit, judges), {})
        judges.write_text('[[judge]]\ntests = "^gcode[.]"\n[[judge]]\npart = "x"\n[[judge]]\ntests = "^panel"\n')
        verdicts = suite.foreign(self.junit, judges)
        self.assertEqual(verdicts, {"gcode.A": "passed", "gcode.B": "failed", "panel.D": "skipped"})
        record.check(a_record(tests=verdicts), "x")
        with self.assertRaisesRegex(record.RecordError, "field tests"):
            record.check(a_record(tests={"a": "run"}), "x")


class Figures(InAFolder):
    def test_mutants_that_lived_are_not_killed(self):
        path = self.folder / "results.csv"
        self.assertEqual(figures.mutants(path), {})
        path.write_text("id,how,module\na-1,mismatch,axis\na-2,lived,axis\na-3,timed out,axis\nb-1,lived,pwm\n")
        self.assertEqual(figures.mutants(path), {"axis": {"tried": 3, "killed": 2}, "pwm": {"tried": 1, "killed": 0}})

    def test_clocks_belong_to_the_lockstep_that_printed_them(self):
        log = ("1/5 Testing: lockstep.axis_0.Axis/Random.Steps\n1/5 Test: lockstep.axis_0.Axis/Random.Steps\n12 clocks compared in lockstep\n"
               "2/5 Testing: lockstep.axis_0.Axis.Reset\n30 clocks compared in lockstep\n3/5 Testing: model.Axis\n"
               "7 clocks compared in lockstep\n4/5 Testing: lockstep.pwm.Pwm.Duty\n1 clocks compared in lockstep, said another\n")
        self.assertEqual(figures.clocks(log), {"axis_0": 42})

    def test_proofs_have_their_covers_and_seeded_bugs(self):
        log = ("== frame_crc: bit by bit\nproof    frame_crc      0.3 s  ok\ncover    frame_crc byte   0.5 s  ok\n"
               "bug      frame_crc tap_lost  0.3 s  FAILED (status 1)\nlemma    steer, z3     1.0 s  ok\nnothing  frame_crc  1.0 s  ok\n")
        self.assertEqual(figures.proofs(log), {"frame_crc": {"runs": 3, "as_expected": 2}, "steer": {"runs": 1, "as_expected": 1}})
        self.assertEqual(counts.of_text(log), {"proof_runs": 4, "proof_runs_as_expected": 3})


class Counts(InAFolder):
    def test_of_a_log_of_ctest(self):
        log = ("12: 300 clocks of random traffic compared, 4 holds\n13: 200 clocks of random traffic compared, 0 holds\n"
               "13: 7 of them with random inputs; by bit\n98% tests passed, 1 tests failed out of 50\n"
               "\t  7 - gcode.X (Skipped)\n")
        self.assertEqual(counts.of_text(log), {"clocks of random traffic": 500, "of them with random inputs": 7, "tests": 50,
                                               "tests_failed": 1, "tests_skipped": 1})

    def test_of_a_part_and_of_programs(self):
        self.assertEqual(counts.of_text("compared     5000 stops judged\n"), {"stops judged": 5000})
        self.assertEqual(counts.of_text("[  PASSED  ] 2 tests.\n"), {"tests": 2})
        self.assertEqual(counts.of_text("6661 cells\n83100 kHz\n6721 cells at most\n"),
                         {"cells": 6661, "kHz": 83100, "cells at most": 6721})
        log = ("cover    busy_timer over                                  0.1 s  ok\n"
               "bug      busy_timer late                                  0.1 s  FAILED (status 1)\n5 of 5 seeded bugs found\n")
        self.assertEqual(counts.of_text(log), {"proof_runs": 2, "proof_runs_as_expected": 1, "seeded_bugs_found": 5})
        self.assertEqual(counts.of_text("96 line points\n95 line points covered\n1 line points waived\n9 C++ lines covered\n"),
                         {"line points": 96, "line points covered": 95, "line points waived": 1, "C++ lines covered": 9})
        self.assertEqual(counts.of_text("3 mice\nstat::number_of_executed_units: 4321\n"), {"inputs_tried": 4321})

    def test_of_mutants_and_proofs(self):
        (self.folder / "results.csv").write_text("id,how\n1,mismatch\n2,lived\n3,mismatch\n")
        (self.folder / "results").write_text("ok\nFAILED (status 1)\nok\n")
        self.assertEqual(counts.of_file(self.folder / "results.csv"), {"mutants": 3, "mutants lived": 1, "mutants mismatch": 2})
        self.assertEqual(counts.of_file(self.folder / "results"), {"proof_runs": 3, "proof_runs_as_expected": 2})


class Keep(InAFolder):
    def kept(self, *entries):
        files = []
        for number, entry in enumerate(entries):
            files.append(self.folder / f"{number}.record")
            record.write(files[-1], entry)
        return keep.keep(files, "0.1.0-rc2", self.folder / "evidence")

    def release(self):
        return keep.read_release(self.folder / "evidence" / "0.1.0-rc2.json")

    def test_merges_and_writes_the_same_in_any_order(self):
        self.kept(a_record("b"), a_record("a", result="failed", exit_status=1))
        text = (self.folder / "evidence" / "0.1.0-rc2.json").read_text()
        self.kept(a_record("a"), a_record("c", tests={"gcode.A": "passed"}))
        self.assertEqual(list(self.release()), ["a", "b", "c"])
        self.assertEqual(self.release()["c"]["tests"], {"gcode.A": "passed"})
        self.assertEqual(keep.release_text({"b": a_record("b"), "a": a_record("a", result="failed", exit_status=1)}), text)
        self.assertLess(max(map(len, text.splitlines())), 200)

    def test_dirty_and_cancelled_ones_are_refused_by_name(self):
        with self.assertRaisesRegex(keep.KeepError, "changes: b;"):
            self.kept(a_record("a"), a_record("b", clean=False))
        with self.assertRaisesRegex(keep.KeepError, "cancelled before a result: c;"):
            self.kept(a_record("c", result="cancelled", exit_status=130))
        self.assertEqual(self.release(), {})

    def test_the_newest_release_is_by_number(self):
        self.assertRegex(keep.newest(self.folder), r"^\d+\.\d+\.\d+-rc1$")
        for name in ("0.9.0-rc3", "0.10.0-rc2", "0.10.0-rc10", "notes"):
            (self.folder / f"{name}.json").write_text("{}")
        self.assertEqual(keep.newest(self.folder), "0.10.0-rc10")
        with self.assertRaisesRegex(keep.KeepError, "must be VERSION"):
            keep.keep([], "first", self.folder)


if __name__ == "__main__":
    unittest.main()
