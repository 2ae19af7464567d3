"""Writes the record of a run of scripts/test or of one of its parts; scripts/test calls this after the run."""

import argparse
import sys
from pathlib import Path

from . import counts, coverage, figures, identity, record, results, suite

# Developer pages are excluded, because no result depends on them.
INPUTS = (".", ":!docs/developer", ":!docs/decisions", f":!{identity.EVIDENCE}", ":!README.md", ":!CHANGELOG.md")
TOOLS = ("g++", "cmake", "ctest", "verilator", "yosys", "python3")
TIMEOUT_STATUS = 124  # exit status of timeout(1)


def arguments_of(argv):
    parser = argparse.ArgumentParser(prog="records.part", description=__doc__)
    parser.add_argument("--folder", type=Path, required=True, help="of the records; the log lies in it")
    parser.add_argument("--job", required=True, metavar="NAME", help="the log is NAME.log")
    parser.add_argument("--text", required=True, metavar="COMMAND", help="what was run")
    parser.add_argument("--begun", required=True, help="as records.part --begin prints it")
    parser.add_argument("--commit", required=True, help="at the beginning")
    parser.add_argument("--clean", required=True, choices=("true", "false"), help="at the beginning")
    parser.add_argument("--seconds", type=float, required=True, help="by the wall's clock")
    parser.add_argument("--processor-seconds", type=float, required=True)
    parser.add_argument("--status", type=int, required=True, help="exit status of the part")
    parser.add_argument("--suite", nargs=2, type=Path, metavar=("JUNIT", "LOG"), help="ctest's results and its whole log: for "
                        "what the tests compared, and the verdicts of programs from elsewhere")
    parser.add_argument("--coverage", type=Path, metavar="FILE", help="coverage.json of scripts/coverage: each module's figures")
    parser.add_argument("--clocks", type=Path, metavar="LOG", help="ctest's whole log: the clocks that each lockstep has compared")
    parser.add_argument("--mutants", type=Path, metavar="FILE", help="results.csv of scripts/mutate: each module's figures")
    return parser.parse_args(argv)


def begin() -> int:
    """Prints time, commit and state of the work tree before the run, so that a commit during the run does not change
    them."""
    print(identity.now(), identity.commit(), str(identity.is_clean()).lower())
    return 0


def main(argv) -> int:
    if argv == ["--begin"]:
        return begin()
    arguments = arguments_of(argv)
    result = {0: "passed", TIMEOUT_STATUS: "timeout"}.get(arguments.status, "failed")
    log = arguments.folder / f"{arguments.job}.log"
    text = log.read_text(errors="replace")
    counted, verdicts = counts.of_text(text), {}
    if arguments.suite:
        junit, whole = arguments.suite
        counted |= counts.of_text(whole.read_text(errors="replace")) | suite.counts_of(junit)
        verdicts = {"tests": suite.foreign(junit)}
    if arguments.clocks and (found := figures.clocks(arguments.clocks.read_text(errors="replace"))):
        verdicts["clocks"] = found
    if arguments.coverage and (found := coverage.of_file(arguments.coverage)):
        verdicts["coverage"] = found
    if arguments.mutants and (found := figures.mutants(arguments.mutants)):
        verdicts["mutants"] = found
    if found := figures.proofs(text):
        verdicts["proofs"] = found
    entry = {
        "job": arguments.job,
        "kind": "part",
        "command": arguments.text,
        "commit": arguments.commit,
        "clean": arguments.clean == "true" and identity.is_clean() and identity.commit() == arguments.commit,
        "inputs": identity.inputs(INPUTS, [arguments.text]),
        "begun": arguments.begun,
        "seconds": arguments.seconds,
        "processor_seconds": arguments.processor_seconds,
        "result": result,
        "exit_status": arguments.status,
        "counts": counted,
        "tools": identity.versions(TOOLS),
        "machine": identity.machine(),
        "log": log.name,
        **verdicts,
    }
    results.store(arguments.folder, record.check(entry, arguments.job))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
