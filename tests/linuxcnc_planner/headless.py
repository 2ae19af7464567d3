"""Headless LinuxCNC with the planner module, in its own namespaces, so that other LinuxCNC processes do not
interfere."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
MODULES = pathlib.Path("/usr/lib/linuxcnc/modules")
AXES = {"X": 150, "Y": 150, "Z": 100}  # mm/s, as examples/machine.toml has them
ACCELERATION = 1000  # mm/s^2

INI = """[EMC]
VERSION = 1.1
MACHINE = trammel planner test
DEBUG = 0
[DISPLAY]
DISPLAY = ./ui.py
[RS274NGC]
PARAMETER_FILE = parameters.var
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 4.0
SERVO_PERIOD = 1000000
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[HAL]
HALFILE = machine.hal
[TRAJ]
TPMOD = trammel_planner
COORDINATES = X Y Z
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
DEFAULT_LINEAR_VELOCITY = 50
MAX_LINEAR_VELOCITY = 400
MAX_FEED_OVERRIDE = 1.2
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.100
TOOL_TABLE = tools.tbl
[KINS]
KINEMATICS = trivkins
JOINTS = 3
"""
HAL_BEGIN = """loadrt [KINS]KINEMATICS
loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS num_dio=8
"""
# The feedback is the command, as the HAL component makes it in coordinated mode.
HAL_ECHO = """addf motion-command-handler servo-thread
addf motion-controller servo-thread
net x joint.0.motor-pos-cmd => joint.0.motor-pos-fb
net y joint.1.motor-pos-cmd => joint.1.motor-pos-fb
net z joint.2.motor-pos-cmd => joint.2.motor-pos-fb
net user-enable iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
net probe => motion.probe-input
"""
# The HAL file for the card behind `trammel linuxcnc`.
HAL_COMPONENT = """loadrt trammel joints=[KINS]JOINTS
loadrt not names=card-well
loadrt and2 names=may-run
addf trammel.read servo-thread
addf card-well servo-thread
addf may-run servo-thread
addf motion-command-handler servo-thread
addf motion-controller servo-thread
addf trammel.write servo-thread
setp trammel.planner-module 1
setp trammel.lead-periods 50
setp trammel.link-periods 2000
net coord-mode motion.coord-mode => trammel.coord-mode
net card-fault trammel.fault => card-well.in
net card-well card-well.out => may-run.in0
net user-enable iocontrol.0.user-enable-out => may-run.in1
net may-run may-run.out => iocontrol.0.emc-enable-in
net clear iocontrol.0.user-request-enable => trammel.clear
net probe trammel.probe => motion.probe-input
""" + "".join(f"""net cmd{n} joint.{n}.motor-pos-cmd => trammel.joint.0{n}.position-cmd
net fb{n} trammel.joint.0{n}.position-fb => joint.{n}.motor-pos-fb
net enable{n} joint.{n}.amp-enable-out => trammel.joint.0{n}.enable
""" for n in range(3))
HAL_END = """net at-speed => spindle.0.at-speed
net link trammel-planner.link-ok => motion.enable
net prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared
net change iocontrol.0.tool-change => iocontrol.0.tool-changed
"""


def ini():
    text = INI
    for number, (letter, speed) in enumerate(AXES.items()):
        limits = f"MIN_LIMIT = -200\nMAX_LIMIT = 200\nMAX_VELOCITY = {speed}\nMAX_ACCELERATION = {ACCELERATION}\n"
        text += f"[AXIS_{letter}]\n{limits}[JOINT_{number}]\nTYPE = LINEAR\nHOME = 0\nHOME_OFFSET = 0\n"
        text += f"HOME_SEQUENCE = {number}\nFERROR = 1.0\nMIN_FERROR = 0.5\n{limits}"
    return text


def changed(text, changes):
    for old, new in changes:
        if old not in text:
            raise AssertionError(f"the INI file has no {old!r}")
        text = text.replace(old, new)
    return text


class Headless:
    """One run of LinuxCNC. `scenario` is a function of ui.py, which writes its results to result.json. With `trammel`,
    the owner is `trammel linuxcnc` with `arguments` and with `engine`, its name and clock. `changes` replaces texts of
    the INI file; `hal` has more lines of the HAL file."""

    def __init__(self, owner, module, scenario, program="", surface=None, trammel=None, arguments=(), changes=(), hal="",
                 engine=("model", 1_000_000)):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="trammel-planner-", dir="/var/tmp"))
        self.name = f"test{os.getpid()}"
        self.owner_command = [owner, self.name, "owner.log", *([str(surface)] if surface is not None else [])]
        # The Verilated card needs most of a core to run in real time.
        self.priority = ["chrt", "--rr", "1"] if engine[0] == "rtl" and os.geteuid() == 0 else []
        middle = HAL_ECHO
        if trammel is not None:
            self.owner_command = [trammel, "linuxcnc", "--name", self.name, "--engine", engine[0], "--clock",
                                  str(engine[1]), "--record", "owner.log", *arguments]
            middle = HAL_COMPONENT
        for file, text in {"test.ini": changed(ini(), changes), "machine.hal": HAL_BEGIN + middle + HAL_END + hal,
                           "program.ngc": program, "tools.tbl": "",
                           "scenario": scenario}.items():
            (self.folder / file).write_text(text)
        for file in (HERE / "ui.py", HERE.parent / "support" / "linuxcnc_ui.py"):
            shutil.copy(file, self.folder)
        modules = self.folder / "modules"
        shutil.copytree(MODULES, modules)
        for built in pathlib.Path(module).parent.glob("*.so"):
            shutil.copy(built, modules)
        self.user = "nobody" if os.geteuid() == 0 else None
        if self.user:
            subprocess.run(["chown", "-R", self.user, self.folder], check=True)
        self.children = []

    def command(self, arguments):
        return ["setpriv", "--reuid", self.user, "--regid", "nogroup", "--clear-groups", *arguments] \
            if self.user else arguments

    def start(self):
        environment = {**os.environ, "HOME": str(self.folder), "TRAMMEL_LINUXCNC": self.name, "DISPLAY": ""}
        self.owner = subprocess.Popen([*self.priority, *self.command(self.owner_command)], cwd=self.folder, env=environment,
                                      stdout=subprocess.DEVNULL)
        arguments = ["unshare", "--mount", "--ipc", "--net", "--pid", "--fork", "--kill-child", "--mount-proc",
                     "--", "sh", "-c",
                     f"mount -t tmpfs tmpfs /tmp && mount --bind {self.folder}/modules {MODULES} && exec \"$@\"", "sh",
                     *self.command(["linuxcnc", "-r", "test.ini"])]
        self.output = open(self.folder / "linuxcnc.out", "w")
        self.linuxcnc = subprocess.Popen(arguments, cwd=self.folder, env=environment, stdout=self.output,
                                         stderr=subprocess.STDOUT, start_new_session=True)
        return self

    def realtime_process(self):
        """rtapi_app among the processes of this run."""
        for entry in pathlib.Path("/proc").iterdir():
            try:
                if (entry / "comm").read_text().strip() != "rtapi_app":
                    continue
                if f"TRAMMEL_LINUXCNC={self.name}\0".encode() in (entry / "environ").read_bytes():
                    return int(entry.name)
            except (OSError, ValueError):
                continue
        raise RuntimeError("no rtapi_app")

    def wait_for(self, file, seconds=60):
        end = time.monotonic() + seconds
        while not (self.folder / file).exists():
            if time.monotonic() > end or self.linuxcnc.poll() is not None:
                raise RuntimeError(f"{file} did not come; {self.folder}/linuxcnc.out:\n" + self.text())
            time.sleep(0.005)

    def text(self):
        return (self.folder / "linuxcnc.out").read_text()[-3000:]

    def finish(self, seconds=120):
        """Waits for the end; returns ui.py's result, and the owner's log as lists of words."""
        try:
            self.linuxcnc.wait(seconds)
        finally:
            if self.linuxcnc.poll() is None:
                os.killpg(self.linuxcnc.pid, signal.SIGKILL)
            self.owner.send_signal(signal.SIGTERM)
            try:
                self.owner.wait(20)
            except subprocess.TimeoutExpired:
                self.owner.kill()
            pathlib.Path(f"/dev/shm/trammel-linuxcnc.{self.name}").unlink(missing_ok=True)
        result = self.folder / "result.json"
        if not result.exists():
            raise RuntimeError(f"no result; {self.folder}/linuxcnc.out:\n" + self.text())
        log = self.folder / "owner.log"
        lines = [line.replace(",", " ").split() for line in log.read_text().splitlines()] if log.exists() else []
        seen = json.loads(result.read_text())
        shutil.rmtree(self.folder)
        return seen, lines
