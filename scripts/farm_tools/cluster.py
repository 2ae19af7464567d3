"""A Slurm cluster of one node in a folder, for tests: no systemd, no cgroups, no accounting, no files outside the
folder."""

import getpass
import os
import secrets
import signal
import socket
import subprocess
import time
from pathlib import Path
from typing import Callable

from records import identity

DAEMONS = ("slurmd", "slurmctld", "munged")  # in the order in which they must be ended
CONFIGURATION = Path(__file__).with_name("slurm.conf.template")


class ClusterError(Exception):
    """The cluster did not come up; the text names its logs."""


def free_port() -> int:
    with socket.socket() as tried:
        tried.bind(("127.0.0.1", 0))
        return tried.getsockname()[1]


def until(what: Callable[[], bool], text: str, folder: Path, seconds: float = 20):
    end = time.monotonic() + seconds
    while not what():
        if time.monotonic() > end:
            raise ClusterError(f"{text} after {seconds:.0f} s; the logs are {folder}/*.log")
        time.sleep(0.1)


def environment(folder: Path) -> dict:
    return {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}


def says(folder: Path, *command: str) -> str:
    return subprocess.run(command, env=environment(folder), capture_output=True, text=True).stdout.strip()


def start(folder: Path, *command: str):
    done = subprocess.run(command, env=environment(folder), capture_output=True, text=True)
    if done.returncode:
        raise ClusterError(f"{command[0]}: {(done.stderr or done.stdout).strip()}")


def up(folder: Path, processors: int) -> str:
    """Starts the cluster; returns the line that a shell needs to use it."""
    folder = folder.resolve()
    if any(running(folder, name) for name in DAEMONS):
        raise ClusterError(f"{folder}: its cluster is up; scripts/farm cluster down {folder} ends it")
    subprocess.run([identity.ROOT / "scripts" / "farm_tools" / "build", "slurm"], check=True)
    for name in ("state", "spool"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    folder.chmod(0o755)
    key = folder / "munge.key"
    key.unlink(missing_ok=True)
    key.touch(0o600)
    key.write_bytes(secrets.token_bytes(128))
    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2**20
    (folder / "slurm.conf").write_text(CONFIGURATION.read_text().format(
        host=socket.gethostname().split(".")[0], user=getpass.getuser(), folder=folder, processors=processors, memory=memory,
        controller_port=free_port(), node_port=free_port()))
    start(folder, "munged", f"--key-file={key}", f"--socket={folder}/munge.socket", f"--pid-file={folder}/munged.pid",
          f"--log-file={folder}/munged.log", f"--seed-file={folder}/munged.seed", "--num-threads=2")
    start(folder, "slurmctld", "-f", str(folder / "slurm.conf"))
    start(folder, "slurmd", "-f", str(folder / "slurm.conf"))
    until(lambda: says(folder, "sinfo", "-h", "-o", "%T") == "idle", "the node is not idle", folder)
    return f"export SLURM_CONF={folder}/slurm.conf"


def running(folder: Path, name: str) -> int:
    """Process id of a daemon of this cluster; 0 when it does not run."""
    try:
        process = int((folder / f"{name}.pid").read_text())
        return process if Path(f"/proc/{process}/comm").read_text().startswith(name) else 0
    except (OSError, ValueError):
        return 0


def down(folder: Path):
    """Cancels all jobs and ends the cluster's three daemons."""
    folder = folder.resolve()
    if running(folder, "slurmctld"):
        subprocess.run(["scancel", "--user", getpass.getuser()], env=environment(folder), capture_output=True)
        until(lambda: not says(folder, "squeue", "-h"), "jobs have not ended", folder, 40)
    for name in DAEMONS:
        process = running(folder, name)
        if process:
            os.kill(process, signal.SIGTERM)
            until(lambda: not running(folder, name), f"{name} has not ended", folder)
