#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-only
"""Runs in halrun: plays the scenario that the file `scenario` names, with the joints on their generators; writes
result.json."""

import json
import pathlib
import time

import hal

component = hal.component("drive")  # hal.get_value() needs a component
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
    """Whether the joints, which start behind their generators, have caught up: for a third of a period, the error is no
    larger than the latency causes."""
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
    """Whether the card is at rest and the counts stay the same for 0.3 s, because no signal tells that no more motion
    comes."""
    if not pin("at-rest"):
        return False
    seen = counts()
    time.sleep(0.3)
    return pin("at-rest") and seen == counts()


def joints(name):
    return [pin(f"joint.{n:02d}.{name}") for n in range(3)]


def counts():
    return joints("counts")


def begin():
    until(lambda: pin("link-ok"), 10, "link-ok")
    enable(True)
    until(caught_up, 10, "following")


def end():
    enable(False)
    until(stands, 10, "at rest")


def hold():
    """The card stops while the targets move on, and covers the distance after the release."""
    began = time.monotonic()
    hal.set_p("trammel.hold", "1")
    until(lambda: pin("held"), 5, "held")
    standing = counts()
    time.sleep(0.05)  # no motion may come
    result["held"] = [standing, counts()]
    hal.set_p("trammel.hold", "0")
    result["hold"] = time.monotonic() - began
    until(lambda: not pin("held") and counts() != standing, 5, "released")


def follow():
    begin()
    begun = time.monotonic()
    lateness = 0
    while time.monotonic() - begun < 3:  # 3 s of motion; there is no event to wait for
        lateness = max(lateness, pin("latency"))
        time.sleep(0.005)
    result["furthest"] = max(abs(hal.get_value("most.max")), abs(hal.get_value("most.min")))
    result["longest latency"] = lateness
    hold()
    result["link-ok"], result["fault"] = pin("link-ok"), pin("fault")
    end()


def begin_and_end():
    begin()
    end()


def index():
    """An index edge becomes the joint's zero; the other joints keep theirs."""
    begin()
    hal.set_p("trammel.joint.00.index-enable", "1")
    until(lambda: not pin("joint.00.index-enable"), 5, "the index edge")
    end()
    result["zeros"] = [pin(f"joint.{n:02d}.counts") - 80 * pin(f"joint.{n:02d}.position-fb") for n in range(3)]


def watchdog():
    """The owner is silent for longer than the card's watchdog allows. Writing false to has_bit clears the watchdog."""
    begin()
    result["bitten before"] = pin("watchdog.has_bit")
    pathlib.Path("following").touch()
    until(lambda: pin("watchdog.has_bit"), 20, "the watchdog's bite")
    until(lambda: pin("fault"), 5, "fault")
    result["stop-cause behind the bite"] = pin("stop-cause")
    enable(False)
    until(stands, 10, "at rest")
    result["bitten"] = [pin("watchdog.has_bit"), pin("fault")]
    hal.set_p("trammel.watchdog.has_bit", "0")
    until(lambda: not pin("fault") and not pin("watchdog.has_bit"), 10, "cleared")
    time.sleep(0.1)  # has_bit must not rise again
    result["cleared"] = [pin("watchdog.has_bit"), pin("fault"), pin("stop-cause")]
    standing = counts()
    enable(True)
    until(lambda: counts() != standing, 5, "it moves again")
    end()


try:
    globals()[pathlib.Path("scenario").read_text().strip()]()
except Exception as error:  # the test reports it
    result["failure"] = repr(error)
    names = ("link-ok", "fault", "at-rest", "held", "latency", "ahead", "packet-error-level")
    result["pins"] = {name: pin(name) for name in names}
    for name in ("enable", "position-cmd", "position-fb", "position-scale"):
        result["pins"][name] = joints(name)
    # The generators move the commands in each period.
    time.sleep(1)
    result["thread stands"] = result["pins"]["position-cmd"] == joints("position-cmd")
for name in ("longest-read", "longest-write", "longest-period", "longest-silence", "underrun", "late", "dropped", "refused",
             "packet-error-total", "stop-cause", "read.tmax", "write.tmax"):
    result[name] = pin(name)
result["counts"] = counts()
pathlib.Path("result.json").write_text(json.dumps(result))
