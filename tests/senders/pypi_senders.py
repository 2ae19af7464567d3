#!/usr/bin/env python3
"""Senders from PyPI (requirements-senders.txt) send a program to `trammel grbl` over a pseudo-terminal: the steps that
the card makes must be those of `trammel run`, in their order.

    pypi_senders.py TRAMMEL PROGRAM [SENDER ...]

Exit status 0 when all is as it must be, 1 when it is not, 77 when the senders are not installed.
"""
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time

ORDER = re.compile(r"path: (\d+) steps.*of axes and directions ([0-9a-f]{16})")
LONGEST = 120  # s, of a job that takes ten


class Server:
    """`trammel grbl` at a serial port of its own."""

    def __init__(self, trammel):
        self.err = tempfile.TemporaryFile("w+")
        self.process = subprocess.Popen([trammel, "grbl", "--pty", "--engine", "model"], stdout=subprocess.PIPE,
                                        stderr=self.err, text=True)
        said = self.process.stdout.readline()
        found = re.search(r"serial port (\S+)", said)
        if not found:
            sys.exit(f"trammel grbl said: {said!r}")
        self.port = found.group(1)

    def end(self):
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(LONGEST)
        self.err.seek(0)
        return self.err.read()


def order_of(text):
    found = ORDER.search(text)
    return found.groups() if found else text


def by_run(trammel, program):
    """What `trammel run` makes of the program on a card of its own."""
    with tempfile.TemporaryFile("w+") as err:
        served = subprocess.Popen([trammel, "serve", "--engine", "model", "--fast", "--once"], stdout=subprocess.PIPE,
                                  stderr=err, text=True)
        url = next(word.strip("'") for line in served.stdout if "--card" in line for word in line.split()
                   if "token=" in word)
        subprocess.run([trammel, "run", program, "--card", url], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        served.wait(LONGEST)
        err.seek(0)
        return order_of(err.read())


def pygrbl_streamer(port, program):
    from pygrbl_streamer import GrblStreamer
    streamer = GrblStreamer(port)
    streamer.connect()
    if not streamer.send_file(program):
        raise RuntimeError("it has not sent the file")
    streamer.disconnect()


def grbl_streamer(port, program):
    from grbl_streamer import GrblStreamer
    done = threading.Event()

    def told(event, *_):
        if event == "on_job_completed":
            done.set()

    streamer = GrblStreamer(told)
    streamer.setup_logging()
    streamer.cnect(port, 115200)
    time.sleep(1)
    streamer.poll_start()
    # By counting bytes it leaves out or doubles a line now and then (two of its threads send): by its own record of what
    # it wrote, in 3 of 12 jobs.
    streamer.incremental_streaming = True
    streamer.load_file(program)
    streamer.job_run()
    if not done.wait(LONGEST):
        raise RuntimeError("its job does not end")
    streamer.disconnect()


def simple_gcode_sender(port, program):
    # A program of its own, which ends when it has sent all.
    sender = pathlib.Path(sys.executable).parent / "sgs"
    subprocess.run([sender, program, port], check=True, timeout=LONGEST, stdout=subprocess.DEVNULL)


SENDERS = {"pygrbl-streamer": pygrbl_streamer, "grbl-streamer": grbl_streamer,
           "simple-gcode-sender": simple_gcode_sender}


def await_idle(port):
    import serial
    with serial.Serial(port, timeout=1) as line:
        for _ in range(LONGEST):
            line.write(b"?")
            if b"<Idle" in line.read(200):
                return
    raise RuntimeError("the machine does not come to rest")


def main():
    trammel, program, *names = sys.argv[1:]
    try:
        import grbl_streamer  # noqa: F401
        import pygrbl_streamer  # noqa: F401
    except ImportError as error:
        print(f"{error}: scripts/test installs requirements-senders.txt")
        sys.exit(77)
    wanted = by_run(trammel, program)
    wrong = 0
    for name in names or SENDERS:
        server = Server(trammel)
        begun = time.time()
        try:
            SENDERS[name](server.port, program)
            await_idle(server.port)
        finally:
            made = order_of(server.end())
        good = made == wanted
        wrong += not good
        print(f"{'ok  ' if good else 'FAIL'} {name}: {made}, wanted {wanted}, {time.time() - begun:.1f} s")
    sys.exit(1 if wrong else 0)


main()
