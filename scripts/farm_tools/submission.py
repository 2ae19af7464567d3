"""The jobs submitted to Slurm for a folder of results, and their states."""

import json
import subprocess
from pathlib import Path
from typing import Dict, List

from records import results

from .job import read_list

ACTIVE = "PENDING,CONFIGURING,RUNNING,SUSPENDED,COMPLETING,REQUEUED,REQUEUE_HOLD,STAGE_OUT,STOPPED"


class SlurmError(Exception):
    """Slurm refused a command, or is not installed."""


def call(*command: str) -> str:
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except FileNotFoundError as error:
        raise SlurmError(f"{command[0]} is missing: install Slurm's commands (Debian: slurm-wlm), or try a cluster of one "
                         "node: scripts/farm cluster up DIR") from error
    if done.returncode:
        raise SlurmError(f"{' '.join(command[:3])}: {done.stderr.strip()}")
    return done.stdout


class Submission:
    """The jobs submitted for a folder of results: DIR/slurm/jobs.json, and the arrays with their indices."""

    def __init__(self, folder: Path):
        self.folder = folder.resolve()
        self.place = self.folder / "slurm"
        self.list, self.file = self.place / "jobs.json", self.place / "arrays.json"
        if not self.file.exists():
            raise SlurmError(f"{folder}: nothing was submitted for this folder (scripts/farm slurm submit --out {folder})")
        self.jobs = read_list(self.list)
        self.arrays: Dict[str, List[int]] = json.loads(self.file.read_text())

    def active(self) -> Dict[int, str]:
        """The state of each task that has not ended, by its index."""
        states = {}
        for line in call("squeue", "-h", "-r", "-t", ACTIVE, "-o", "%F %K %T").splitlines():
            array, index, state = line.split()
            if array in self.arrays:
                states[int(index)] = state
        return states

    def submitted(self) -> List[int]:
        return sorted(index for indices in self.arrays.values() for index in indices)

    def states(self) -> Dict[str, str]:
        """For each submitted job: Slurm's state while it is active, afterwards the result of its record, or "no
        record"."""
        active, found = self.active(), results.read_folder(self.folder)
        ended = {job.id: found[job.id]["result"] if job.id in found else "no record" for job in self.jobs}
        return {self.jobs[index].id: active.get(index, ended[self.jobs[index].id]).lower() for index in self.submitted()}
