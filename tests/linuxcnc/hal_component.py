#!/usr/bin/env python3
"""The HAL component in halrun against `trammel linuxcnc`: the card's steps equal the commanded targets, a stopped owner
and a killed one. --long: 1 % of the periods dropped, and more of each."""

import argparse
import signal
import time

from lcnc_bench import Bench, Farthest, wait_for

LEAD = 100  # periods: this host is no realtime one
HAL = """loadrt threads name1=servo period1=1000000
loadrt trammel joints=3 name={name}
loadrt siggen num_chan=1
addf siggen.0.update servo
addf trammel.0.read servo
addf trammel.0.write servo
setp trammel.0.lead-periods {lead}
setp trammel.0.link-periods 150
setp siggen.0.frequency 0
setp siggen.0.amplitude 8
setp siggen.0.offset -8
net x siggen.0.cosine => trammel.0.stepgen.00.position-cmd trammel.0.stepgen.01.position-cmd
net on trammel.0.stepgen.00.enable trammel.0.stepgen.01.enable trammel.0.stepgen.02.enable
start
"""


def start(bench):
    bench.start_owner()
    (bench.folder / "test.hal").write_text(HAL.format(name=bench.name, lead=LEAD))
    bench.start_hal("test.hal")
    wait_for("the link", lambda: bench.is_true("trammel.0.link-ok"))


def enable(bench):
    wait_for("ready", lambda: bench.is_true("trammel.0.ready"))
    bench.set("sets on 1")
    wait_for("rest", lambda: bench.number("trammel.0.ahead") > 0)


def back_to_zero(bench):
    """The targets go back to where the cosine begins, while the machine is off."""
    bench.set("sets on 0", "setp siggen.0.frequency 0", "setp siggen.0.reset 1")
    wait_for("rest", lambda: bench.is_true("trammel.0.at-rest"))


def follow(bench, seconds):
    """Sines for so long of the card's time, then rest at their beginning."""
    begun = bench.number("trammel.0.ahead") * 0 + time.monotonic()
    bench.set("setp siggen.0.frequency 0.5")
    wait_for("motion", lambda: abs(bench.number("trammel.0.stepgen.00.velocity-fb")) > 5)
    wait_for("the time", lambda: time.monotonic() - begun > seconds or bench.is_true("trammel.0.fault"), seconds + 5)


def figures(bench):
    for pin in ("underrun", "late", "dropped", "refused", "packet-error-total", "longest-read", "longest-write"):
        print(f"{pin}: {bench.get('trammel.0.' + pin)}")


def test_follows(bench, seconds):
    enable(bench)
    follow(bench, seconds)
    stopped = bench.is_true("trammel.0.fault")
    bench.set("sets on 0")
    wait_for("rest", lambda: bench.is_true("trammel.0.at-rest"))
    figures(bench)
    print(f"stopped by an under-run of this host: {stopped}")


def test_stopped_owner(bench):
    """In motion: the link falls, the card has ramped down, and nothing moves when the owner is back."""
    bench.owner.send_signal(signal.SIGSTOP)
    wait_for("the link's end", lambda: not bench.is_true("trammel.0.link-ok"))
    assert bench.is_true("trammel.0.fault")
    bench.owner.send_signal(signal.SIGCONT)
    wait_for("the link", lambda: bench.is_true("trammel.0.link-ok"))
    wait_for("rest", lambda: bench.is_true("trammel.0.at-rest"))
    before = bench.number("trammel.0.stepgen.00.counts")
    periods = bench.number("trammel.0.late") * 0 + time.monotonic() + 0.3
    wait_for("some periods", lambda: time.monotonic() > periods)
    assert bench.number("trammel.0.stepgen.00.counts") == before, "moved by itself"
    print("longest with the owner stopped, ns: read", bench.get("trammel.0.longest-read"), "write",
          bench.get("trammel.0.longest-write"))


def test_killed_owner(bench):
    """While enabled: the session is lost until the machine is disabled."""
    bench.owner.kill()
    bench.owner.wait()
    wait_for("the link's end", lambda: not bench.is_true("trammel.0.link-ok"))
    bench.start_owner()
    wait_for("the lost session", lambda: bench.is_true("trammel.0.session-lost"))
    assert not bench.is_true("trammel.0.ready")
    bench.set("sets on 0")
    wait_for("the new session", lambda: not bench.is_true("trammel.0.session-lost"))
    wait_for("ready", lambda: bench.is_true("trammel.0.ready"))
    assert bench.number("trammel.0.stepgen.00.counts") == 0


def clear(bench):
    back_to_zero(bench)
    bench.set("setp trammel.0.clear 1")
    wait_for("the clear", lambda: bench.is_true("trammel.0.ready"))
    bench.set("setp trammel.0.clear 0", "setp siggen.0.reset 0")


def judge(lines, least):
    found = Farthest(lines, LEAD)
    print(f"{found.lines} lines, {found.steps} steps, farthest from a target {found.pulses:.4f} pulses")
    assert found.lines >= least, f"fewer than {least} lines"
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("trammel")
    parser.add_argument("module")
    parser.add_argument("--long", action="store_true")
    options = parser.parse_args()
    bench = Bench(options.trammel, options.module, "test-hal")
    try:
        start(bench)
        test_follows(bench, 20 if options.long else 3)
        bench.end_hal()
        late = "late periods: 0;" in bench.notes.read_text()
        found = judge(bench.end_owner(), 100)
        print(bench.notes.read_text())
        assert found.pulses <= (0.5 if late or "late periods: 0;" in bench.notes.read_text() else 40)
        start(bench)
        enable(bench)
        follow(bench, 0.5)
        test_stopped_owner(bench)
        clear(bench)
        enable(bench)
        test_killed_owner(bench)
        bench.end_hal()
        bench.end_owner()
        print("passed")
    except Exception:
        for file in ("hal.txt", "owner-1.txt", "owner-2.txt", "owner-3.txt"):
            if (bench.folder / file).exists():
                print(f"--- {file}\n" + (bench.folder / file).read_text()[-2000:])
        raise
    finally:
        bench.close()


if __name__ == "__main__":
    main()
