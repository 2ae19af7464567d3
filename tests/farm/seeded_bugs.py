#!/usr/bin/env python3
"""Seeds errors in copies of scripts/records and scripts/farm_tools, one at a time; the test that is named must fail."""
import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
# File below scripts/, original text, text with the error, and the test that finds it.
BUGS = [
    ("records/results.py", 'return record.is_complete(entry), entry["begun"], json.dumps(entry, sort_keys=True)',
     'return record.is_complete(entry), entry["begun"]', "records_test.Merge.test_is_associative_commutative_and_idempotent"),
    ("records/results.py", "return record.is_complete(entry), entry", 'return True, entry',
     "records_test.Merge.test_the_newer_verdict_stays"),
    ("records/results.py", "path.exists() and record.is_complete(record.read(path))", "False",
     "records_test.Merge.test_a_cancelled_run_replaces_no_verdict_in_its_folder"),
    ("records/record.py", "if not right(record[name]):", "if False:",
     "records_test.Malformed.test_wrong_values_are_refused_by_file_and_field"),
    ("records/record.py", "if name not in FIELDS and name not in OPTIONAL:", "if False:",
     "records_test.Malformed.test_missing_and_unknown_fields_are_refused"),
    ("records/keep.py", 'if not entry["clean"]', "if False", "records_test.Keep.test_dirty_and_cancelled_ones_are_refused_by_name"),
    ("records/keep.py", "key=lambda match: tuple(map(int, match.groups()))", "key=lambda match: match.group(0)",
     "records_test.Keep.test_the_newest_release_is_by_number"),
    ("records/counts.py", "found[name] += int(number)", "found[name] = int(number)", "records_test.Counts.test_of_a_log_of_ctest"),
    ("records/figures.py", 'figure["killed"] += row["how"] != "lived"', 'figure["killed"] += 1',
     "records_test.Figures.test_mutants_that_lived_are_not_killed"),
    ("records/figures.py", 'figure["as_expected"] += result == "ok"', 'figure["as_expected"] += 1',
     "records_test.Figures.test_proofs_have_their_covers_and_seeded_bugs"),
    ("records/figures.py", "        elif not number:\n", "        elif lockstep:\n",
     "records_test.Figures.test_clocks_belong_to_the_lockstep_that_printed_them"),
    ("records/figures.py", "set(figure) == set(names)", "True",
     "records_test.Malformed.test_figures_of_mutants_and_proofs_are_integers_with_their_names"),
    ("records/suite.py", 'verdict == "passed" and name.startswith', 'name.startswith', "records_test.Suite.test_counts_and_seeded_bugs"),
    ("farm_tools/due.py", 'if found[job.id]["inputs"] != inputs_of(job):', "if False:",
     "farm_test.OnThisMachine.test_a_rerun_does_only_what_is_needed"),
    ("farm_tools/due.py", "if not all((identity.ROOT / product).exists() for product in job.products):", "if False:",
     "farm_test.OnThisMachine.test_a_rerun_does_only_what_is_needed"),
    ("farm_tools/due.py", 'if found[job.id]["result"] != "passed":', "if False:",
     "farm_test.OnThisMachine.test_changed_inputs_and_failures_are_due"),
    ("farm_tools/due.py", "            wanted |= set(job.needs)", "            pass",
     "farm_test.OnThisMachine.test_builds_alone_are_run_with_what_they_need"),
    ("farm_tools/processes.py", "if int(fields[3]) == session and", "if int(fields[2]) == session and",
     "farm_test.OnThisMachine.test_a_time_out_ends_the_job_and_its_children"),
    ("farm_tools/command.py", "return 1 if due.due(jobs, found) else 0", "return 0",
     "farm_test.OnThisMachine.test_a_failing_job_makes_the_exit_status_1"),
    ("farm_tools/local.py", 'if entry["result"] == "passed":\n                unfinished', "if True:\n                unfinished",
     "farm_test.OnThisMachine.test_nothing_begins_behind_a_build_that_failed"),
    ("farm_tools/local.py", "            except KeyboardInterrupt:\n                self.stop()",
     "            except KeyboardInterrupt:\n                pass",
     "farm_test.OnThisMachine.test_ctrl_c_ends_the_children_and_leaves_what_had_ended"),
    ("farm_tools/run_job.py", "return self.process.returncode, usage.ru_utime + usage.ru_stime",
     "return self.process.returncode, 0.0", "farm_test.OnThisMachine.test_processor_seconds_are_those_of_the_children"),
    ("farm_tools/plan.py", "before = max(", "before = min(", "farm_test.Arithmetic.test_total_and_critical_path"),
    ("farm_tools/plan.py", "[:workers - len(running)]", "[:workers]", "farm_test.Arithmetic.test_time_of_n_workers"),
    ("farm_tools/catalogue.py", "             hardware.netlist(\"hx8k-axis\"),\n             hardware.placement(\"hx8k-axis\", 1, \"quick-placement\"),\n",
     "", "farm_test.Catalogue.test_the_quick_sample_has_every_kind"),
    ("farm_tools/job.py", "if job.id in waiting:", "if False:", "farm_test.OnThisMachine.test_lists_that_cannot_be_run_are_refused"),
]
# These take some seconds each, because each starts its own cluster.
UNDER_SLURM = "slurm_test.UnderSlurm."
SLURM_BUGS = [
    ("farm_tools/slurm.py", 'f"--dependency=afterok:{\':\'.join(sorted(needs))}"', '"--comment=none"',
     UNDER_SLURM + "test_behind_a_build_that_fails_nothing_runs"),
    ("farm_tools/slurm.py", "for number in (signal.SIGTERM, signal.SIGINT):", "for number in ():",
     UNDER_SLURM + "test_cancel_ends_what_runs_and_what_waits"),
    ("farm_tools/run_job.py", 'self._end, ["timeout"])', 'self._end, ["cancelled"])',
     UNDER_SLURM + "test_a_job_that_runs_out_of_time_leaves_a_record_and_no_process"),
    ("farm_tools/slurm.py", "if index not in active and why(submission.jobs[index], found):", "if False:",
     UNDER_SLURM + "test_builds_come_first_one_fails_and_is_requeued"),
    ("farm_tools/slurm.py", "if need in submitted)", "if True)", UNDER_SLURM + "test_builds_come_first_one_fails_and_is_requeued"),
    ("farm_tools/command.py", "results.merge(part for _, part in parts)", "parts[0][1]",
     UNDER_SLURM + "test_results_of_two_submissions_merge"),
]


def complaint(bug, folder):
    """The complaint about a seeded bug that changes nothing, or whose test passes; empty when the test finds the
    bug."""
    file, good, bad, test = bug
    path = folder / file
    text = path.read_text()
    if good not in text:
        return f"{file}: has no {good!r}"
    path.write_text(text.replace(good, bad, 1))
    done = subprocess.run([sys.executable, "-B", "-m", "unittest", test], cwd=PROJECT / "tests" / "farm", capture_output=True,
                          text=True, timeout=200, env={**os.environ, "FARM_TEST_SCRIPTS": str(folder)})
    return "" if done.returncode and "FAILED (" in done.stderr else f"{file}: {test} does not find {bad!r}:\n{done.stderr}"


def tried(bug):
    # The copy is inside the work tree, because records name its commit.
    (PROJECT / "build").mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(dir=PROJECT / "build") as folder:
        scripts = Path(folder) / "scripts"
        shutil.copytree(PROJECT / "scripts", scripts, ignore=shutil.ignore_patterns("__pycache__"))
        (Path(folder) / "rtl").symlink_to(PROJECT / "rtl")
        (Path(folder) / "CMakeLists.txt").symlink_to(PROJECT / "CMakeLists.txt")
        return complaint(bug, scripts)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--list", action="store_true", help="print the errors and the tests that find them")
    parser.add_argument("--slurm", action="store_true", help="those that the tests under Slurm find, instead of the others")
    arguments = parser.parse_args()
    bugs = SLURM_BUGS if arguments.slurm else BUGS
    if arguments.list:
        print("\n".join(f"{file}: {bad!r} for {good!r}: {test}" for file, good, bad, test in bugs))
        return
    with ThreadPoolExecutor(1 if arguments.slurm else 4) as pool:
        complaints = list(filter(None, pool.map(tried, bugs)))
    print("\n".join(complaints))
    print(f"{len(bugs) - len(complaints)} of {len(bugs)} seeded bugs found")
    sys.exit(1 if complaints else 0)


if __name__ == "__main__":
    main()
