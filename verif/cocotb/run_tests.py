#!/usr/bin/env python3
"""Runs masters_test.py on the card in Icarus, then on cards with one seeded bug each, which it must find. Exit status
77: cocotb is not installed."""
import argparse
import contextlib
import os
import pathlib
import shutil
import subprocess
import sys
import warnings
import xml.etree.ElementTree

warnings.filterwarnings("ignore", "Python runners")
try:
    from cocotb.runner import get_runner
except ImportError:
    print("cocotb is not installed: scripts/test installs requirements-cocotb.txt into .venv")
    sys.exit(77)

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent

# (name, file, original text, which occurs once, text of the bug)
SEEDED = [
    ("axi_refusal_untold", "rtl/host/axi4_lite_port.sv", "write_error_q <= answer_i[register_answer_pkg::ERROR];", "write_error_q <= 1'b0;"),
    ("axi_answer_dropped", "rtl/host/axi4_lite_port.sv", "if (rready_i) rvalid_o <= 1'b0;", "rvalid_o <= 1'b0;"),
    ("wishbone_refusal_untold", "rtl/host/wishbone/wishbone_port.sv", "err_o <= ack && error &&", "err_o <= 1'b0 &&"),
    ("answers_to_everybody", "rtl/host/port_arbiter.sv", "register_answer_pkg::only_if(answer_i, port_q == 2'(p));", "answer_i;"),
]


def sources():
    listed = subprocess.run([ROOT / "scripts/rtl/file-list"], check=True, capture_output=True, text=True, cwd=ROOT).stdout.split()
    return [str(ROOT / name) for name in listed] + [str(HERE / "card_on_buses.sv")]


def run(folder, files):
    """(tests, failures) of one simulation."""
    with (folder / "runner.log").open("w") as log, contextlib.redirect_stdout(log):
        simulate(folder, files)
    cases = list(xml.etree.ElementTree.parse(folder / "results.xml").iter("testcase"))
    return len(cases), sum(case.find("failure") is not None or case.find("error") is not None for case in cases)


def simulate(folder, files):
    runner = get_runner("icarus")
    runner.build(verilog_sources=files, hdl_toplevel="card_on_buses", build_args=["-g2012"], build_dir=folder, always=True,
                 log_file=folder / "build.log")
    runner.test(hdl_toplevel="card_on_buses", test_module="masters_test", build_dir=folder, test_dir=HERE,
                results_xml=str(folder / "results.xml"), log_file=folder / "test.log",
                extra_env={"TRAMMEL_CARD_MAP": str(ROOT / "rtl/regs/generated/card_map_pkg.sv")})


def seeded(name, file, before, after, folder):
    text = (ROOT / file).read_text()
    if text.count(before) != 1:
        sys.exit(f"error: seeded bug {name}: {file} has its text {text.count(before)} times")
    copy = folder / pathlib.Path(file).name
    copy.write_text(text.replace(before, after))
    return [str(copy) if source == str(ROOT / file) else source for source in sources()]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path, help="for what is built")
    parser.add_argument("--no-seeded-bugs", action="store_true", help="the card alone")
    arguments = parser.parse_args()
    folder = arguments.folder.resolve()
    # The simulator finds this interpreter and its packages through these variables.
    os.environ["PATH"] = f"{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}"
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "card").mkdir(parents=True)
    tests, failures = run(folder / "card", sources())
    print(f"the card: {tests} tests, {failures} failed")
    good = tests == 3 and failures == 0
    for name, *change in [] if arguments.no_seeded_bugs else SEEDED:
        own = folder / name
        own.mkdir()
        tests, failures = run(own, seeded(name, *change, own))
        print(f"seeded bug {name}: {failures} of {tests} tests failed, {'found' if failures else 'NOT FOUND'}")
        good = good and tests == 3 and failures > 0
    return 0 if good else 1


sys.exit(main())
