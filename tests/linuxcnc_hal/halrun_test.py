#!/usr/bin/env python3
"""The component `trammel` in halrun, at 1 kHz: three joints follow signal generators on a simulated card;
hold, index edge, watchdog.

    halrun_test.py TRAMMEL MODULES [TEST ...]
"""

import math
import os
import signal
import sys
import time

from bench import PERIOD, USER, Bench, Spoiled, check, run_tests, stalled, wait_until
from record import Record

TRAMMEL, MODULES = sys.argv[1:3]
LEAD = 30
AMPLITUDE, FREQUENCY = 4, 1  # mm, Hz: of joint 0
FASTEST = 2 * math.pi * FREQUENCY * (1 + 2 / 8) * AMPLITUDE  # mm/s; joint 2: 31 mm/s, with 250 mm/s^2
HAL = """loadrt threads name1=servo period1={period}
loadrt trammel name={name} joints=3
loadrt siggen num_chan=3
loadrt sum2 names=error-0,error-1,error-2
loadrt minmax names=most
addf trammel.read servo
addf error-0 servo
addf error-1 servo
addf error-2 servo
addf most servo
addf siggen.0.update servo
addf siggen.1.update servo
addf siggen.2.update servo
addf trammel.write servo
setp trammel.lead-periods {lead}
net error error-0.out => most.in
"""
JOINT = """setp siggen.{n}.amplitude {amplitude}
setp siggen.{n}.frequency {frequency}
setp trammel.joint.0{n}.maxaccel 1000
setp trammel.joint.0{n}.maxvel 60
net command-{n} siggen.{n}.{shape} => trammel.joint.0{n}.position-cmd error-{n}.in1
net feedback-{n} trammel.joint.0{n}.position-fb => error-{n}.in0
setp error-{n}.gain1 -1
"""


def script(name):
    text = HAL.format(period=PERIOD, name=name, lead=LEAD)
    for n, shape in enumerate(("sine", "cosine", "sine")):
        text += JOINT.format(n=n, shape=shape, amplitude=AMPLITUDE, frequency=FREQUENCY * (1 + n / 8))
    return text + "start\nloadusr -w python3 drive.py\n"


def start(bench, scenario, *arguments):
    bench.write("scenario", scenario)
    bench.write("drive.hal", script(bench.name))
    owner = bench.start_owner(*bench.simulated(), *arguments)
    bench.start(["halrun", "drive.hal"])
    return owner


def follows():
    """Three joints follow their generators. A hold stops them on the path, and no step is lost."""
    with Bench(TRAMMEL, MODULES) as bench:
        start(bench, "follow")
        result = bench.finish(40, LEAD)
        late = result["underrun"] or result["refused"] or result["late"] or result["fault"]
        if late and stalled(result, LEAD):
            raise Spoiled(f"{result}")
        check(not late and result["link-ok"], f"{result}")
        # The reported latency is at most the lead, plus two periods, plus two that the owner tolerates, plus measured
        # pauses: those of the owner, and the time that LinuxCNC's thread caught up after it was late. The feedback lags
        # by at most the reported latency times the speed of the fastest joint.
        record = Record(bench.folder / "record")
        caught_up = record.caught_up(PERIOD)
        paused = (max(result["longest-period"], caught_up) + result["longest-silence"]) * 1e-9
        told = result["longest latency"]
        check(told <= (LEAD + 4) * PERIOD * 1e-9 + paused, f"a latency of {told} s, with pauses of {paused} s")
        allowed = FASTEST * (told + 4 * PERIOD * 1e-9 + paused) + 1 / 80
        check(result["furthest"] <= allowed, f"the feedback was {result['furthest']} mm behind, more than {allowed}")
        check(result["furthest"] >= FASTEST * (LEAD - 2) * PERIOD * 1e-9, f"only {result['furthest']} mm behind")
        check(result["held"][0] == result["held"][1], f"it moved in the hold: {result['held']}")
        print(record.judge(3000, LEAD))
        net = [record.net.get(axis, 0) for axis in range(3)]
        check(net == result["counts"], f"the card made {net} pulses and told {result['counts']}")
        print(f"feedback behind by {result['furthest'] / FASTEST * 1000:.1f} ms at most, latency told "
              f"{told * 1000:.1f} ms; the thread made up for {caught_up / 1e6:.1f} ms; {result}")


def linuxcnc_first():
    """LinuxCNC's rtapi_app, which has root's rights, creates the shared memory as the user who runs it; the owner
    starts later."""
    with Bench(TRAMMEL, MODULES) as bench:
        bench.write("scenario", "begin_and_end")
        bench.write("drive.hal", script(bench.name))
        bench.hand_over()
        bench.start(["halrun", "drive.hal"])
        wait_until(bench.memory.exists, 20, "the shared memory")
        found = bench.memory.stat()
        check(bench.memory.owner() == USER and found.st_mode & 0o777 == 0o600, f"made as {found}")
        bench.start_owner(*bench.simulated())
        result = bench.finish(40, LEAD)
        check(not result["underrun"] and any(result["counts"]), f"{result}")


INDEX_AT = 2  # mm
WORLD = f"""
[switch.x_index]
input = 7
axis = "x"
above = {INDEX_AT}
normally = "open"
release = 0.0125
bounce = 0
"""


def index():
    """The index edge that the card captures becomes the joint's zero."""
    with Bench(TRAMMEL, MODULES) as bench:
        bench.write("world.toml", bench.text("world.toml") + WORLD)
        machine = bench.text("machine.toml")
        check("x_limit_plus = 1" in machine, "machine.toml has no [inputs] to add to")
        bench.write("machine.toml", machine.replace("x_limit_plus = 1", "x_limit_plus = 1\nx_index = 7"))
        start(bench, "index")
        result = bench.finish(40, LEAD)
        zeros = [round(zero, 6) for zero in result["zeros"]]
        # The carriage, which lags its motor field by a pulse, closes the switch. A delay of the captured position by 1
        # ms would show as two pulses.
        check(0 <= zeros[0] - 80 * INDEX_AT <= 1 and zeros[1:] == [0, 0], f"zeros at pulses {zeros}")
        print(f"zeros at pulses {zeros}; {result}")


def watchdog():
    """The owner is stopped for longer than the card's watchdog allows: has_bit rises, and clearing it releases the
    stop."""
    with Bench(TRAMMEL, MODULES) as bench:
        owner = start(bench, "watchdog", "--set", "motion.watchdog=0.4")
        bench.wait_for("following")
        os.kill(owner.pid, signal.SIGSTOP)
        time.sleep(1)  # the injected fault itself
        os.kill(owner.pid, signal.SIGCONT)
        result = bench.finish(40)
        check(not result["bitten before"], "the watchdog had bitten before")
        check(result["bitten"] == [True, True], f"bitten, fault: {result['bitten']}")
        check(result["cleared"] == [False, False, 0], f"bitten, fault, cause behind has_bit = 0: {result['cleared']}")
        print(f"stop-cause {result['stop-cause behind the bite']}; {result}")


named = {test.__name__: test for test in (follows, linuxcnc_first, index, watchdog)}
run_tests([named[name] for name in sys.argv[3:] or named], MODULES)
