#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""In halrun: waits for the link, switches the joints on, lets the generators run, switches off; writes result.json."""

import json
import pathlib
import time

import hal

component = hal.component("drive")  # hal.get_value() needs one
component.ready()
result = {}


def pin(name):
    return hal.get_value("trammel." + name)


def until(condition, seconds, what):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise RuntimeError(f"timeout: {what}")
        time.sleep(0.002)


def enable(on):
    for joint in range(3):
        hal.set_p(f"trammel.joint.{joint:02d}.enable", "1" if on else "0")


def caught_up():
    """The joints begin behind their generators; then the error is that of the latency, for a third of a turn."""
    hal.set_p("most.reset", "1")
    until(lambda: hal.get_value("most.max") == hal.get_value("most.min"), 1, "reset")
    hal.set_p("most.reset", "0")
    end = time.monotonic() + 0.4
    while time.monotonic() < end:
        if max(abs(hal.get_value("most.max")), abs(hal.get_value("most.min"))) > 1.3:
            return False
        time.sleep(0.005)
    return True


def stands():
    """At rest, and the same counts for 0.3 s, since nothing tells when nothing comes."""
    if not pin("at-rest"):
        return False
    seen = [pin(f"joint.{n:02d}.counts") for n in range(3)]
    time.sleep(0.3)
    return pin("at-rest") and seen == [pin(f"joint.{n:02d}.counts") for n in range(3)]


def run():
    until(lambda: pin("link-ok"), 10, "link-ok")
    enable(True)
    until(caught_up, 10, "following")
    begun = time.monotonic()
    lateness = 0
    while time.monotonic() - begun < 3:  # so much motion; nothing waits for it
        lateness = max(lateness, pin("latency"))
        time.sleep(0.005)
    result["furthest"] = max(abs(hal.get_value("most.max")), abs(hal.get_value("most.min")))
    result["longest latency"] = lateness
    result["link-ok"], result["fault"] = pin("link-ok"), pin("fault")
    enable(False)
    until(stands, 10, "at rest")


try:
    run()
except Exception as error:  # the test tells it
    result["failure"] = repr(error)
for name in ("longest-read", "longest-write", "longest-period", "longest-silence", "underrun", "late", "dropped", "refused",
             "packet-error-total", "stop-cause", "read.tmax", "write.tmax"):
    result[name] = pin(name)
result["counts"] = [pin(f"joint.{n:02d}.counts") for n in range(3)]
pathlib.Path("result.json").write_text(json.dumps(result))
