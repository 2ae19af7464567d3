#!/usr/bin/env python3
"""LinuxCNC's user interface in the tests: plays the scenario that the file `scenario` names, writes result.json."""

import json
import pathlib
import time

import hal
import linuxcnc

command = linuxcnc.command()
stat = linuxcnc.stat()
errors = linuxcnc.error_channel()
result = {"errors": []}
component = hal.component("planner-ui")
component.newpin("touches", hal.HAL_BIT, hal.HAL_OUT)
component.newpin("at-speed", hal.HAL_BIT, hal.HAL_OUT)
component.ready()
component["at-speed"] = True
hal.connect("planner-ui.at-speed", "at-speed")


def poll():
    stat.poll()
    while (error := errors.poll()) is not None:
        result["errors"].append(error[1])


def until(condition, seconds=30, what=""):
    end = time.monotonic() + seconds
    while True:
        poll()
        if condition():
            return
        if time.monotonic() > end:
            raise RuntimeError(f"timeout: {what} errors {result['errors']}")
        time.sleep(0.002)


def idle():
    return stat.interp_state == linuxcnc.INTERP_IDLE and stat.inpos and stat.queue == 0


def wait_idle(seconds=60):
    until(idle, seconds, "idle")


def mode(value):
    command.mode(value)
    command.wait_complete()


def switch_on():
    command.state(linuxcnc.STATE_ESTOP_RESET)
    command.wait_complete()
    command.state(linuxcnc.STATE_ON)
    command.wait_complete()
    mode(linuxcnc.MODE_MANUAL)
    command.home(-1)
    until(lambda: all(stat.homed[:3]), 20, "homed")


def mdi(text, seconds=60):
    mode(linuxcnc.MODE_MDI)
    command.mdi(text)
    command.wait_complete(seconds)
    wait_idle(seconds)


def start_program():
    mode(linuxcnc.MODE_AUTO)
    command.program_open(str(pathlib.Path("program.ngc").resolve()))
    command.wait_complete()
    command.auto(linuxcnc.AUTO_RUN, 0)
    until(lambda: not idle(), 10, "started")


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
    time.sleep(0.5)  # nothing to wait for: nothing may come
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
    """M62 to M67 in their places, and the first feed waits for the spindle."""
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


def main():
    scenario = pathlib.Path("scenario").read_text().strip()
    time.sleep(0.2)
    try:
        switch_on()
        globals()[scenario]()
    except Exception as error:  # the test tells it
        result["failure"] = repr(error)
    poll()
    result["position"] = list(stat.position[:3])
    result["longest_call"] = hal.get_value("trammel-planner.longest-call")
    result["longest_cycle"] = hal.get_value("trammel-planner.longest-cycle")
    result["stale"] = hal.get_value("trammel-planner.stale-copies")
    pathlib.Path("result.json").write_text(json.dumps(result))


main()
