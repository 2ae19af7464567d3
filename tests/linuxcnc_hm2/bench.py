"""Two private networks: `trammel serve --hm2` in one, LinuxCNC as an ordinary user in the other.

hm2_eth flushes iptables, writes ARP entries and sends to the address that the card reports, so it gets a network
namespace, which needs root. LinuxCNC also gets its own IPC, mount and process namespaces, so that its shared memory,
its lock in /tmp and the programs that it ends by name belong only to this test.
"""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import namespaces  # noqa: E402

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples" / "linuxcnc-hm2"
CARD, DRIVER = "192.168.81.2", "192.168.81.1"
USER = "nobody"
PROGRAMS = ["unshare", "nsenter", "ip", "setpriv", "chrt", "halrun", "linuxcnc", "rtapi_app"]
# Realtime priorities, if the system allows them. The card needs one, because a real card does not share the processor
# with LinuxCNC, whose driver waits for answers without sleeping. LinuxCNC's thread needs one, because without a
# realtime kernel it is late by hundreds of milliseconds on a busy machine. Only that thread gets it, because programs
# of equal priority wait for each other.
CARD_PRIORITY = ["chrt", "-f", "5"]
THREAD_PRIORITY = ["chrt", "-a", "-f", "-p", "3"]
SKIP = 77


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIP)


def in_own_network():
    """Restarts the test in its own network namespace, unless this process is in one already."""
    os.environ["PATH"] += ":/usr/sbin:/sbin"
    missing = [program for program in PROGRAMS if shutil.which(program) is None]
    if missing:
        reason = f"needs {', '.join(missing)}: scripts/setup --linuxcnc installs LinuxCNC"
        if os.environ.get("TRAMMEL_REQUIRE_LINUXCNC"):
            sys.exit(f"error: {reason}")
        skip(reason)
    if os.geteuid() != 0:
        skip("needs root, for a network namespace with a veth pair")
    if os.environ.get("TRAMMEL_HM2_NETWORK"):
        return
    if subprocess.run(["unshare", "-n", "true"], capture_output=True).returncode != 0:
        skip("this system allows no network namespace")
    os.environ["TRAMMEL_HM2_NETWORK"] = "own"
    os.execvp("unshare", ["unshare", "-n", sys.executable, "-B", *sys.argv])


def run(*command):
    subprocess.run(command, check=True)


def wait_until(holds, seconds, what):
    end = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > end:
            raise AssertionError(f"{what}: not within {seconds} s")
        time.sleep(0.02)


class Bench:
    """The veth pair, with the card at one end and LinuxCNC's side at the other."""

    def __init__(self, trammel, *options):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="trammel-hm2-", dir="/var/tmp"))
        self.folder.chmod(0o777)
        self.holder = subprocess.Popen(["unshare", "-n", "sleep", "600"])
        wait_until(lambda: os.readlink(f"/proc/{self.holder.pid}/ns/net") != os.readlink("/proc/self/ns/net"), 5,
                   "the card's network")
        run("ip", "link", "set", "lo", "up")
        run("ip", "link", "add", "driver", "type", "veth", "peer", "name", "card")
        run("ip", "link", "set", "card", "netns", str(self.holder.pid))
        run("ip", "addr", "add", f"{DRIVER}/24", "dev", "driver")
        run("ip", "link", "set", "driver", "up")
        inside = ["nsenter", "-t", str(self.holder.pid), "-n"]
        run(*inside, "ip", "addr", "add", f"{CARD}/24", "dev", "card")
        run(*inside, "ip", "link", "set", "card", "up")
        self.realtime = subprocess.run([*CARD_PRIORITY, "true"], capture_output=True).returncode == 0
        priority = CARD_PRIORITY if self.realtime else []
        self.notes_file = self.folder / "server.txt"
        with self.notes_file.open("w") as notes:
            self.server = subprocess.Popen([*priority, *inside, trammel, "serve", "--hm2", CARD, *options], stdout=notes, stderr=notes)
        wait_until(lambda: "hostmot2 at" in self.notes(), 10, "the server")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in (self.server, self.holder):
            process.kill()
            process.wait()
        subprocess.run(["ip", "link", "del", "driver"], capture_output=True)
        shutil.rmtree(self.folder)

    def notes(self):
        return self.notes_file.read_text()

    def copy(self, name, *changes):
        """Copies an example's file for LinuxCNC's side; each change is (old text, new text)."""
        text = (EXAMPLES / name).read_text()
        for old, new in changes:
            if old not in text:
                raise AssertionError(f"{name} has no {old!r}")
            text = text.replace(old, new)
        target = self.folder / name
        target.write_text(text)
        target.chmod(0o755)

    def start(self, *command):
        """Starts a command as an ordinary user in the folder, which is also mounted as /tmp."""
        mount = f'mount --bind {self.folder} /tmp && cd /tmp && exec setpriv --reuid {USER} --regid nogroup --clear-groups "$@"'
        environment = {"HOME": "/tmp", "PATH": "/usr/bin:/bin:/usr/sbin:/sbin", "LANG": "C.UTF-8"}
        self.output_file = self.folder / "output.txt"
        with self.output_file.open("w") as output:
            process = subprocess.Popen(["unshare", "-m", "-i", "-p", "-f", "--mount-proc", "sh", "-c", mount, "-", *command],
                                    stdin=subprocess.DEVNULL, stdout=output, stderr=output, env=environment)
        wait_until(lambda: rtapi_app() or process.poll() is not None, 20, "rtapi_app")
        if self.realtime and rtapi_app():
            subprocess.run([*THREAD_PRIORITY, str(rtapi_app())], capture_output=True)
        return process

    def output(self):
        return self.output_file.read_text(errors="replace")

    def finish(self, process, seconds):
        try:
            process.wait(seconds)
        except subprocess.TimeoutExpired:
            namespaces.end(process)
            raise AssertionError(f"LinuxCNC's side has not ended within {seconds} s:\n{self.output()}\n{self.notes()}")

    def run(self, seconds, *command):
        """Runs a command to its end; repeats it if the driver's first queued read exceeded its fixed 1.6 ms (error
        -11)."""
        for _ in range(10):
            process = self.start(*command)
            self.finish(process, seconds)
            if "(-11)" not in self.output():
                break
        if process.returncode != 0:
            raise AssertionError(f"{command[0]} ended with status {process.returncode}:\n{self.output()}\n{self.notes()}")
        return self.output()

    def end_server(self):
        """The server's final output: (counts by name, pulses at the pins, counters)."""
        self.server.send_signal(signal.SIGINT)
        self.server.wait(20)
        notes = self.notes()
        if self.server.returncode != 0:
            raise AssertionError(f"the server ended with status {self.server.returncode}:\n{notes}")
        places = re.search(r"pulses at the pins ([-\d ]+); counters ([-\d ]+);", notes)
        numbers = {name: float(number) for number, name in
                   re.findall(r"([\d.]+) (datagrams|answered|refused|bites|lines|ticks stale|lost on purpose|s left out)", notes)}
        for name in ("longest answer", "longest gap of a driver"):
            numbers[name] = float(re.search(name + r" ([\d.]+) ms", notes)[1])
        return numbers, [int(n) for n in places[1].split()], [int(n) for n in places[2].split()]


def rtapi_app():
    """The process of the realtime threads in this namespace; None if there is none yet."""
    mine = os.readlink("/proc/self/ns/net")
    for entry in pathlib.Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and (entry / "comm").read_text().strip().startswith("rtapi_app") and os.readlink(entry / "ns/net") == mine:
                return int(entry.name)
        except OSError:
            continue
    return None
