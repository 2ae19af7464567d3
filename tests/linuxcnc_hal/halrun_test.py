#!/usr/bin/env python3
"""The component `trammel` in halrun, at 1 kHz: three joints follow signal generators on a simulated card.

    halrun_test.py TRAMMEL MODULES
"""

import math
import sys

from bench import PERIOD, Bench, check, run_tests, stalled
from record import Record

TRAMMEL, MODULES = sys.argv[1:3]
LEAD = 30
AMPLITUDE, FREQUENCY = 4, 1  # mm, Hz: of joint 0
FASTEST = 2 * math.pi * FREQUENCY * (1 + 2 / 8) * AMPLITUDE  # mm/s, of joint 2: 31 mm/s, at 250 mm/s^2
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


def follows():
    with Bench(TRAMMEL, MODULES) as bench:
        bench.write("follow.hal", script(bench.name))
        bench.start_owner(*bench.simulated())
        bench.start(["halrun", "follow.hal"])
        try:
            result = bench.finish(40)
        except RuntimeError as error:
            return f"{error}"
        late = result["underrun"] or result["refused"] or result["late"] or result["fault"]
        if late and stalled(result, LEAD):
            return f"the machine stalled: {result}"
        check(not late and result["link-ok"], f"{result}")
        # The stated latency is that of the periods ahead, two more, and two that the owner lets stand; what LinuxCNC's
        # thread and the owner paused, as measured, comes on top. The feedback trails by no more than the latency told,
        # at the speed of the fastest joint.
        paused = (result["longest-period"] + result["longest-silence"]) * 1e-9
        told = result["longest latency"]
        check(told <= (LEAD + 4) * PERIOD * 1e-9 + paused, f"a latency of {told} s, with pauses of {paused} s")
        allowed = FASTEST * (told + 4 * PERIOD * 1e-9 + paused) + 1 / 80
        check(result["furthest"] <= allowed, f"the feedback was {result['furthest']} mm behind, more than {allowed}")
        check(result["furthest"] >= FASTEST * (LEAD - 2) * PERIOD * 1e-9, f"only {result['furthest']} mm behind")
        record = Record(bench.folder / "record")
        print(record.judge(3000, LEAD))
        net = [record.net.get(axis, 0) for axis in range(3)]
        check(net == result["counts"], f"the card made {net} pulses and told {result['counts']}")
        print(f"feedback behind by {result['furthest'] / FASTEST * 1000:.1f} ms at most, latency told "
              f"{result['longest latency'] * 1000:.1f} ms; {result}")


run_tests([follows], MODULES)
