"""`trammel grbl` for the senders of these tests, and the path of its card."""
import re
import signal
import subprocess
import tempfile

ORDER = re.compile(r"path: (\d+) steps.*of axes and directions ([0-9a-f]{16})")
LONGEST = 120  # s; a job takes about ten


class Server:
    """`trammel grbl` on the golden model in real time; `place` is the serial port or HOST:PORT where it listens."""

    def __init__(self, trammel, *options):
        self.err = tempfile.TemporaryFile("w+")
        self.process = subprocess.Popen([trammel, "grbl", "--engine", "model", *options], stdout=subprocess.PIPE,
                                        stderr=self.err, text=True)
        said = self.process.stdout.readline()
        found = re.search(r" at (?:serial port )?(\S+)$", said.strip())
        if not found:
            raise RuntimeError(f"trammel grbl said: {said!r} {self.end()}")
        self.place = found.group(1)

    def end(self):
        """Ends the server; returns its standard error."""
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(LONGEST)
        self.err.seek(0)
        return self.err.read()


def order_of(text):
    """Number of steps and identity of their order, or the whole text if it has none."""
    found = ORDER.search(text)
    return found.groups() if found else text


def by_run(trammel, program):
    """The result of `trammel run` for the program (a file name) on a separate card."""
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
