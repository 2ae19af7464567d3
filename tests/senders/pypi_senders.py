#!/usr/bin/env python3
"""Senders from PyPI (requirements-senders.txt) send a program to `trammel grbl` over a pseudo-terminal: the steps that
the card makes must be those of `trammel run`, in their order.

    pypi_senders.py TRAMMEL PROGRAM [SENDER ...]

Exit status 0 when all is as it must be, 1 when it is not, 77 when the senders are not installed.
"""
import pathlib
import subprocess
import sys
import time

from grbl_server import LONGEST, Server, by_run, order_of


def pygrbl_streamer(port, program):
    from pygrbl_streamer import GrblStreamer
    streamer = GrblStreamer(port)
    streamer.connect()
    if not streamer.send_file(program):
        raise RuntimeError("it has not sent the file")
    streamer.disconnect()


def simple_gcode_sender(port, program):
    # A program of its own, which ends when it has sent all.
    sender = pathlib.Path(sys.executable).parent / "sgs"
    subprocess.run([sender, program, port], check=True, timeout=LONGEST, stdout=subprocess.DEVNULL)


SENDERS = {"pygrbl-streamer": pygrbl_streamer, "simple-gcode-sender": simple_gcode_sender}


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
        import pygrbl_streamer  # noqa: F401
    except ImportError as error:
        print(f"{error}: scripts/test installs requirements-senders.txt")
        sys.exit(77)
    wanted = by_run(trammel, program)
    wrong = 0
    for name in names or SENDERS:
        server = Server(trammel, "--pty")
        begun = time.time()
        try:
            SENDERS[name](server.place, program)
            await_idle(server.place)
        finally:
            made = order_of(server.end())
        good = made == wanted
        wrong += not good
        print(f"{'ok  ' if good else 'FAIL'} {name}: {made}, wanted {wanted}, {time.time() - begun:.1f} s")
    sys.exit(1 if wrong else 0)


main()
