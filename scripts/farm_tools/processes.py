"""Ends a job's process and all processes that it has started."""

import os
import signal
import time
from pathlib import Path
from typing import List

GRACE = 5  # seconds between SIGTERM and SIGKILL


def of_session(session: int) -> List[int]:
    """The processes of a session that still exist. Each job is a session. Process groups would not suffice, because
    scripts/prove and timeout(1) create groups of their own."""
    found = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            # pid (name) state parent group session ...; the name may have spaces.
            fields = path.read_text().rpartition(")")[2].split()
        except OSError:  # it has just ended
            continue
        if int(fields[3]) == session and fields[0] != "Z":
            found.append(int(path.parent.name))
    return found


def send(session: int, number: int):
    for process in of_session(session):
        try:
            os.kill(process, number)
        except ProcessLookupError:
            pass


def end(session: int):
    """Sends SIGTERM to all processes of the session, and SIGKILL to those that remain after GRACE. Blocks until none is
    left."""
    send(session, signal.SIGTERM)
    until = time.monotonic() + GRACE
    while of_session(session):
        if time.monotonic() > until:
            send(session, signal.SIGKILL)
        time.sleep(0.05)
