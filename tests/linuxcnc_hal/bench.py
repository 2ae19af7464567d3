"""A simulated card with its owner process `trammel linuxcnc`, and LinuxCNC (or halrun) in its own namespaces, with the
modules of the build. It does not interfere with other LinuxCNC processes, and installs nothing."""

import json
import os
import pathlib
import pwd
import shutil
import signal
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "support"))
import namespaces  # noqa: E402

EXAMPLE = HERE.parent.parent / "examples" / "linuxcnc"
MODULES = "/usr/lib/linuxcnc/modules"
USER = "nobody"  # rtapi_app refuses root; the owner must be the same user
PERIOD = 1_000_000  # ns
UNIT = 1 << 24   # units of a target per pulse


class Bench:
    def __init__(self, trammel, modules):
        self.trammel = str(pathlib.Path(trammel).resolve())
        self.name = f"test{os.getpid()}"
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="trammel-linuxcnc-", dir="/var/tmp"))
        shutil.copytree(MODULES, self.folder / "modules")
        for module in pathlib.Path(modules).glob("*.so"):
            shutil.copy(module, self.folder / "modules")
        for file in EXAMPLE.iterdir():
            shutil.copy(file, self.folder)
        for file in [*HERE.glob("*.py"), *(HERE.parent / "support").glob("*.py")]:
            shutil.copy(file, self.folder)
        self.memory = pathlib.Path(f"/dev/shm/trammel-linuxcnc.{self.name}")
        self.owners = []
        self.process = None

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        for owner in self.owners:
            if owner.poll() is None:
                owner.send_signal(signal.SIGCONT)
                owner.kill()
            owner.wait()
        if self.process is not None and self.process.poll() is None:
            namespaces.end(self.process)
        self.memory.unlink(missing_ok=True)
        if kind is None:
            shutil.rmtree(self.folder)
        else:
            print(f"the files are in {self.folder}")
            for log in ("owner.log", "linuxcnc.out", "result.json"):
                if (self.folder / log).exists():
                    print(f"--- {log}\n" + (self.folder / log).read_text()[-3000:])
            if (self.folder / "record").exists():
                lines = self.text("record").splitlines()
                print(f"--- record: {len(lines)} lines; the first and the last ones:", *lines[:5], *lines[-5:], sep="\n")

    def configure(self, scenario, lead=30):
        """Configures the example with the tests' user interface. A shared machine without a realtime kernel is late by
        tens of milliseconds, so the lead is longer, and the limit of the following error larger to match."""
        ini = (EXAMPLE / "trammel.ini").read_text()
        for old, new in {"DISPLAY = axis": "DISPLAY = ./ui.py", "NAME = 0": f"NAME = {self.name}",
                         "LEAD_PERIODS = 40": f"LEAD_PERIODS = {lead}", "\nFERROR = 8": "\nFERROR = 20",
                         "MIN_FERROR = 4": "MIN_FERROR = 20", "SERVO_PERIOD = 1000000": f"SERVO_PERIOD = {PERIOD}"}.items():
            check(old in ini, f"trammel.ini has no {old!r}")
            ini = ini.replace(old, new)
        self.write("trammel.ini", ini)
        self.write("scenario", scenario)
        (self.folder / "ui.py").chmod(0o755)

    def write(self, file, text):
        (self.folder / file).write_text(text)

    def as_user(self, arguments, priority=("chrt", "--fifo", "2")):
        user = pwd.getpwnam(USER)
        # Processes that are realtime at a real machine get priority over all others here. LinuxCNC gets priority over
        # the owner, which it wakes.
        return [*priority, "setpriv", "--reuid", str(user.pw_uid), "--regid", str(user.pw_gid), "--clear-groups", *arguments]

    def environment(self):
        return {"PATH": os.environ["PATH"], "LC_ALL": "C", "HOME": str(self.folder), "DISPLAY": "",
                "TRAMMEL_LINUXCNC": self.name}

    def hand_over(self):
        """Gives the folder to the user of both processes."""
        shutil.chown(self.folder, USER)
        for file in self.folder.iterdir():
            shutil.chown(file, USER)

    def start_owner(self, *arguments):
        """Starts the owner and waits until it is ready."""
        self.hand_over()
        out = open(self.folder / "owner.log", "a")
        begun = out.tell()
        owner = subprocess.Popen(
            self.as_user([self.trammel, "linuxcnc", "--name", self.name, "--machine", "machine.toml", *arguments],
                         priority=("chrt", "--fifo", "1")),
            cwd=self.folder, env=self.environment(), stdout=out, stderr=subprocess.STDOUT)
        self.owners.append(owner)
        wait_until(lambda: "LinuxCNC finds" in self.text("owner.log")[begun:] or owner.poll() is not None, 20, "the owner is ready")
        if owner.poll() is not None:
            raise RuntimeError("the owner ended: " + self.text("owner.log"))
        return owner

    def simulated(self, record="record"):
        return ["--engine", "model", "--clock", "1000000", "--world", "world.toml", "--record", record]

    def start(self, arguments):
        """Starts halrun or linuxcnc as the first process of its namespace, so that all its processes end with it."""
        mounts = f"mount -t tmpfs tmpfs /tmp && mount --bind {self.folder}/modules {MODULES} && exec \"$@\""
        self.process = subprocess.Popen(
            ["unshare", "--mount", "--ipc", "--net", "--pid", "--fork", "--mount-proc", "--",
             "sh", "-c", mounts, "sh", *self.as_user(arguments)],
            cwd=self.folder, env=self.environment(), stdin=subprocess.DEVNULL,
            stdout=open(self.folder / "linuxcnc.out", "w"), stderr=subprocess.STDOUT)

    def text(self, file):
        path = self.folder / file
        return path.read_text(errors="replace") if path.exists() else ""

    def wait_for(self, file, seconds=60):
        """Waits for a file that the inner test writes when it reaches a certain point."""
        wait_until(lambda: (self.folder / file).exists() or self.process.poll() is not None, seconds, file)
        if not (self.folder / file).exists():
            raise RuntimeError(f"LinuxCNC ended without {file}")

    def finish(self, seconds=120, lead=None):
        """Waits for LinuxCNC, then ends the owner in order; returns the results of the inner test. Raises Spoiled if
        that test failed, or the motion was stopped, and this machine paused for longer than `lead` periods; also if
        LinuxCNC's thread no longer runs, when nothing can move."""
        wait_until(lambda: self.process.poll() is not None, seconds, "the end of LinuxCNC")
        self.end_owner()
        if not (self.folder / "result.json").exists():
            raise RuntimeError("LinuxCNC ended without a result")
        result = json.loads(self.text("result.json"))
        broken = "failure" in result or result["underrun"] or result["refused"] or result.get("errors")
        if broken and lead is not None and stalled(result, lead):
            raise Spoiled(f"the machine paused for {longest_pause(result) / 1e6:.0f} ms: {result}")
        if result.get("thread stands"):
            raise Spoiled(f"LinuxCNC's thread no longer runs: {result}")
        if "failure" in result:
            raise RuntimeError(f"in LinuxCNC: {result}")
        return result

    def end_owner(self):
        owner = self.owners[-1]
        if owner.poll() is None:
            owner.send_signal(signal.SIGTERM)
            owner.wait(20)


SKIPPED = 77  # ctest's SKIP_RETURN_CODE of these tests


def requirements(modules):
    """The reason why these tests cannot run here; empty if they can."""
    for program in ("halrun", "linuxcnc", "unshare", "setpriv", "chrt"):
        if shutil.which(program) is None:
            return f"{program} is not installed: scripts/setup --linuxcnc installs LinuxCNC"
    if not (pathlib.Path(modules) / "trammel.so").exists():
        return f"{modules}/trammel.so is not built: it needs linuxcnc-uspace-dev, scripts/setup --linuxcnc"
    if os.geteuid() != 0:
        return "only root can give LinuxCNC the built modules in a namespace of its own"
    return ""


def forbidden():
    """The first required operation that this system denies even to root; empty if it allows all."""
    for command in (["unshare", "--mount", "--ipc", "--net", "--pid", "--fork", "--mount-proc", "true"],
                    ["chrt", "--fifo", "1", "true"]):
        if subprocess.run(command, capture_output=True).returncode != 0:
            return f"this system does not allow {' '.join(command)}"
    return ""


class Spoiled(Exception):
    """A test that failed because this machine stalled, not because of the code under test."""


def longest_pause(result):
    """The longest pause of LinuxCNC's thread or of the owner, in ns, as the component measured it."""
    return max(result["longest-period"], result["longest-silence"])


def stalled(result, lead):
    return longest_pause(result) > lead * PERIOD * 0.9


def run_tests(tests, modules):
    """Runs the tests. A test that a measured stall of this machine spoiled runs again, at most three times; no other
    test does."""
    reason = requirements(modules)
    if reason and os.environ.get("TRAMMEL_REQUIRE_LINUXCNC"):
        sys.exit(f"error: {reason}")
    reason = reason or forbidden()
    if reason:
        print(f"skipped: {reason}")
        sys.exit(SKIPPED)
    for test in tests:
        for attempt in range(3):
            try:
                test()
                break
            except Spoiled as why:
                print(f"{test.__name__}: run again: {why}", flush=True)
                spoiled = why
        else:
            raise AssertionError(f"{test.__name__}: {spoiled}, three times")
        print(f"{test.__name__}: passed", flush=True)


def wait_until(condition, seconds, what):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise RuntimeError(f"timeout: {what}")
        time.sleep(0.002)


def check(condition, text):
    if not condition:
        raise AssertionError(text)
