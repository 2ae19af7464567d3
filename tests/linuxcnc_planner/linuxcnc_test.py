#!/usr/bin/env python3
"""The planner module in headless LinuxCNC, against the runner and the card:

    linuxcnc_test.py OWNER MODULE TRAMMEL [NAME...]

Without names: SHORT, and LONG where TRAMMEL_LONG is set. Needs root, for namespaces.
"""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
from headless import Headless  # noqa: E402

OWNER, MODULE, TRAMMEL = (str(pathlib.Path(name).resolve()) for name in sys.argv[1:4])
PULSES = 80  # per mm

EVERY_KIND = """G21 G90 G17 G64
F3000
G0 X8 Y3
G1 X10 Y4 Z1
G2 X14 Y8 I4 J0 F2400
G3 X14 Y8 I0 J-3 P2
G3 X10 Y12 Z3 I-4 J0 F3600
G61 G18
G3 X12 Z5 I2 K0 F1200
G19 G2 Y14 Z7 J2 K0
G17 G61.1
G1 X2 Y9.3 Z1.7 F3000
G64
G0 X0 Y0 Z0
M2
"""
LONG_WAY = "G21 G90 G17 G64\nF2400\n" + "".join(
    f"G1 X{8 if n % 2 == 0 else 0} Y{(n + 1) * 0.5}\n" for n in range(24)) + "M2\n"


def require(condition, text):
    if not condition:
        raise AssertionError(text)


def play(scenario, program="", surface=None, during=None, trammel=None, **more):
    run = Headless(OWNER, MODULE, scenario, program, surface, trammel, **more).start()
    try:
        if during:
            run.wait_for("moving")
            during(run)
    finally:
        seen, log = run.finish()
    require("failure" not in seen, seen)
    return seen, log


def of(log, kind):
    return [tuple(map(float, words[1:])) for words in log if words[0] == kind]


def runner_path(program):
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder) / "program.ngc"
        source.write_text(program)
        subprocess.run([OWNER, "--run", source, f"{folder}/path"], check=True)
        lines = (pathlib.Path(folder) / "path").read_text().splitlines()
    return of([line.split() for line in lines], "path")


def pulse_times(log):
    steps = of(log, "step")
    return [(axis, direction, cycle - steps[0][2]) for axis, direction, cycle in steps]


def path():
    """The sequence of (axis, direction) of the runner, and the end."""
    seen, log = play("program", EVERY_KIND)
    expected = runner_path(EVERY_KIND)
    require(len(expected) > 5000, "the runner made no path")
    require(of(log, "path") == expected, "another path than the runner's")
    require(seen["errors"] == [] and seen["position"] == [0, 0, 0], seen)
    return f"{len(expected)} steps; longest call {seen['longest_call']} ns, period {seen['longest_cycle']} ns"


def whole():
    """As path(), but with the HAL component and `trammel linuxcnc`, against `trammel run`."""
    seen, log = play("program", EVERY_KIND, trammel=TRAMMEL)
    made = [(int(words[3]), int(words[4])) for words in log if words[0] == "step"]
    expected = run_at_the_card(EVERY_KIND)
    require(len(expected) > 5000 and made == expected, f"another path: {len(made)} steps for {len(expected)}, {seen}")
    require(seen["errors"] == [] and seen["position"] == [0, 0, 0], seen)
    return f"{len(expected)} steps; longest call {seen['longest_call']} ns"


def whole_rtl():
    """As whole(), but with the Verilated card in lockstep with the model, at a clock at which it runs in real time."""
    clock = 100_000
    seen, log = play("program", EVERY_KIND, trammel=TRAMMEL, engine=("rtl", clock))
    made = [(int(words[3]), int(words[4])) for words in log if words[0] == "step"]
    expected = run_at_the_card(EVERY_KIND, clock)
    require(len(expected) > 5000 and made == expected, f"another path: {len(made)} steps for {len(expected)}, {seen}")
    require(seen["errors"] == [] and seen["position"] == [0, 0, 0], seen)
    return f"{len(expected)} steps at {clock / 1000:.0f} kHz"


def stop_realtime(run):
    process = run.realtime_process()
    for _ in range(3):
        os.kill(process, signal.SIGSTOP)
        time.sleep(0.3)
        os.kill(process, signal.SIGCONT)
        time.sleep(0.2)


def whole_stalls():
    """As stalls(), behind `trammel linuxcnc`."""
    def steps(log):
        made = [tuple(map(int, words[1:])) for words in log if words[0] == "step"]
        return [(axis, direction, clock - made[0][0]) for clock, _, axis, direction in made]
    quiet = steps(play("stalled", LONG_WAY, during=lambda run: None, trammel=TRAMMEL)[1])
    seen, log = play("stalled", LONG_WAY, during=stop_realtime, trammel=TRAMMEL)
    require(len(quiet) > 10_000 and steps(log) == quiet and seen["errors"] == [], f"steps at other times; {seen}")
    return f"{len(quiet)} steps, all in their clocks"


def stalls():
    """rtapi_app is stopped three times for 300 ms: the pulses come when they would have come."""
    quiet = play("stalled", LONG_WAY, during=lambda run: None)[1]
    seen, stalled = play("stalled", LONG_WAY, during=stop_realtime)
    times = pulse_times(quiet)
    require(times[-1][2] > 200_000 * 3, "the motion is too short for this test")
    require(pulse_times(stalled) == times, "pulses at other times")
    require(of(stalled, "end") == [(0, 0)] and seen["errors"] == [], (of(stalled, "end"), seen))
    return f"{len(times)} pulses in {times[-1][2] / 200_000:.2f} s, all in their clocks"


def probe():
    """LinuxCNC must take the probe's position from the card's capture, not from the time at which LinuxCNC saw the
    pin."""
    seen, log = play("probe", surface=-3)
    made = of(log, "probe")
    require(len(made) == 2 and made[0][0] == 1 and made[1][0] == 0, made)
    require(seen["tripped"] and not seen["missed"], seen)
    require(seen["probed"] == list(made[0][1:]), (seen, made))
    require(made[0][3] * PULSES == -3 * PULSES, f"the edge is at the surface: {made[0]}")
    require(seen["rest"][2] < made[0][3], "it stands behind the edge")
    return f"edge {made[0][3]} mm, rest {seen['rest'][2]} mm"


def pause_and_abort():
    seen, log = play("pause_and_abort", LONG_WAY)
    for what in ("held", "feed 0"):
        require(seen[what][0] == seen[what][1], f"{what}: it moved {seen[what]}")
    made = of(log, "path")
    whole = runner_path(LONG_WAY)
    same = next(n for n, (a, b) in enumerate(zip(made, whole)) if a != b)
    stopped = [sum(direction for axis, direction in made[:same] if axis == n) for n in range(3)]
    told = [round(value * PULSES) for value in seen["aborted"]]
    require(0 < same < len(whole), "the abort came too late")
    # The motion after the abort may begin with steps that equal those of the aborted path.
    require(all(abs(a - b) <= 40 for a, b in zip(stopped, told)), (stopped, told))
    require(seen["after"] == [1, 2, 3] and seen["errors"] == [], seen)
    return f"on the path up to step {same} of {len(whole)}"


OUTPUTS = """G21 G90 G17 G61
F1200
G0 X1
M3 S1000
G1 X4
M62 P1
M67 E0 Q2.5
G1 X8
M63 P1
M62 P2
G1 X12
M2
"""


def outputs():
    seen, _ = play("outputs", OUTPUTS)
    changes = [(out, analog) for out, analog, _ in seen["outputs"]]
    expected = [([0, 0, 0], 0), ([0, 1, 0], 2.5), ([0, 0, 1], 2.5)]
    require(changes == expected, seen)
    places = [place[0] for _, _, place in seen["outputs"][1:]]
    # At 20 mm/s; ui.py reads the position some milliseconds later.
    require(all(0 <= place - due < 1 for place, due in zip(places, (4, 8))), f"at {places}")
    require(seen.get("waited") == [[1, 0], [1, 0]], f"it did not wait for the spindle: {seen}")
    return f"switched at X {places[0]:.2f} and {places[1]:.2f}; the first feed waited for the spindle"


def owner_dies():
    seen, _ = play("owner_dies", LONG_WAY, during=lambda run: run.owner.kill())
    require(seen["disabled"], seen)
    require(any("does not answer" in error for error in seen["errors"]), seen)
    return seen["errors"][0].strip()


CARD_OUTPUTS = """G21 G90 G17 G64
F1200
G0 X1
G1 X4
M62 P1
G1 X8
M63 P1
M62 P2
G1 X12
M64 P0
G1 X14
M65 P0
G1 X15
M2
"""


def card_outputs():
    """M62 to M65 switch the card's outputs that the machine file names, at the right positions, and LinuxCNC's pins."""
    named = ["--set", "outputs.p0=3", "--set", "outputs.p1=[1, 2]"]  # P2 switches only LinuxCNC's pin
    seen, log = play("card_outputs", CARD_OUTPUTS, trammel=TRAMMEL, arguments=named)
    at, levels, changes, clocks = 0, 0, [], {}
    for words in log:
        if words[0] == "step":
            at += int(words[4])
            clocks[at] = int(words[1])
        elif words[0] == "output" and int(words[2]) != levels:
            levels = int(words[2])
            changes.append((levels, at / PULSES))
    require(changes == [(0b0110, 4), (0, 8), (0b1000, 12), (0, 14)], f"outputs and places in mm: {changes}")
    # M62 and M63 do not slow down the motion of 20 mm/s, which is 625 clocks per pulse; M64 and M65 stop it.
    gaps = {place: clocks[place * PULSES + 1] - clocks[place * PULSES] for place in (4, 8, 12, 14)}
    require(gaps[4] <= 640 and gaps[8] <= 640 and gaps[12] > 2000 and gaps[14] > 2000, f"clocks between steps: {gaps}")
    pins = [out for out, _, _ in seen["outputs"]]
    require(pins == [[0, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 0, 1]], f"LinuxCNC's pins: {pins}")
    require(seen["errors"] == [] and seen["position"] == [15, 0, 0], seen)
    return f"switched at {[place for _, place in changes]} mm"


def jogs():
    seen, _ = play("jogs", trammel=TRAMMEL)
    require(seen["counts"] == [PULSES, PULSES, 0] and seen["errors"] == [], seen)
    require(seen["position"] == [1, 1, 0], seen)
    require(max(abs(x - 0.337 * (n + 1)) for n, x in enumerate(seen["jogged"])) < 1 / PULSES, seen)
    return f"jogged to X {seen['jogged'][-1]:.4f}, then to pulse {seen['counts'][0]}"


INCHES = """G20 G90 G17 G64
F60
G0 X0.3 Y0.1
G1 X0.4 Y0.15 Z0.05
G2 X0.55 Y0.3 I0.15 J0 F90
G1 X0.1234 Y0.321 Z-0.0456
M2
"""


def run_at_the_card(program, clock=1_000_000):
    """Axis and direction of each step, as `trammel run` makes them."""
    with tempfile.TemporaryDirectory() as folder:
        file, steps = pathlib.Path(folder) / "program.ngc", pathlib.Path(folder) / "steps"
        file.write_text(program)
        subprocess.run([TRAMMEL, "run", file, "--engine", "model", "--clock", str(clock), "--path-steps", steps],
                       check=True, stdout=subprocess.DEVNULL)
        rows = [row.split(",") for row in steps.read_text().splitlines()]
    axis, direction = (rows[0].index(name) for name in ("axis", "direction"))
    return [(int(row[axis]), int(row[direction])) for row in rows[1:]]


def totals(steps):
    return [(sum(1 for a, _ in steps if a == axis), sum(d for a, d in steps if a == axis)) for axis in range(3)]


def inches():
    """A program in inches, on a machine in mm and on one in inches, must give the steps and the end position of
    `trammel run`."""
    expected = totals(run_at_the_card(INCHES))
    require(expected[0][1] == round(0.1234 * 25.4 * PULSES), f"{expected}")
    for units, arguments, changes, end in (("mm", (), (), [25.4 * v for v in (0.1234, 0.321, -0.0456)]),
                                           ("inch", ("--units", "inch"), inch_ini(), [0.1234, 0.321, -0.0456])):
        seen, log = play("program", INCHES, trammel=TRAMMEL, arguments=arguments, changes=changes)
        made = totals([(int(words[3]), int(words[4])) for words in log if words[0] == "step"])
        require(made == expected and seen["errors"] == [], f"LinuxCNC in {units}: {made}, not {expected}; {seen}")
        pulse = 1 / PULSES if units == "mm" else 1 / PULSES / 25.4
        require(all(abs(a - b) <= 0.51 * pulse for a, b in zip(seen["position"], end)), f"in {units}: {seen}")
    return f"{expected[0][0]}, {expected[1][0]} and {expected[2][0]} steps with both"


def inch_ini():
    lengths = [("LINEAR_UNITS = mm", "LINEAR_UNITS = inch"), ("_LINEAR_VELOCITY = 50", "_LINEAR_VELOCITY = 2"),
               ("_LINEAR_VELOCITY = 400", "_LINEAR_VELOCITY = 15.75"), ("LIMIT = 200", "LIMIT = 7.8"),
               ("LIMIT = -200", "LIMIT = -7.8"), ("ACCELERATION = 1000", f"ACCELERATION = {1000 / 25.4}"),
               ("FERROR = 1.0", "FERROR = 0.04"), ("FERROR = 0.5", "FERROR = 0.02")]
    return lengths + [(f"MAX_VELOCITY = {speed}\n", f"MAX_VELOCITY = {speed / 25.4}\n") for speed in (150, 100)]


def named_refusal(seen, words):
    errors = [error.strip() for error in seen["errors"] if words in error]
    require(errors, f"no message with {words!r}: {seen}")
    return errors[0]


def refusals():
    """Each refusal must appear as an error of LinuxCNC, and nothing may move."""
    seen, _ = play("refusals")
    told = [named_refusal(seen, "spindle-synchronous")]
    require(seen["position"] == [0, 0, 0], seen)
    seen, _ = play("refusals_under_way", LONG_WAY)
    told.append(named_refusal({"errors": seen["reverse"]}, "reverse run"))
    told.append(named_refusal({"errors": seen["negative"]}, "negative adaptive feed"))
    require(seen["stood"][0] == seen["stood"][1], f"it moved at a negative adaptive feed: {seen}")
    require(seen["end"] == [0, 12, 0], f"the program did not come to its end: {seen}")
    offsets = "setp axis.x.eoffset-enable 1\nsetp axis.x.eoffset-scale 0.001\n"
    seen, _ = play("external_offset", changes=[("[AXIS_X]\n", "[AXIS_X]\nOFFSET_AV_RATIO = 0.2\n")],
                   hal=offsets)
    told.append(named_refusal(seen, "external offsets"))
    require(seen["path"] == [0, 0], f"the path moved: {seen}")
    seen, _ = play("one_motion", changes=[("[JOINT_1]\n", "[JOINT_1]\nBACKLASH = 0.1\n")])
    told.append(named_refusal(seen, "backlash"))
    seen, _ = play("one_motion", changes=[("KINEMATICS = trivkins", "KINEMATICS = rotatekins")])
    told.append(named_refusal(seen, "kinematics"))
    return "; ".join(told)


SHORT = (path,)
LONG = (whole, whole_rtl, whole_stalls, stalls, probe, pause_and_abort, outputs, card_outputs, jogs, inches, owner_dies, refusals)


def main():
    if os.geteuid() != 0:
        print("needs root, for namespaces of its own")
        return 77
    namespaces = ["unshare", "--mount", "--ipc", "--net", "--pid", "--fork", "--mount-proc", "true"]
    if subprocess.run(namespaces, capture_output=True).returncode != 0:
        print(f"this system does not allow {' '.join(namespaces)}")
        return 77
    names = sys.argv[4:]
    tests = [test for test in SHORT + LONG if test.__name__ in names] if names else \
        SHORT + (LONG if os.environ.get("TRAMMEL_LONG") else ())
    failed = 0
    for test in tests:
        began = time.monotonic()
        try:
            text = f"ok      {test.__name__}: {test()}"
        except (AssertionError, RuntimeError, StopIteration) as error:
            text = f"FAILED  {test.__name__}: {error}"
            failed += 1
        print(f"{text} ({time.monotonic() - began:.1f} s)", flush=True)
    return failed


sys.exit(main())
