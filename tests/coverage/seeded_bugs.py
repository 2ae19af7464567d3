#!/usr/bin/env python3
"""Seeds errors in copies of scripts/coverage_tools, one at a time; the test that is named must fail."""
import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
# File of scripts/coverage_tools, original text, text with the error, and the test that finds it.
BUGS = [
    ("points.py", 'module.partition("__")[0])', "module)", "Reading.test_instances_and_parameters_are_one_point"),
    ("points.py", "merged[point] += count", "merged[point] = count", "Reading.test_processes_are_added"),
    ("points.py", "if point.kind not in KINDS:", "if False:", "Reading.test_what_is_no_coverage_file_is_refused"),
    ("report.py", 'return not found["missing"] and not found["wrong"]', 'return not found["wrong"]',
     "Verdict.test_an_uncovered_point_fails_by_file_and_line"),
    ("report.py", "if not counts[point] and point not in waived", "if not counts[point]", "Verdict.test_a_waiver_with_a_reason_passes"),
    ("waivers.py", "if not found:", "if False:", "Verdict.test_a_waiver_that_matches_nothing_fails"),
    ("waivers.py", 'and waiver.what in ("", point.what)]', "]", "Verdict.test_a_waiver_that_matches_nothing_fails"),
    ("waivers.py", "for point in found if counts[point]]", "for point in ()]", "Verdict.test_a_waived_point_that_is_covered_fails"),
    ("waivers.py", "MOST = 0.02", "MOST = 0.6", "Verdict.test_too_many_waivers_fail"),
    ("waivers.py", "SHORTEST_REASON = 20", "SHORTEST_REASON = 1", "Verdict.test_malformed_waivers_are_refused"),
    ("rtl.py", "wrong + not_clocked(modules) if whole", "wrong if whole", "Verdict.test_a_module_that_no_lockstep_clocks_fails"),
    ("rtl.py", 'and not file.startswith("boards/sim/")', "", "Verdict.test_other_files_do_not_count"),
    ("rtl.py", "NOT_TOGGLED.fullmatch(", "NOT_TOGGLED.match(",
     "Verdict.test_toggles_count_but_for_the_clock_and_what_a_module_does_not_read"),
    ("rtl.py", 'point.kind == "toggle" and NOT_TOGGLED', "False and NOT_TOGGLED",
     "Verdict.test_toggles_count_but_for_the_clock_and_what_a_module_does_not_read"),
    ("rtl.py", 'os.path.join("rtl", source)', 'f"rtl/{source}"',
     "Modules.test_a_source_of_the_tests_is_no_module_even_with_the_name_of_one"),
    ("rtl.py", 'report.passed(found) and not found["failed"]', "report.passed(found)",
     "Runs.test_a_lockstep_that_fails_fails_though_all_is_covered"),
    ("rtl.py", "                old.unlink()", "                pass", "Runs.test_old_counts_do_not_stand_for_a_run_that_left_none"),
    ("rtl.py", "if not WHOLE_CARDS.fullmatch(each.name)]", "]", "Verdict.test_whole_cards_are_left_out_by_name_and_taken_on_demand"),
    ("rtl.py", "            runs.failed.add(lockstep.name)", "            pass",
     "Verdict.test_whole_cards_are_left_out_by_name_and_taken_on_demand"),
    ("gcov.py", 'if any(branch["throw"]', "if any(False", "Cpp.test_branches_of_exceptions_alone_do_not_count"),
    ("gcov.py", "known.setdefault(place, Function", "known.setdefault((len(known), 0), Function",
     "Cpp.test_instances_of_a_template_are_one_function"),
    ("gcov.py", 'path.parts[0] == "build"', "False", "Cpp.test_objects_are_added_and_other_files_are_not"),
    ("gcov.py", 'Path(report["current_working_directory"]) / entry["file"]', 'Path(entry["file"])',
     "Cpp.test_names_relative_to_the_build_are_those_of_the_project"),
    ("cpp.py", "return covered / all_of_them if all_of_them else 0.0", "return covered / all_of_them if all_of_them else 1.0",
     "Cpp.test_less_than_95_percent_is_named"),
    ("report.py", "int(rate * 10) / 10", "round(rate, 1)", "Figures.test_99_95_percent_is_not_shown_as_100"),
]


def complaint(bug, scripts):
    """The complaint about a seeded bug that changes nothing, or whose test passes; empty when the test finds the
    bug."""
    file, good, bad, test = bug
    path = scripts / "coverage_tools" / file
    text = path.read_text()
    if good not in text:
        return f"{file}: has no {good!r}"
    path.write_text(text.replace(good, bad, 1))
    done = subprocess.run([sys.executable, "-B", "-m", "unittest", f"coverage_test.{test}"], cwd=PROJECT / "tests" / "coverage",
                          capture_output=True, text=True, timeout=200, env={**os.environ, "COVERAGE_TEST_SCRIPTS": str(scripts)})
    return "" if done.returncode and "FAILED (" in done.stderr else f"{file}: {test} does not find {bad!r}:\n{done.stderr}"


def tried(bug):
    with tempfile.TemporaryDirectory() as folder:
        scripts = Path(folder) / "scripts"
        for name in ("coverage_tools", "records"):
            shutil.copytree(PROJECT / "scripts" / name, scripts / name, ignore=shutil.ignore_patterns("__pycache__"))
        return complaint(bug, scripts)


def main():
    argparse.ArgumentParser(description=__doc__).parse_args()
    with ThreadPoolExecutor(4) as pool:
        complaints = list(filter(None, pool.map(tried, BUGS)))
    print("\n".join(complaints))
    print(f"{len(BUGS) - len(complaints)} of {len(BUGS)} seeded bugs found")
    sys.exit(1 if complaints else 0)


if __name__ == "__main__":
    main()
