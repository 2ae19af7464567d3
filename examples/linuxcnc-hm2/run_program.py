#!/usr/bin/python3
"""In place of a screen: homes, runs program.ngc to its end, and prints where the machine stands."""
import pathlib
import sys
import time

import hal
import linuxcnc

command, status, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()


def tell_errors():
    while True:
        error = errors.poll()
        if not error:
            return
        print("message:", error[1], flush=True)


def wait(holds, seconds, what):
    end = time.monotonic() + seconds
    while True:
        status.poll()
        tell_errors()
        if holds():
            return
        if time.monotonic() > end:
            print(f"failed: {what}: not within {seconds} s", flush=True)
            sys.exit(1)
        time.sleep(0.02)


def pin(name):
    return hal.get_value("hm2_tram.0." + name)


def main():
    component = hal.component("run-program")
    component.ready()
    time.sleep(0.5)
    command.state(linuxcnc.STATE_ESTOP_RESET)
    wait(lambda: status.task_state != linuxcnc.STATE_ESTOP, 5, "emergency stop reset")
    command.state(linuxcnc.STATE_ON)
    wait(lambda: status.task_state == linuxcnc.STATE_ON, 5, "machine on")
    command.mode(linuxcnc.MODE_MANUAL)
    command.wait_complete()
    for joint in range(3):
        command.home(joint)
    wait(lambda: status.homed[:3] == (1, 1, 1), 10, "homing")
    command.mode(linuxcnc.MODE_AUTO)
    command.wait_complete()
    command.program_open(str(pathlib.Path(__file__).resolve().parent / "program.ngc"))
    command.wait_complete()
    command.auto(linuxcnc.AUTO_RUN, 0)
    wait(lambda: status.interp_state != linuxcnc.INTERP_IDLE, 5, "the program's begin")
    wait(lambda: status.interp_state == linuxcnc.INTERP_IDLE and status.inpos and status.queue == 0, 90, "the program's end")
    time.sleep(0.5)
    status.poll()
    tell_errors()
    print("machine on:", status.task_state == linuxcnc.STATE_ON)
    print("commanded:", *(f"{p:.6f}" for p in status.position[:3]))
    print("actual:", *(f"{p:.6f}" for p in status.actual_position[:3]))
    print("packet errors:", pin("packet-error-total"), "io_error:", pin("io_error"), "bitten:", pin("watchdog.has_bit"), flush=True)


main()
