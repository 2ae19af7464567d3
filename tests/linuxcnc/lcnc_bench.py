"""LinuxCNC's HAL in namespaces of its own, with the HAL component just built, in front of `trammel linuxcnc`.

rtapi_app refuses root and loads modules from one folder alone. So root mounts a copy of that folder with the component
in it, for this run alone, and runs all of it as `nobody`."""

import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

MODULES = pathlib.Path("/usr/lib/linuxcnc/modules")
EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples/linuxcnc"
SKIPPED = 77
PULSE = 2**24


def skip(reason):
    print(f"{reason}: Skipped")
    sys.exit(SKIPPED)


def wait_for(what, condition, seconds=20):
    """Waits until the condition holds, and gives back its value."""
    end = time.monotonic() + seconds
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > end:
            raise TimeoutError(f"{what} did not come within {seconds} s")
        time.sleep(0.01)


class Bench:
    def __init__(self, trammel, module, name):
        if shutil.which("halrun") is None or not MODULES.is_dir():
            skip("LinuxCNC is not installed (scripts/setup --linuxcnc)")
        if os.geteuid() != 0:
            skip("a folder of modules is mounted for the test, which needs root")
        self.name = name
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="trammel-linuxcnc-"))
        shutil.copytree(MODULES, self.folder / "modules")
        shutil.copy(module, self.folder / "modules")
        # The checkout may lie where others may not read.
        self.trammel = shutil.copy(trammel, self.folder / "trammel")
        for file in EXAMPLES.iterdir():
            shutil.copy(file, self.folder)
        subprocess.run(["chown", "-R", "nobody", self.folder], check=True)
        self.region = pathlib.Path(f"/dev/shm/trammel-linuxcnc.{name}")
        self.owner = self.hal = None
        self.owners = 0

    def as_nobody(self, arguments):
        return ["setpriv", "--reuid", "nobody", "--regid", "nogroup", "--clear-groups", *map(str, arguments)]

    def environment(self):
        return {**os.environ, "HOME": str(self.folder), "DISPLAY": "", "TRAMMEL_TEST": self.name,
                "XDG_CONFIG_HOME": str(self.folder)}

    def start_owner(self, *options):
        self.owners += 1
        self.record = self.folder / f"record-{self.owners}.csv"
        self.notes = self.folder / f"owner-{self.owners}.txt"
        arguments = [self.trammel, "linuxcnc", "--name", self.name, "--clock", "10000000", "--machine",
                     "machine.toml", "--world", "world.toml", "--record", self.record, *options]
        output = open(self.notes, "w")
        self.owner = subprocess.Popen(self.as_nobody(arguments), cwd=self.folder, env=self.environment(), stdout=output,
                                      stderr=subprocess.STDOUT)
        wait_for("the owner", lambda: self.owner.poll() is not None or "finds the card" in self.notes.read_text())
        if self.owner.poll() is not None:
            raise RuntimeError("the owner has ended:\n" + self.notes.read_text())

    def end_owner(self):
        """By SIGTERM; gives back the record's lines."""
        self.owner.send_signal(signal.SIGTERM)
        status = self.owner.wait(20)
        if status != 0:
            raise RuntimeError(f"the owner ended with {status}:\n" + self.notes.read_text())
        return self.record.read_text().splitlines()

    def isolated(self, arguments):
        mount = f"mount --bind {self.folder}/modules {MODULES} && exec \"$@\""
        return ["unshare", "--mount", "--ipc", "--net", "--pid", "--fork", "--kill-child", "--mount-proc", "--",
                "sh", "-c", mount, "sh", *self.as_nobody(arguments)]

    def start_hal(self, file):
        """halrun, with halcmd's commands on its standard input from then on."""
        log = open(self.folder / "hal.txt", "w")
        self.hal = subprocess.Popen(self.isolated(["halrun", "-k", "-I", file]), cwd=self.folder,
                                    env=self.environment(), stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                    stderr=log, text=True, bufsize=1)

    def get(self, pin):
        self.hal.stdin.write(f"getp {pin}\n")
        self.hal.stdin.flush()
        while True:
            line = self.hal.stdout.readline()
            if not line:
                raise RuntimeError("halrun has ended:\n" + (self.folder / "hal.txt").read_text())
            words = line.replace("halcmd:", " ").split()
            if words:
                return words[-1]

    def number(self, pin):
        return float(self.get(pin))

    def is_true(self, pin):
        return self.get(pin) == "TRUE"

    def set(self, *commands):
        self.hal.stdin.write("".join(f"{command}\n" for command in commands))
        self.hal.stdin.flush()

    def end_hal(self):
        self.hal.stdin.close()
        self.hal.stdout.read()
        self.hal.wait(20)

    def close(self):
        for process in (self.hal, self.owner):
            if process is not None and process.poll() is None:
                process.kill()
                process.wait()
        self.region.unlink(missing_ok=True)
        shutil.rmtree(self.folder, ignore_errors=True)


class Farthest:
    """Of a record: how far each line ended from its target, pulses. Lines that a ramp cut are left out."""

    def __init__(self, lines, lead, joints=3):
        self.pulses, self.lines, self.steps = 0.0, 0, 0
        streams = []
        for line in lines:
            kind, *values = line.split(",")
            values = [int(value) for value in values]
            if kind == "open":
                streams.append({"position": values[1:], "lines": [], "steps": []})
            elif kind == "line":
                streams[-1]["lines"].append(values[2:])
            elif kind == "step":
                streams[-1]["steps"].append(values)
        for stream in streams:
            self.judge(stream, lead, joints)

    def judge(self, stream, lead, joints):
        position = list(stream["position"])
        steps = stream["steps"]
        next_step = 0
        last = steps[-1][1] if steps else 0
        for number, targets in enumerate(stream["lines"]):
            command = number if number < lead else number + 1  # the FEED has a number too
            if command >= last:  # of the last one that moved, a ramp's steps have the same number
                break
            while next_step < len(steps) and steps[next_step][1] <= command:
                _, _, axis, direction = steps[next_step]
                position[axis] += direction
                next_step += 1
            self.lines += 1
            for joint in range(joints):
                self.pulses = max(self.pulses, abs(position[joint] - targets[joint] / PULSE))
        self.steps += len(steps)
