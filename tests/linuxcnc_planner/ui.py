#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""LinuxCNC's user interface in the tests: plays the scenario that the file `scenario` names, writes result.json."""

import pathlib
import time

import hal
import linuxcnc

from linuxcnc_ui import command, idle, mdi, mode, play, poll, result, start_program, stat, until, wait_idle

component = hal.component("planner-ui")
component.newpin("touches", hal.HAL_BIT, hal.HAL_OUT)
component.newpin("at-speed", hal.HAL_BIT, hal.HAL_OUT)
component.newpin("adaptive", hal.HAL_FLOAT, hal.HAL_OUT)
component.newpin("counts", hal.HAL_S32, hal.HAL_OUT)
component.ready()
names = {pin["NAME"] for pin in hal.get_info_pins()}
component["at-speed"] = True
component["adaptive"] = 1
hal.connect("planner-ui.at-speed", "at-speed")


def connect(pin, signal, kind, target):
    """Connects a pin for a scenario, because the HAL file runs before this component exists."""
    hal.new_sig(signal, kind)
    hal.connect(f"planner-ui.{pin}", signal)
    hal.connect(target, signal)


def linked():
    """Whether owner and modules are connected; without the HAL component there is only one link."""
    links = [pin for pin in ("trammel-planner.link-ok", "trammel.link-ok") if pin in names]
    return all(hal.get_value(pin) for pin in links)


def switch_on():
    until(linked, 20, "the link to the owner")
    command.state(linuxcnc.STATE_ESTOP_RESET)
    command.wait_complete()
    command.state(linuxcnc.STATE_ON)
    command.wait_complete()
    mode(linuxcnc.MODE_MANUAL)
    command.home(-1)
    until(lambda: all(stat.homed[:3]), 20, "homed")


def run_program(seconds=90):
    start_program()
    wait_idle(seconds)


def program():
    run_program()


def stalled():
    """The test stops the realtime process while the motion goes on."""
    start_program()
    until(lambda: stat.position[1] > 0.5, 20, "moving")
    pathlib.Path("moving").touch()
    wait_idle(90)


def probe():
    hal.connect("planner-ui.touches", "probe")
    mode(linuxcnc.MODE_MDI)
    command.mdi("G38.2 Z-10 F120")
    until(lambda: stat.position[2] <= -3, 20, "on the way")
    component["touches"] = True
    wait_idle()
    result["probed"] = list(stat.probed_position[:3])
    result["tripped"] = stat.probe_tripped
    result["rest"] = list(stat.position[:3])
    component["touches"] = False
    mdi("G0 Z0")
    mode(linuxcnc.MODE_MDI)
    command.mdi("G38.3 Z-1 F600")
    command.wait_complete(20)
    wait_idle()
    result["missed"] = stat.probe_tripped


def pause_and_abort():
    start_program()
    until(lambda: stat.position[1] > 1, 20, "moving")
    command.auto(linuxcnc.AUTO_PAUSE)
    until(lambda: stat.paused and stat.current_vel < 1e-6, 20, "paused")
    held = list(stat.position[:3])
    time.sleep(0.5)  # no event to wait for: no motion may come
    poll()
    result["held"] = [held, list(stat.position[:3])]
    command.auto(linuxcnc.AUTO_RESUME)
    until(lambda: stat.position[1] > held[1] + 0.5, 20, "resumed")
    command.feedrate(0)
    until(lambda: stat.current_vel < 1e-6, 20, "feed 0")
    held = list(stat.position[:3])
    time.sleep(0.3)
    poll()
    result["feed 0"] = [held, list(stat.position[:3])]
    command.feedrate(1)
    until(lambda: stat.position[1] > held[1] + 0.5, 20, "feed 1")
    command.abort()
    command.wait_complete()
    wait_idle()
    result["aborted"] = list(stat.position[:3])
    mdi("G0 X1 Y2 Z3")
    result["after"] = list(stat.position[:3])


def outputs():
    """M62 to M67 act at the right positions, and the first feed waits for the spindle."""
    component["at-speed"] = False
    start_program()
    seen = []
    at_rest_until_speed = None
    while not idle():
        poll()
        now = [list(stat.dout[:3]), round(stat.aout[0], 3)]
        if not seen or seen[-1][:2] != now:
            seen.append([*now, list(stat.position[:2])])
        if stat.spindle[0]["enabled"] and not component["at-speed"]:
            if at_rest_until_speed is None:
                at_rest_until_speed = [time.monotonic(), list(stat.position[:2])]
            elif time.monotonic() - at_rest_until_speed[0] > 1:
                result["waited"] = [at_rest_until_speed[1], list(stat.position[:2])]
                component["at-speed"] = True
        time.sleep(0.002)
    result["outputs"] = seen


def card_outputs():
    start_program()
    seen = []
    while not idle():
        poll()
        now = [list(stat.dout[:3]), 0]
        if not seen or seen[-1][:2] != now:
            seen.append([*now, list(stat.position[:2])])
        time.sleep(0.002)
    result["outputs"] = seen


def jogs():
    """Jogs end between two pulses; the motions after them start on a pulse, and the differences do not add up."""
    for n in range(5):
        mode(linuxcnc.MODE_MANUAL)
        command.teleop_enable(1)
        command.wait_complete()
        start = stat.position[0]
        command.jog(linuxcnc.JOG_INCREMENT, 0, 0, 3, 0.337)
        until(lambda: abs(stat.position[0] - start - 0.337) < 1e-5 and stat.axis[0]["velocity"] == 0 and stat.inpos, 20,
              "jogged")
        until(lambda: abs(stat.actual_position[0] - stat.position[0]) < 0.02, 20, "the card is there")
        result.setdefault("jogged", []).append(stat.position[0])
        mdi(f"G1 F600 Y{n}")
    mdi("G0 X1 Y1 Z0")
    result["counts"] = [hal.get_value(f"trammel.joint.{n:02d}.counts") for n in range(3)]


def owner_dies():
    start_program()
    until(lambda: stat.position[1] > 0.5, 20, "moving")
    pathlib.Path("moving").touch()
    until(lambda: not stat.enabled, 20, "disabled")
    result["disabled"] = True


def refusals():
    for text in ("G1 F600 X1", "M3 S1000", "G33 X2 K1", "G0 X0"):
        mdi(text, 10)
    result["position"] = list(stat.position[:3])


def refusals_under_way():
    """A reverse run is refused, and the path continues; a negative adaptive feed stops it."""
    connect("adaptive", "adaptive", hal.HAL_FLOAT, "motion.adaptive-feed")
    mdi("M52 P1")
    start_program()
    until(lambda: stat.position[1] > 1, 20, "moving")
    command.auto(linuxcnc.AUTO_PAUSE)
    until(lambda: stat.paused and stat.current_vel < 1e-6, 20, "paused")
    command.auto(linuxcnc.AUTO_REVERSE)
    until(lambda: result["errors"], 10, "a message of the reverse run")
    result["reverse"], result["errors"] = list(result["errors"]), []
    command.auto(linuxcnc.AUTO_FORWARD)
    command.auto(linuxcnc.AUTO_RESUME)
    at = stat.position[1]
    until(lambda: stat.position[1] > at + 0.5, 20, "resumed")
    component["adaptive"] = -0.5
    until(lambda: result["errors"], 10, "a message of the adaptive feed")
    result["negative"], result["errors"] = list(result["errors"]), []
    until(lambda: stat.current_vel < 1e-6, 20, "standing")
    held = list(stat.position[:3])
    time.sleep(0.3)  # no motion may come
    poll()
    result["stood"] = [held, list(stat.position[:3])]
    component["adaptive"] = 1
    wait_idle(90)
    result["end"] = [round(value, 6) for value in stat.position[:3]]


def external_offset():
    connect("counts", "offset", hal.HAL_S32, "axis.x.eoffset-counts")
    component["counts"] = 1000  # 1 mm
    until(lambda: abs(hal.get_value("axis.x.eoffset") - 1) < 1e-6, 20, "the offset is applied")
    one_motion()
    result["path"] = [round(value, 6) for value in stat.position[1:3]]


def one_motion():
    mode(linuxcnc.MODE_MDI)
    command.mdi("G0 Y1")
    until(lambda: result["errors"], 10, "a message")


def measures():
    result["position"] = list(stat.position[:3])
    result["longest_call"] = hal.get_value("trammel-planner.longest-call")
    result["longest_cycle"] = hal.get_value("trammel-planner.longest-cycle")
    result["stale"] = hal.get_value("trammel-planner.stale-copies")


time.sleep(0.2)
play(globals(), switch_on, measures)
