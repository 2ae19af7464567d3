#!/usr/bin/env python3
"""Senders from PyPI (requirements-senders.txt) and from npm (tests/senders/gcnc) send a program to `trammel grbl` over a
pseudo-terminal: the steps that the card makes must be those of `trammel run`, in their order.

    serial_senders.py TRAMMEL PROGRAM NODE_MODULES [SENDER ...]

NODE_MODULES is the folder that gcnc is installed in. Exit status 0 when everything is correct, 1 when it is not, 77
when a sender is not installed.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
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
    # A separate program, which ends when it has sent everything.
    sender = pathlib.Path(sys.executable).parent / "sgs"
    subprocess.run([sender, program, port], check=True, timeout=LONGEST, stdout=subprocess.DEVNULL)


def gcnc(port, program):
    # A separate program; it keeps a file of its progress in its working folder.
    command = pathlib.Path(sys.argv[3]).resolve() / "gcnc/lib/cli/index.js"
    if not command.exists() or not shutil.which("node"):
        raise ImportError(f"no node in PATH or no {command}")
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["node", command, "-p", port, "-f", pathlib.Path(program).resolve()], check=True, cwd=folder,
                       timeout=LONGEST, stdout=subprocess.DEVNULL)


SENDERS = {"pygrbl-streamer": pygrbl_streamer, "simple-gcode-sender": simple_gcode_sender, "gcnc": gcnc}


def await_idle(port):
    import serial
    with serial.Serial(port, timeout=1) as line:
        for _ in range(LONGEST):
            line.write(b"?")
            if b"<Idle" in line.read(200):
                return
    raise RuntimeError("the machine does not come to rest")


def send(name, server, program):
    try:
        SENDERS[name](server.place, program)
        await_idle(server.place)
    except ImportError as error:
        print(f"{name} is not installed ({error}): scripts/test installs it")
        sys.exit(77)
    finally:
        made = order_of(server.end())
    return made


def main():
    trammel, program, _modules, *names = sys.argv[1:]
    wanted = by_run(trammel, program)
    wrong = 0
    for name in names or SENDERS:
        begun = time.time()
        made = send(name, Server(trammel, "--pty"), program)
        good = made == wanted
        wrong += not good
        print(f"{'ok  ' if good else 'FAIL'} {name}: {made}, wanted {wanted}, {time.time() - begun:.1f} s")
    sys.exit(1 if wrong else 0)


main()
