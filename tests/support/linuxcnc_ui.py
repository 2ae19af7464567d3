# SPDX-License-Identifier: GPL-2.0-only
"""The part of LinuxCNC's user interface that the tests of the HAL component and of the planner module share: commands,
status, messages, and the end, which writes result.json. The tests copy it next to their own part."""

import json
import pathlib
import time

import linuxcnc

command = linuxcnc.command()
stat = linuxcnc.stat()
errors = linuxcnc.error_channel()
result = {"errors": []}


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
            raise RuntimeError(f"timeout: {what}; errors {result['errors']}")
        time.sleep(0.002)


def idle():
    return stat.interp_state == linuxcnc.INTERP_IDLE and stat.inpos and stat.queue == 0


def wait_idle(seconds=60, what="idle"):
    until(idle, seconds, what)


def mode(value):
    command.mode(value)
    command.wait_complete()


def mdi(text, seconds=60):
    mode(linuxcnc.MODE_MDI)
    command.mdi(text)
    command.wait_complete(seconds)
    wait_idle(seconds, text)


def start_program(text=None):
    """Starts the program `text`, or the existing program.ngc."""
    program = pathlib.Path("program.ngc").resolve()
    if text is not None:
        program.write_text(text)
    mode(linuxcnc.MODE_AUTO)
    command.program_open(str(program))
    command.wait_complete()
    command.auto(linuxcnc.AUTO_RUN, 0)
    until(lambda: not idle(), 10, "started")


def play(scenarios, begin, measures):
    """Plays the scenario that the file `scenario` names, between `begin` and `measures`."""
    try:
        begin()
        scenarios[pathlib.Path("scenario").read_text().strip()]()
    except Exception as error:  # the test reports it
        result["failure"] = repr(error)
    poll()
    measures()
    pathlib.Path("result.json").write_text(json.dumps(result))
