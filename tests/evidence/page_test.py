"""The evidence page: how it must show the records of runs. Seen to fail: with mark() always "good", with a release
order by text, with a foreign judge that passes without a run, with cells that are not escaped, with missing points that
are not red, with two ways of cutting the mutants added up, with the older record of a proof, with survivors that are
not red, with no missing runs, without the links of a table."""
import json
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
sys.dont_write_bytecode = True

from evidence_page import charts, page  # noqa: E402
from evidence_page.gather import gather  # noqa: E402
from records import record  # noqa: E402


def run(job, result="passed", **more):
    return {"job": job, "kind": "part", "command": f"scripts/test --long {job}", "commit": "0123456789" * 4, "clean": True,
            "inputs": "0" * 64, "begun": "2026-01-31T23:59:59.999Z", "seconds": 7200.0, "processor_seconds": 3600.0, "result": result,
            "exit_status": int(result != "passed"), "counts": {"clocks compared": 1234567}, "tools": {},
            "machine": {"processors": 2, "architecture": "x86_64"}, "log": f"{job}.log", **more}


class Page(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def data(self, **records):
        for release, runs in records.items():
            (self.path / f"{release.removeprefix('v').replace('_', '.')}-rc1.json").write_text(json.dumps({"records": runs}))
        return gather(self.path)

    def judge(self, data, name):
        return next(judge for judge in data["foreign_judges"] if judge["name"].startswith(name))

    def test_a_failed_run_is_red_and_counted(self):
        text = page.html(self.data(v1_0_0=[run("part-frames", "failed"), run("part-unit")]))
        self.assertIn('<span class="bad">failed</span>', text)
        self.assertIn('<span class="good">passed</span>', text)
        self.assertIn("complete runs, 1 of them failed", text)

    def test_each_number_has_its_command_and_commit(self):
        text = page.html(self.data(v1_0_0=[run("part-unit")]))
        self.assertIn("1,234,567 clocks compared", text)
        self.assertIn("scripts/test --long part-unit", text)
        self.assertIn("01234567", text)

    def test_without_a_run_nothing_is_called_passed(self):
        data = self.data()
        self.assertEqual({judge["result"] for judge in data["foreign_judges"]}, {"not recorded"})
        self.assertIn("0 of 10", page.html(data).replace(f"0 of {len(data['foreign_judges'])}", "0 of 10"))
        self.assertNotIn('class="good"', page.html(data))

    def test_a_foreign_judge_passes_only_where_all_its_tests_and_parts_do(self):
        tests = {"linuxcnc.halrun": "passed", "linuxcnc.headless": "passed", "linuxcnc.other": "failed"}
        passed = self.data(v1_0_0=[run("tests", tests=tests), run("part-linuxcnc")])
        self.assertEqual(self.judge(passed, "LinuxCNC's HAL")["result"], "passed")
        self.assertEqual(self.judge(passed, "LinuxCNC's HAL")["passed_tests"], 2)
        failed = self.data(v1_0_0=[run("tests", tests={**tests, "linuxcnc.headless": "failed"}), run("part-linuxcnc")])
        self.assertEqual(self.judge(failed, "LinuxCNC's HAL")["result"], "failed")
        part = self.data(v1_0_0=[run("tests", tests=tests), run("part-linuxcnc", "timeout")])
        self.assertEqual(self.judge(part, "LinuxCNC's HAL")["result"], "failed")

    def test_the_newest_release_is_shown_by_number_not_by_text(self):
        data = self.data(**{"v0_9_0": [run("part-unit")], "v0_10_0": [run("part-frames")]})
        self.assertEqual(data["release"], "0.10.0-rc1")
        self.assertEqual([entry["release"] for entry in data["history"]], ["0.9.0-rc1", "0.10.0-rc1"])
        self.assertEqual(data["history"][0]["totals"]["processor hours"], 1.0)

    def test_sizes_of_placements_are_not_added_up(self):
        data = self.data(v1_0_0=[run("part-unit"), run("place-1", kind="placement", counts={"cells": 5000})])
        self.assertNotIn("cells", data["history"][0]["totals"])
        self.assertEqual(data["history"][0]["totals"]["clocks compared"], 1234567)

    def test_each_module_shows_the_coverage_of_its_newest_record(self):
        def counted(covered, waived=0):
            return {"axis": {"branch": {"points": 9, "covered": covered, "waived": waived}}, "motion_part": {}}

        data = self.data(v1_0_0=[run("part-coverage", coverage=counted(8, 1)),
                                 run("coverage-rtl", begun="2025-01-31T23:59:59.999Z", coverage=counted(5))])
        text = page.html(data)
        self.assertIn("<td>8 of 9, 1 waived</td>", text)
        self.assertIn('<span class="none">not recorded</span>', text)  # for the other module, and for all toggles
        self.assertIn('<span class="bad">7 of 9</span>', page.html(self.data(v1_0_0=[run("part-coverage", coverage=counted(7))])))
        row = next(line for line in text.splitlines() if ">motion_part<" in line)
        self.assertIn("<td>none</td>", row)

    def cell(self, data, module, column):
        row = next(line for line in page.html(data).splitlines() if f">{module}</a>" in line and "<td><code>" in line)
        return row.split("</td><td>")[column]

    def test_mutants_of_shards_are_added_and_those_of_two_ways_are_not(self):
        module = next(row for row in gather(self.path)["modules"] if row["listed"] == 1)
        name, half = module["module"], module["mutants"] // 2

        def shards(killed):
            return self.data(v1_0_0=[run("mutation-1-of-60", mutants={name: {"tried": half, "killed": half}}),
                                     run("part-mutation-1", mutants={name: {"tried": half, "killed": half}}),
                                     run("part-mutation-2", mutants={name: {"tried": module["mutants"] - half, "killed": killed}})])

        rest = module["mutants"] - half
        self.assertEqual(self.cell(shards(rest - 1), name, 5), f"{module['mutants'] - 1:,} of {module['mutants']:,}")
        self.assertIn('class="bad"', self.cell(shards(rest - 2), name, 5))
        self.assertIn(f"{half} of", self.cell(self.data(v1_0_0=[run("mutation-1-of-60", mutants={name: {"tried": half, "killed": half}})]), name, 5))

    def test_clocks_of_a_lockstep_are_those_of_all_runs(self):
        module = gather(self.path)["modules"][0]
        data = self.data(v1_0_0=[run(job, clocks={module["lockstep"]: 1000, "other": 5}) for job in ("tests", "part-lockstep-1")])
        self.assertEqual(self.cell(data, module["module"], 2), "2,000")
        self.assertIn("not recorded", self.cell(self.data(v1_0_0=[run("tests")]), module["module"], 2))

    def test_a_proof_shows_its_newest_runs(self):
        module = next(row for row in gather(self.path)["modules"] if row["proof"])
        older = run("proof-x", kind="proof", begun="2025-01-31T23:59:59.999Z", proofs={module["proof"]: {"runs": 9, "as_expected": 9}})
        newer = run("part-proofs", proofs={module["proof"]: {"runs": 8, "as_expected": 7}})
        self.assertRegex(self.cell(self.data(v1_0_0=[newer, older]), module["module"], 4), '<span class="bad"><a [^>]*>7 of 8</a></span>')
        self.assertIn("not recorded", self.cell(self.data(v1_0_0=[run("part-unit")]), module["module"], 4))

    def test_each_table_links_to_its_raw_files(self):
        data = gather()
        site = self.path / "site"
        page.write(site, data)
        text = (site / "index.html").read_text()
        self.assertEqual(text.count("<table"), text.count('<p class="raw">'))
        for name in ("modules.json", f"{data['release']}.json", "hx8k.json", "boards.json", "peers.toml"):
            self.assertIn(f'href="raw/{name}"', text)
            self.assertTrue((site / "raw" / name).read_bytes())

    def test_runs_that_are_missing_are_named(self):
        data = self.data(v1_0_0=[run("tests"), run("part-mutation-3")])
        self.assertNotIn("tests", data["missing_runs"])
        self.assertNotIn("part-mutation-3", data["missing_runs"])
        self.assertLess({"part-mutation-12", "part-soak", "part-sanitizers-1"}, set(data["missing_runs"]))
        self.assertIn("<code>mutation</code> (shards 1, 2, 4, 5,", page.html(data))

    def test_charts_begin_with_the_second_release(self):
        self.assertIn("begin with the second", charts.section(self.data(v1_0_0=[run("part-unit")])["history"]))
        history = self.data(v1_0_0=[run("part-unit")], v2_0_0=[run("part-unit")])["history"]
        self.assertNotIn("begin with the second", charts.section(history))

    def test_texts_are_escaped(self):
        self.assertIn("a &lt;b&gt;", page.html(self.data(v1_0_0=[run("part-unit", command="a <b>")])))

    def test_a_file_without_records_is_refused_by_name(self):
        (self.path / "0.1.0-rc7.json").write_text("{}")
        with self.assertRaisesRegex(record.RecordError, "0.1.0-rc7.json"):
            gather(self.path)


if __name__ == "__main__":
    unittest.main()
