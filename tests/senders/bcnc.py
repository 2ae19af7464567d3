#!/usr/bin/env python3
"""bCNC (Debian's package) connected to `trammel grbl`, as a user works with it. bCNC runs under Xvfb, and the test
drives it through its web pendant, whose requests are the commands of its command line. A second client of the server
reads along: the test judges only the controller's reports and the steps that the card made.

    bcnc.py TRAMMEL PROGRAM MACHINE

TRAMMEL is the command, PROGRAM a program that takes some seconds, MACHINE examples/first-machine.toml. Exit status 0
when everything is correct, else 1.
"""
import json
import math
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse
import urllib.request

from grbl_server import LONGEST, Server, by_run, order_of

START = (20.0, 20.0, -20.0)  # mm, the work zero of the test runs
TO_START = "G91 G0 X20 Y20 Z-20"
END = (20.0, 20.0, -15.0)  # mm, machine coordinates of the program's end: X0 Y0 Z5 relative to START


def await_true(what, look, longest=LONGEST):
    """The first true value of look(); an error after `longest` seconds."""
    end = time.monotonic() + longest
    while True:
        found = look()
        if found:
            return found
        if time.monotonic() > end:
            raise RuntimeError(f"{what} does not come")
        time.sleep(0.02)


class Report:
    """A status report <...> of Grbl."""

    def __init__(self, line):
        fields = line.strip("<>").split("|")
        self.line = line
        self.state = fields[0]
        self.of = dict(field.split(":", 1) for field in fields[1:] if ":" in field)
        self.place = tuple(float(number) for number in self.of["MPos"].split(",")[:3])


class Reader:
    """A client that reads the controller's messages to bCNC and sends nothing."""

    def __init__(self, place):
        host, port = place.rsplit(":", 1)
        self.socket = socket.create_connection((host, int(port)), LONGEST)
        self.lines = []
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self.socket.makefile("r", newline="\r\n"):
            self.lines.append(line.strip())

    def reports(self, since=0):
        return [Report(line) for line in self.lines[since:] if line.startswith("<") and line.endswith(">")]

    def now(self):
        return len(self.lines)

    def await_report(self, what, good, since=None):
        """The first report for which good() holds, starting now or after line `since`."""
        since = self.now() if since is None else since
        return await_true(what, lambda: next(filter(good, self.reports(since)), None))

    def await_line(self, pattern, since):
        """Index of the first line that matches, from line `since` on."""
        found = lambda: [n for n, line in enumerate(self.lines[since:], since) if re.match(pattern, line)]
        return await_true(pattern, found)[0]


class Bcnc:
    """bCNC on its own display, connected to the server, with the program loaded."""

    def __init__(self, place, program, home):
        self.home = pathlib.Path(home)
        self.pendant = free_port()
        # The option -p of bCNC 0.9.14 has no effect; these entries start the pendant and open the connection.
        (self.home / ".bCNC").write_text(
            f"[Connection]\nport = socket://{place}\ncontroller = GRBL1\nopenserial = 1\n"
            f"pendant = 1\npendantport = {self.pendant}\n[bCNC]\ncheckinterval = 0\n")
        self.log = open(self.home / "log", "w+")
        read, write = os.pipe()
        self.screen = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "1024x768x24", "-nolisten", "tcp"],
            pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with open(read) as number:
            display = number.readline().strip()
        # Debian's python3 comes first, because bCNC needs its packages.
        self.process = subprocess.Popen(
            ["bCNC", "-D", program], stdout=self.log, stderr=subprocess.STDOUT, cwd=home,
            env={"PATH": "/usr/bin:/bin", "HOME": home, "DISPLAY": f":{display}", "LANG": "C.UTF-8"})

    def state(self):
        """bCNC's own view of the machine; None while it does not answer."""
        if self.process.poll() is not None:
            raise RuntimeError("bCNC has ended")
        try:
            with urllib.request.urlopen(f"http://127.0.0.1:{self.pendant}/state", timeout=LONGEST) as answer:
                return json.load(answer)
        except OSError:
            return None

    def await_connected(self):
        unconnected = ("Not connected", "Connected")
        await_true("bCNC's connection", lambda: (self.state() or {"state": "Connected"})["state"] not in unconnected)

    def do(self, command):
        query = urllib.parse.urlencode({"cmd": command})
        urllib.request.urlopen(f"http://127.0.0.1:{self.pendant}/send?{query}", timeout=LONGEST).close()

    def end(self):
        for process in (self.process, self.screen):
            process.terminate()
        for process in (self.process, self.screen):
            process.wait(LONGEST)
        self.log.seek(0)
        return self.log.read()


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


def check(good, text):
    if not good:
        raise RuntimeError(text)


def at(place):
    return lambda report: report.state == "Idle" and report.place == place


def set_zero(bcnc, reader):
    """Moves to START and sets the work zero there."""
    since = reader.now()
    bcnc.do(TO_START)
    reader.await_report("the jog's end", at(START), since)
    bcnc.do("G90")
    bcnc.do("SET0")
    zero = lambda report: report.of.get("WCO", "").startswith("20.000,20.000,-20.000")
    reader.await_report("the work zero", zero, since)


def begin_job(bcnc, reader):
    """Starts the job and returns during its first cut."""
    since = reader.now()
    bcnc.do("RUN")
    cutting = lambda report: report.state == "Run" and report.place[0] > START[0] + 2
    return reader.await_report("the first cut", cutting, since)


def pause_and_resume(bcnc, reader):
    since = reader.now()
    bcnc.do("PAUSE")
    begun = reader.await_report("the hold", lambda report: report.state.startswith("Hold"), since)
    held = reader.await_report("the hold's end", lambda report: report.state == "Hold:0", since)
    # The ramp takes 0.05 mm at 10 mm/s, and a report is some milliseconds old. A hold that waited for its block's end
    # or for an empty queue would end further away.
    check(math.dist(begun.place, held.place) < 1, f"the hold did not act at once: {begun.line}, {held.line}")
    check(held.place not in (START, END), f"the hold came after the job: {held.line}")
    since = reader.now()
    await_true("reports of the hold", lambda: len(reader.reports(since)) >= 4)
    moved = [report.line for report in reader.reports(since) if (report.state, report.place) != ("Hold:0", held.place)]
    check(not moved, f"held at {held.line}, then {moved}")
    since = reader.now()
    bcnc.do("RESUME")
    reader.await_report("motion behind the hold", lambda report: report.state == "Run", since)


def await_purge(bcnc, reader, since, resets=1):
    """bCNC ends a job with a hold and a reset. Afterwards it queues G43.1 and $G, but if the banner comes first, bCNC
    0.9.14 empties that queue, so the test sends them again."""
    banner = since
    for _ in range(resets):
        banner = reader.await_line(r"Grbl 1\.1h", banner) + 1
    reader.await_report("a report behind the reset", lambda report: True, banner)
    await_true("the end of bCNC's job", lambda: bcnc.state()["state"] == "Idle")
    bcnc.do("G43.1Z0")
    bcnc.do("$G")
    modal = reader.await_line(r"\[GC:", banner)
    after = reader.await_report("a report behind the modal words", lambda report: True, modal)
    alarms = [line for line in reader.lines[since:] if line.startswith(("ALARM", "error"))]
    check(not alarms, f"the job's end: {alarms}")
    return after


def run_job(bcnc, reader):
    since = reader.now()
    begin_job(bcnc, reader)
    pause_and_resume(bcnc, reader)
    reader.await_report("the job's end", at(END), since)
    after = await_purge(bcnc, reader, since)
    check(after.state == "Idle" and after.place == END, f"the reset has lost the place: {after.line}")


def override(bcnc, reader):
    since = reader.now()
    bcnc.do("SENDHEX 92")  # -10 %; bCNC sends it as UTF-8
    reader.await_report("an override of 90 %", lambda report: report.of.get("Ov", "").startswith("90,"), since)


def stop_job(bcnc, reader):
    since = reader.now()
    begin_job(bcnc, reader)
    override(bcnc, reader)
    bcnc.do("STOP")
    after = await_purge(bcnc, reader, since, resets=2)  # the second reset belongs to the end of the job
    check(after.state == "Idle" and after.place not in (START, END), f"not stopped in the job: {after.line}")
    since = reader.now()
    bcnc.do("G90 G0 X0 Y0 Z5")
    reader.await_report("the way back", at(END), since)


def recover(bcnc, reader):
    """A move beyond a soft limit, then Reset and Unlock."""
    since = reader.now()
    bcnc.do("G90 G1 X-100 F3000")
    reader.await_line("ALARM:2", since)
    reset = reader.now()
    bcnc.do("RESET")
    reader.await_line(r"Grbl 1\.1h", reset)
    bcnc.do("UNLOCK")
    reader.await_report("Idle behind the unlock", at(END), reset)


def walk(bcnc, reader):
    """The steps of docs/user/bcnc.md on a machine with switches."""
    check(bcnc.state()["state"] == "Alarm", f"before homing: {bcnc.state()['state']}")
    since = reader.now()
    bcnc.do("HOME")
    reader.await_report("homing", lambda report: report.state == "Home", since)
    reader.await_report("homing's end", at((0.0, 0.0, 0.0)), since)
    set_zero(bcnc, reader)
    run_job(bcnc, reader)
    stop_job(bcnc, reader)
    recover(bcnc, reader)


def job(bcnc, reader):
    """Only a job, because its steps are judged: those of homing depend on the time at which the host sees an edge."""
    set_zero(bcnc, reader)
    run_job(bcnc, reader)


def with_bcnc(name, trammel, options, program, steps):
    """Runs steps(bcnc, reader); returns the order of the card's steps, or None after an error."""
    begun = time.monotonic()
    server = Server(trammel, "--listen", "127.0.0.1:0", *options)
    failure, reader, made, said = None, None, None, ""
    try:
        with tempfile.TemporaryDirectory() as home:
            bcnc = Bcnc(server.place, program, home)
            try:
                bcnc.await_connected()
                reader = Reader(server.place)
                await_true("reports", reader.reports)
                steps(bcnc, reader)
            except (RuntimeError, OSError) as error:
                failure = error
            finally:
                said = bcnc.end()
    finally:
        made = order_of(server.end())
    verdict = "FAIL" if failure else "ok  "
    print(f"{verdict} bCNC, {name}: {failure or made}, {time.monotonic() - begun:.1f} s", flush=True)
    if failure:
        print("\n".join(reader.lines[-40:] if reader else []), said, sep="\n")
    return None if failure else made


def main():
    trammel, program, machine = sys.argv[1:]
    for needed in ("bCNC", "Xvfb"):
        if not shutil.which(needed, path="/usr/bin:/bin"):
            sys.exit(f"error: {needed} is missing: scripts/test --long senders installs it (Debian's bcnc and xvfb)")
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that a time-out leaves no process running
    # A slower program, so that a request reaches the running job on a loaded machine, too.
    text = pathlib.Path(program).read_text().replace("F3000", "F600")
    with tempfile.TemporaryDirectory() as folder:
        slow = pathlib.Path(folder) / "job.gcode"
        slow.write_text(text)
        whole = pathlib.Path(folder) / "whole.gcode"
        whole.write_text(f"{TO_START}\nG90\nG10 L20 P1 X0 Y0 Z0\n{text}")
        with_switches = ["--machine", machine, "--world", "default"]
        walked = with_bcnc("the walk of its page", trammel, with_switches, str(slow), walk)
        made = with_bcnc("a job with a pause", trammel, [], str(slow), job)
        wanted = by_run(trammel, str(whole))
    same = made == wanted
    print(f"{'ok  ' if same else 'FAIL'} bCNC, steps: {made}, wanted {wanted}")
    sys.exit(0 if walked and same else 1)


main()
