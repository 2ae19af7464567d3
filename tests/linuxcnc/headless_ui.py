#!/usr/bin/env python3
"""LinuxCNC's user interface in the test: homes, jogs, runs a program, probes, pauses, aborts, presses the emergency
stop. Writes what it saw to result.json."""

import json
import time

import hal
import linuxcnc

command, status, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
result = {"errors": []}
component = hal.component("test-ui")
component.ready()


def poll():
    status.poll()
    while True:
        error = errors.poll()
        if not error:
            return
        result["errors"].append(error[1])


def wait_for(what, condition, seconds=30):
    end = time.monotonic() + seconds
    while True:
        poll()
        if condition():
            return
        if time.monotonic() > end:
            raise TimeoutError(f"{what}: state {status.task_state}, homed {status.homed[:3]}, "
                               f"at {status.position[:3]}, ready {pin('ready')}, link {pin('link-ok')}, "
                               f"errors {result['errors']}")
        time.sleep(0.005)


def idle():
    return status.interp_state == linuxcnc.INTERP_IDLE and status.inpos and status.queue == 0


def pin(name):
    return hal.get_value("trammel.0." + name)


def power_on():
    wait_for("link", lambda: pin("link-ok"))
    command.state(linuxcnc.STATE_ESTOP_RESET)
    wait_for("reset", lambda: status.task_state != linuxcnc.STATE_ESTOP)
    command.state(linuxcnc.STATE_ON)
    wait_for("on", lambda: status.task_state == linuxcnc.STATE_ON)


def mode(wanted):
    """LinuxCNC ignores it while it takes a jog to go on."""
    def is_in_it():
        if status.task_mode != wanted:
            command.mode(wanted)
            command.wait_complete()
            poll()
        return status.task_mode == wanted
    wait_for("mode", is_in_it)


def mdi(line):
    mode(linuxcnc.MODE_MDI)
    command.mdi(line)
    wait_for("begin of " + line, lambda: not idle() or status.command == line)
    wait_for("end of " + line, idle)


def home():
    mode(linuxcnc.MODE_MANUAL)
    command.teleop_enable(0)
    command.wait_complete()
    command.home(-1)
    wait_for("homed", lambda: all(status.homed[:3]), 60)
    wait_for("rest", lambda: status.inpos)


def jog():
    command.teleop_enable(1)
    command.wait_complete()
    wait_for("teleop", lambda: status.motion_mode == linuxcnc.TRAJ_MODE_TELEOP)
    before = status.position[0]
    command.jog(linuxcnc.JOG_INCREMENT, False, 0, 40, 3.0)
    wait_for("jog", lambda: abs(status.position[0] - before - 3) < 1e-3 and status.inpos)
    command.jog(linuxcnc.JOG_INCREMENT, False, 0, 40, -3.0)
    wait_for("jog back", lambda: abs(status.position[0] - before) < 1e-3 and status.inpos)


def program():
    mode(linuxcnc.MODE_AUTO)
    command.program_open("part.ngc")
    command.auto(linuxcnc.AUTO_RUN, 0)
    wait_for("motion", lambda: status.current_vel > 5)
    command.auto(linuxcnc.AUTO_PAUSE)
    wait_for("feed hold", lambda: status.paused and status.current_vel == 0)
    command.auto(linuxcnc.AUTO_RESUME)
    wait_for("end of the program", idle, 60)
    result["end"] = status.position[:3]


def probe():
    mdi("G0 Z-15")
    mdi("G38.2 Z-30 F120")
    result["probed"] = status.probed_position[2]
    result["captured"] = pin("stepgen.02.probe-position")
    mdi("G0 Z0")


def abort():
    mode(linuxcnc.MODE_MDI)
    command.mdi("G1 X60 F3000")
    wait_for("motion", lambda: status.current_vel > 20)
    command.abort()
    wait_for("abort", lambda: idle() and status.current_vel == 0)
    result["aborted"] = status.position[0]


def emergency_stop():
    mode(linuxcnc.MODE_MDI)
    command.mdi("G1 X0 F3000")
    wait_for("motion", lambda: status.current_vel > 20)
    command.state(linuxcnc.STATE_ESTOP)
    wait_for("stop", lambda: status.task_state == linuxcnc.STATE_ESTOP and pin("at-rest"))
    power_on()
    result["homed_behind_stop"] = list(status.homed[:3])
    mdi("G0 X0 Y0")


def main():
    try:
        wait_for("LinuxCNC", lambda: status.echo_serial_number is not None)
        for step in (power_on, home, jog, program, probe, abort, emergency_stop):
            began = time.monotonic()
            step()
            result[step.__name__ + "_seconds"] = round(time.monotonic() - began, 2)
        result["actual"] = status.actual_position[:3]
        for name in ("underrun", "late", "dropped", "refused", "longest-read", "longest-write", "stop-cause"):
            result[name] = pin(name)
        result["passed"] = True
    except Exception as error:  # whatever it is, the test must see it
        result["failed"] = repr(error)
    json.dump(result, open("result.json", "w"), indent=1)


main()
