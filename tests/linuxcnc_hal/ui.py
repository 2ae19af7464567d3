#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""LinuxCNC's user interface in the tests: plays the scenario that the file `scenario` names, writes result.json."""

import pathlib
import time

import hal
import linuxcnc

from linuxcnc_ui import command, idle, mode, play, poll, result, start_program, stat, until, wait_idle
import linuxcnc_ui

component = hal.component("test-ui")  # hal.get_value() needs a component
component.ready()


def pin(name):
    return hal.get_value("trammel." + name)


def position():
    return [round(value, 4) for value in stat.actual_position[:3]]


def at(*place, tolerance=0.02):
    return all(abs(a - b) <= tolerance for a, b in zip(stat.actual_position, place))


def switch_on():
    until(lambda: pin("link-ok"), 20, "link-ok")
    command.state(linuxcnc.STATE_ESTOP_RESET)
    until(lambda: stat.task_state != linuxcnc.STATE_ESTOP, 10, "out of the emergency stop")
    command.state(linuxcnc.STATE_ON)
    until(lambda: stat.task_state == linuxcnc.STATE_ON, 10, "machine on")


def home():
    mode(linuxcnc.MODE_MANUAL)
    command.teleop_enable(0)
    command.wait_complete()
    command.home(-1)
    until(lambda: stat.homed[:3] == (1, 1, 1), 25, "homed")
    wait_idle()
    standing()
    result["home"] = position()


def jog(axis, distance, speed):
    mode(linuxcnc.MODE_MANUAL)
    command.teleop_enable(1)
    command.wait_complete()
    start = stat.position[axis]
    command.jog(linuxcnc.JOG_INCREMENT, 0, axis, speed, distance)
    until(lambda: abs(stat.position[axis] - start - distance) < 1e-6 and stat.inpos, 20, "jogged")
    standing()


def mdi(text, seconds=60):
    linuxcnc_ui.mdi(text, seconds)
    standing()


def prepare():
    switch_on()
    home()


def standing():
    """Whether the card is at rest: the same counts for 50 ms, because no signal tells that no more motion comes."""
    seen, since = None, time.monotonic()
    end = since + 10
    while time.monotonic() - since < 0.05:
        poll()
        counts = [pin(f"joint.{n:02d}.counts") for n in range(3)]
        if counts != seen:
            seen, since = counts, time.monotonic()
        if time.monotonic() > end:
            raise RuntimeError("the card does not stand")
        time.sleep(0.002)
    return seen


def short():
    prepare()
    jog(0, 3, 40)
    result["jogged"] = position()
    start_program("G21 G90 G17 G64 P0.02\nG0 X8 Y4 Z-4\nG1 F3000 X14\nG3 X18 Y8 I0 J4\nG2 X22 Y12 I4 J0\n"
                  "G1 Z-8\nG38.2 Z-30 F900\nG0 Z-6\nG1 X10 Y10\nM2\n")
    wait_idle()
    standing()
    result["probed"] = [stat.probe_tripped, round(stat.probed_position[2], 4)]
    result["program"] = position()
    mode(linuxcnc.MODE_MDI)
    command.mdi("G1 F1200 X40")
    until(lambda: stat.actual_position[0] > 12, 10, "on the way")
    command.auto(linuxcnc.AUTO_PAUSE)
    until(lambda: stat.paused and stat.current_vel == 0, 10, "held")
    result["held"] = standing() == standing() and stat.actual_position[0] < 39
    command.auto(linuxcnc.AUTO_RESUME)
    until(lambda: stat.actual_position[0] > 18, 10, "resumed")
    command.abort()
    command.wait_complete()
    wait_idle()
    standing()
    result["aborted"] = position()
    mdi("G0 X20 Y15 Z-2")
    result["end"] = position()
    mode(linuxcnc.MODE_MDI)
    command.mdi("G1 F1800 X60")
    until(lambda: stat.actual_position[0] > 24, 10, "on the way")
    command.state(linuxcnc.STATE_ESTOP)
    until(lambda: stat.task_state == linuxcnc.STATE_ESTOP and not stat.enabled, 10, "emergency stop")
    standing()
    result["stopped"] = position()
    result["homed after"] = list(stat.homed[:3])
    switch_on()
    mdi("G0 X0 Y0 Z0")
    result["back"] = position()


PROGRAM = ("G21 G90 G17 G64 P0.02\nG0 X8 Y4 Z-4\nG1 F3000 X14\nG3 X18 Y8 I0 J4\nG2 X22 Y12 I4 J0\nG1 Z-8\n"
           "G0 Z-6\nG1 X10 Y10\nM2\n")


def dropped():
    hal.set_p("trammel.test-drop-one-in", "100")
    prepare()
    start_program(PROGRAM)
    wait_idle()
    standing()
    result["program"] = position()


def index_and_hold():
    """X homes to its index mark; then the card holds during a motion, while LinuxCNC's command goes on."""
    prepare()
    result["index"] = hal.get_value("trammel.joint.00.index-enable")
    result["homed at"] = standing()
    mode(linuxcnc.MODE_MDI)
    command.mdi("G1 F1200 X60")
    until(lambda: stat.actual_position[0] > 12, 10, "on the way")
    hal.set_p("trammel.hold", "1")
    until(lambda: pin("held"), 5, "held")
    seen, commanded = [pin("joint.00.counts")], stat.position[0]
    until(lambda: stat.position[0] > commanded + 2, 5, "the command goes on")  # 2 mm, 0.1 s
    result["held"] = seen + [pin("joint.00.counts")]
    hal.set_p("trammel.hold", "0")
    until(lambda: not pin("held"), 5, "released")
    wait_idle()
    standing()
    result["behind the hold"] = position()


def move_far():
    prepare()
    mode(linuxcnc.MODE_MDI)
    command.mdi("G1 F1800 X60")
    until(lambda: stat.actual_position[0] > 10, 10, "on the way")
    pathlib.Path("moving").touch()


def long_move():
    move_far()
    wait_idle()
    standing()


def machine_off():
    result["read before"], result["write before"] = pin("longest-read"), pin("longest-write")
    until(lambda: stat.task_state == linuxcnc.STATE_ESTOP and not stat.enabled, 20, "machine off")
    result["off"] = not any(hal.get_value(f"joint.{n}.amp-enable-out") for n in range(3))


def killed_only():
    move_far()
    machine_off()


def killed():
    move_far()
    machine_off()
    pathlib.Path("off").touch()
    until(lambda: pin("link-ok"), 20, "a new owner")
    result["new owner"] = standing()


def measures():
    for name in ("longest-read", "longest-write", "longest-period", "longest-silence", "underrun", "late", "dropped", "refused",
                 "packet-error-total", "latency", "lead-periods", "stop-cause"):
        result[name] = pin(name)
    result["counts"] = [pin(f"joint.{n:02d}.counts") for n in range(3)]
    result["position"] = position()


play(globals(), lambda: None, measures)
