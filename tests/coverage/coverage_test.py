#!/usr/bin/env python3
"""scripts/coverage: what counts as covered, and what must fail. seeded_bugs.py says which error each test finds."""
import contextlib
import io
import json
import os
import sys
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

PROJECT = Path(__file__).resolve().parents[2]
# seeded_bugs.py runs the tests on a copy of the scripts with an error.
sys.path.insert(0, os.environ.get("COVERAGE_TEST_SCRIPTS", str(PROJECT / "scripts")))
sys.dont_write_bytecode = True

from coverage_tools import cpp, gcov, points, report, rtl, waivers  # noqa: E402

ROOT = Path("/project")
SOURCE = """module counter (
    input logic clk_i,
    output logic q_o
);
  always_ff @(posedge clk_i) begin
    if (q_o) q_o <= 1'b0;
    else q_o <= 1'b1;
  end
endmodule
"""


def entry(line, column, kind, what, count, hierarchy="TOP.counter", module="counter", file="/project/rtl/io/counter.sv"):
    keys = {"f": file, "l": line, "n": column, "page": f"v_{kind}/{module}", "o": what, "h": hierarchy}
    return "C '" + "".join(f"\1{name}\2{value}" for name, value in keys.items()) + f"' {count}\n"


def dat(*entries):
    return "# SystemC::Coverage-3\n" + "".join(entries)


WHOLE = dat(entry(5, 3, "line", "block", 9), entry(6, 5, "branch", "if", 4), entry(6, 6, "branch", "else", 5))
MISSING = dat(entry(5, 3, "line", "block", 9), entry(6, 5, "branch", "if", 0), entry(6, 6, "branch", "else", 9))


class Reading(unittest.TestCase):
    def test_instances_and_parameters_are_one_point(self):
        text = dat(entry(6, 5, "branch", "if", 0, "TOP.a"), entry(6, 5, "branch", "if", 3, "TOP.b", "counter__A8"),
                   entry(6, 5, "branch", "if", 4, "TOP.c"))
        found = points.of_text(text, "x.dat", ROOT)
        self.assertEqual([(point.file, point.module, count) for point, count in found.items()], [("rtl/io/counter.sv", "counter", 7)])

    def test_processes_are_added(self):
        parts = [points.of_text(text, "x.dat", ROOT) for text in (WHOLE, MISSING)]
        self.assertEqual(sorted(points.merge(parts).values()), [4, 14, 18])

    def test_what_is_no_coverage_file_is_refused(self):
        for text in ("", "C '' 1\n", dat("C broken\n"), dat("C '\1l\0025' 1\n"), dat(entry(1, 1, "magic", "x", 1)), WHOLE[:-8]):
            with self.assertRaises(points.PointError):
                points.of_text(text, "x.dat", ROOT)


class InAProject(unittest.TestCase):
    """A project of one module and one lockstep that has run."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        locksteps = [{"name": "counter", "sources": ["io/counter.sv"]}]
        for name, text in {"rtl/io/counter.sv": SOURCE, "verif/coverage/waivers.toml": "",
                           "verif/evidence/modules.json": json.dumps([{"module": "counter", "file": "io/counter.sv"}]),
                           "build/verif/judges.json": json.dumps({"locksteps": locksteps})}.items():
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            (self.root / name).write_text(text)
        for name, value in {"ROOT": self.root, "folder": lambda toggle: self.root / "build"}.items():
            patch = mock.patch.object(rtl, name, value)
            patch.start()
            self.addCleanup(patch.stop)
        self.dat = self.root / "out/rtl/dat/lockstep_counter.1.dat"

    def waive(self, **fields):
        fields = {"file": "rtl/io/counter.sv", "text": "if (q_o) q_o <= 1'b0;", "kind": "branch", "what": "if",
                  "reason": "the counter is never set in this project", **fields}
        lines = "".join(f"{name} = {json.dumps(value)}\n" for name, value in fields.items())
        (self.root / "verif/coverage/waivers.toml").write_text(f"[[waiver]]\n{lines}")

    def coverage(self, text, **options):
        """The exit status; self.said has the output."""
        self.dat.parent.mkdir(parents=True, exist_ok=True)
        self.dat.write_text(text.replace("/project/", f"{self.root}/"))
        arguments = SimpleNamespace(**{"toggle": False, "only": "", "cards": False, "no_build": True, "no_run": True, "build_only": False, "jobs": 1,
                                       "out": self.root / "out", **options})
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said), mock.patch.object(rtl, "checked"):
            status = rtl.run(arguments)
        self.said = said.getvalue()
        return status

    def result(self):
        return json.loads((self.root / "out/rtl/coverage.json").read_text())

    def many(self, missing):
        """MISSING, plus enough covered lines that one waiver is at most 2 %."""
        return missing + "".join(entry(5, column, "branch", "case", 1) for column in range(10, 110))


class Verdict(InAProject):
    def test_all_points_covered_passes(self):
        self.assertEqual(self.coverage(WHOLE), 0)
        self.assertEqual(self.result()["modules"]["counter"]["branch"], {"points": 2, "covered": 2, "waived": 0})
        self.assertIn("2 branch points covered\n", self.said)

    def test_an_uncovered_point_fails_by_file_and_line(self):
        self.assertEqual(self.coverage(MISSING), 1)
        self.assertIn("rtl/io/counter.sv:6: branch if: if (q_o) q_o <= 1'b0;", self.said)

    def test_a_waiver_with_a_reason_passes(self):
        self.waive()
        self.assertEqual(self.coverage(self.many(MISSING)), 0)
        self.assertIn("1 branch points waived\n", self.said)

    def test_a_waiver_that_matches_nothing_fails(self):
        for changed in ({"text": "if (gone)"}, {"what": "elsif"}, {"file": "rtl/io/gone.sv"}, {"kind": "line"}):
            with self.subTest(changed):
                self.waive(**changed)
                self.assertEqual(self.coverage(self.many(WHOLE)), 1)
                self.assertIn("waiver matches nothing", self.said)

    def test_a_waived_point_that_is_covered_fails(self):
        self.waive()
        self.assertEqual(self.coverage(self.many(WHOLE)), 1)
        self.assertIn("waived, but covered 4 times", self.said)

    def test_too_many_waivers_fail(self):
        self.waive()
        self.assertEqual(self.coverage(MISSING), 1)
        self.assertIn("1 of 2 branch points are waived, more than 2%", self.said)

    def test_malformed_waivers_are_refused(self):
        for changed in ({"reason": "hard"}, {"kind": "magic"}, {"line": 5}, {"what": 3}):
            with self.subTest(changed), self.assertRaises(waivers.WaiverError):
                self.waive(**changed)
                self.coverage(WHOLE)

    def test_a_module_that_no_lockstep_clocks_fails(self):
        (self.root / "verif/evidence/modules.json").write_text(json.dumps([{"module": "other", "file": "io/other.sv"}]))
        self.assertEqual(self.coverage(WHOLE), 1)
        self.assertIn("module other: no lockstep that was run has it", self.said)

    def test_whole_cards_are_left_out_by_name_and_taken_on_demand(self):
        judges = {"locksteps": [{"name": name, "sources": ["io/counter.sv"]} for name in ("counter", "card", "hx8k_uart", "uart_port")]}
        (self.root / "build/verif/judges.json").write_text(json.dumps(judges))
        self.assertEqual(self.coverage(WHOLE), 1)  # there are no counts of uart_port
        self.assertIn("error: lockstep uart_port failed", self.said)
        for name in ("uart_port", "card", "hx8k_uart"):
            (self.dat.parent / f"lockstep_{name}.1.dat").write_text(WHOLE)
        self.assertEqual(self.coverage(WHOLE), 0)
        self.assertIn("left out: whole cards (--cards): card hx8k_uart\n", self.said)
        self.assertEqual(self.coverage(WHOLE, cards=True), 0)
        self.assertEqual(self.result()["locksteps"], 4)
        self.assertEqual(self.coverage(MISSING, only="^counter$"), 0)
        self.assertIn("listed, and not judged", self.said)

    def test_without_counts_there_is_no_verdict(self):
        self.coverage(WHOLE)
        self.dat.unlink()
        self.dat = self.root / "elsewhere.dat"
        with self.assertRaises(SystemExit):
            self.coverage(WHOLE)

    def test_other_files_do_not_count(self):
        other = [entry(1, 1, "branch", "if", 0, file=f"/project/{file}")
                 for file in ("boards/sim/SB_IO.sv", "verif/lockstep/axis/timers.sv", "rtl/io/io_pkg.sv")]
        self.assertEqual(self.coverage(WHOLE + "".join(other)), 0)

    def test_toggles_count_but_for_the_clock_and_what_a_module_does_not_read(self):
        never = [entry(2, 17, "toggle", what, 0) for what in ("clk_i", "unused", "unused[3]")]
        self.assertEqual(self.coverage(WHOLE + "".join(never)), 0)
        for missing in ("q_o", "q_o[3]", "clk_io", "unused_o"):
            self.assertEqual(self.coverage(WHOLE + entry(3, 18, "toggle", missing, 0)), 1)
            self.assertIn(f"rtl/io/counter.sv:3: toggle {missing}: output logic q_o", self.said)


class Runs(InAProject):
    def lockstep(self, script):
        program = self.root / "build/bin/lockstep_counter"
        program.parent.mkdir(parents=True, exist_ok=True)
        program.write_text(f"#!/bin/sh\n{script}\n")
        program.chmod(0o755)

    def test_a_lockstep_that_fails_fails_though_all_is_covered(self):
        self.lockstep('cp "$0.dat" "$TRAMMEL_RTL_COVERAGE/lockstep_counter.2.dat"; exit 3')
        (self.root / "build/bin/lockstep_counter.dat").write_text(WHOLE.replace("/project/", f"{self.root}/"))
        self.assertEqual(self.coverage(WHOLE, no_run=False), 1)
        self.assertIn("error: lockstep counter failed", self.said)

    def test_old_counts_do_not_stand_for_a_run_that_left_none(self):
        self.lockstep("exit 0")
        with self.assertRaises(SystemExit):
            self.coverage(WHOLE, no_run=False)


class Modules(unittest.TestCase):
    def test_a_source_of_the_tests_is_no_module_even_with_the_name_of_one(self):
        names = [f"module{n}" for n in range(20)]  # files are a set: one pair could be in the right order by chance
        sources = [source for name in names for source in (f"card/{name}.sv", f"/project/verif/{name}.sv")]
        self.assertEqual(rtl.modules_of([rtl.Lockstep("all", sources)]), {name: f"rtl/card/{name}.sv" for name in names})


def gcov_line(number, count, *branches, function="f"):
    return {"line_number": number, "count": count, "function_name": function,
            "branches": [{"count": taken, "throw": throw} for taken, throw in branches]}


def gcov_report(lines, functions=("f",), file="/project/driver/src/a.cpp"):
    return {"current_working_directory": "/project/build/coverage", "files": [{"file": file, "lines": lines, "functions": [
        {"name": name, "demangled_name": f"{name}()", "start_line": 1, "start_column": 1} for name in functions]}]}


class Cpp(unittest.TestCase):
    def files(self, *reports):
        files = {}
        for each in reports:
            gcov.add(files, each, ROOT)
        return files

    def test_branches_of_exceptions_alone_do_not_count(self):
        line = gcov_line(1, 5, (5, False), (0, True), (5, False), (0, False))
        self.assertEqual(cpp.library_figures(self.files(gcov_report([line])), "driver"),
                         {"lines": 1, "lines_covered": 1, "branches": 2, "branches_covered": 1})

    def test_instances_of_a_template_are_one_function(self):
        lines = [gcov_line(1, 1, (1, False), (0, False), function="f<1>"), gcov_line(1, 1, (0, False), (1, False), function="f<2>")]
        figures = cpp.library_figures(self.files(gcov_report(lines, ("f<1>", "f<2>"))), "driver")
        self.assertEqual((figures["branches"], figures["branches_covered"]), (2, 2))

    def test_objects_are_added_and_other_files_are_not(self):
        first, second = gcov_report([gcov_line(1, 0), gcov_line(2, 1)]), gcov_report([gcov_line(1, 1), gcov_line(2, 0)])
        elsewhere = gcov_report([gcov_line(1, 0)], file="/usr/include/c++/12/vector")
        written = gcov_report([gcov_line(1, 0)], file="/project/build/coverage/driver/x.cpp")
        files = self.files(first, second, elsewhere, written)
        self.assertEqual(list(files), ["driver/src/a.cpp"])
        self.assertEqual(cpp.library_figures(files, "driver")["lines_covered"], 2)

    def test_names_relative_to_the_build_are_those_of_the_project(self):
        files = self.files(gcov_report([gcov_line(1, 1)], file="../../driver/include/a.hpp"),
                           gcov_report([gcov_line(1, 1)], file="driver/x.cpp"), gcov_report([gcov_line(1, 1)], file="../../../b.hpp"))
        self.assertEqual(list(files), ["driver/include/a.hpp"])

    def test_less_than_95_percent_is_named(self):
        row = {"lines": 100, "lines_covered": 95, "branches": 100, "branches_covered": 94}
        self.assertEqual(cpp.below({"driver": row}), ["driver: branches 94.0%, less than 95%"])
        self.assertTrue(cpp.below({"driver": dict.fromkeys(row, 0)}))

    def test_functions_with_gaps_are_listed_with_lines(self):
        lines = [gcov_line(1, 1, (1, False), (0, False)), gcov_line(2, 0)]
        gap, = cpp.missing(self.files(gcov_report(lines)), "driver")
        self.assertEqual(cpp.line_of(gap), "driver/src/a.cpp:1: f(): lines 2; 1 branches of lines 1")


class Figures(unittest.TestCase):
    def test_99_95_percent_is_not_shown_as_100(self):
        self.assertEqual(report.shown({"points": 2000, "covered": 1999, "waived": 0}), "1999/2000 99.9%")


if __name__ == "__main__":
    unittest.main()
