#!/usr/bin/env python3
"""usage: tour.py PAGE TRAMMEL EXAMPLES

Runs the commands of a page in order, as a reader would, in a folder with the examples, and compares their output with
the output that the page quotes. The commands are the lines that begin with `$ ` in the page's blocks ```console; all of
them share one shell. A command that ends with `&` runs in parallel with the next ones; `wait` waits for it. The quoted
output follows the command:

- Each quoted line must be printed, in this order. A line `...` matches any number of lines, also none. Other lines are
not printed. - Whole numbers are equal. A number with a decimal point may differ by 0.5, because the place of a stop
depends on the time at which the card hears the host.
- A number of ticks (`5400 ticks`) is any number, because it depends on when a button was pressed.
- A word of 16 hexadecimal digits is an identity: equal words in the page must be equal in the output, different ones
different.

The card is served with `--engine model --fast`, so that the tour takes seconds, and on a free port."""
import re
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

LONGEST = 120  # s, for a command
MARK = "~~~ done"
NUMBER = re.compile(r"-?\d+\.\d+")
TICKS = re.compile(r"\d+ ticks")
IDENTITY = re.compile(r"\b[0-9a-f]{16}\b")


def blocks(page: str) -> list[tuple[str, list[str]]]:
    """Commands of the page with the lines that they print."""
    found: list[tuple[str, list[str]]] = []
    for block in re.findall(r"^```console\n(.*?)^```$", page, flags=re.MULTILINE | re.DOTALL):
        for line in block.splitlines():
            if line.startswith("$ "):
                found.append((line[2:], []))
            else:
                found[-1][1].append(line)
    return found


class Names:
    """Maps the page's identities to those of the output."""

    def __init__(self) -> None:
        self.meant: dict[str, str] = {}

    def agree(self, quoted: list[str], printed: list[str]) -> bool:
        for page, output in zip(quoted, printed):
            known = self.meant.setdefault(page, output)
            if known != output or [name for name, other in self.meant.items() if other == output] != [page]:
                return False
        return len(quoted) == len(printed)


def shape(line: str) -> str:
    return IDENTITY.sub("<identity>", NUMBER.sub("<number>", TICKS.sub("<ticks>", " ".join(line.split()))))


def is_line(quoted: str, printed: str, names: Names) -> bool:
    if shape(quoted) != shape(printed):
        return False
    pairs = zip(NUMBER.findall(quoted), NUMBER.findall(printed))
    if any(abs(float(page) - float(output)) > 0.5 for page, output in pairs):
        return False
    return names.agree(IDENTITY.findall(quoted), IDENTITY.findall(printed))


def difference(quoted: list[str], printed: list[str], names: Names) -> str | None:
    """The first line of the page that was not printed, or the first printed line that the page lacks."""
    rest = list(printed)
    skipping = False
    for line in quoted:
        if line.strip() == "...":
            skipping = True
            continue
        while skipping and rest and not is_line(line, rest[0], names):
            rest.pop(0)
        if not rest or not is_line(line, rest[0], names):
            return f"the page has\n    {line}\nand printed is\n    {rest[0] if rest else 'nothing more'}"
        rest.pop(0)
        skipping = False
    if rest and not skipping:
        return f"the page does not have\n    {rest[0]}"
    return None


class Shell:
    """One shell for all commands. The output of a background command goes to its own file, which `wait` shows."""

    def __init__(self, folder: Path, trammel: Path) -> None:
        environment = {"PATH": f"{trammel.parent}:/usr/bin:/bin", "HOME": str(folder), "LC_ALL": "C"}
        self.process = subprocess.Popen(["bash"], cwd=folder, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, text=True)

    def run(self, command: str) -> list[str]:
        self.process.stdin.write(f"{command}\necho '{MARK}'\n")
        self.process.stdin.flush()
        lines = []
        for line in self.process.stdout:
            if line.rstrip("\n") == MARK:
                return lines
            lines.append(line.rstrip("\n"))
        sys.exit(f"error: the shell ended in {command}")

    def end(self) -> None:
        self.process.stdin.close()
        self.process.wait(timeout=LONGEST)


def free_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Tour:
    def __init__(self, folder: Path, trammel: Path) -> None:
        self.shell = Shell(folder, trammel)
        self.folder = folder
        self.port = str(free_port())
        self.names = Names()

    def serve(self, command: str) -> list[str]:
        """Starts the server, as in a separate terminal; returns what it prints when it is ready."""
        (self.folder / "served").touch()
        self.shell.run(f"{command} --engine model --fast >served 2>notes & SERVER=$!")
        end = time.monotonic() + LONGEST
        while "move with" not in (self.folder / "served").read_text():
            if time.monotonic() > end:
                sys.exit("error: the server does not begin")
            time.sleep(0.02)
        return (self.folder / "served").read_text().splitlines()

    def printed_by(self, command: str) -> list[str]:
        if command.startswith("trammel serve"):
            return self.serve(command)
        if command.endswith("&"):
            self.shell.run(f"timeout {LONGEST} {command[:-1]} >beside 2>&1 & BESIDE=$!")
            time.sleep(0.3)  # time for the command to reach the server
            return []
        if command == "wait":
            return self.shell.run("wait $BESIDE; cat beside")
        return self.shell.run(f"timeout {LONGEST} {command}" if command.startswith("trammel") else command)

    def step(self, command: str, quoted: list[str]) -> None:
        begun = time.monotonic()
        printed = [line.replace(self.port, "7000") for line in self.printed_by(command.replace("7000", self.port))]
        print(f"{time.monotonic() - begun:6.2f} s  {command}", flush=True)
        wrong = difference(quoted, printed, self.names)
        if wrong:
            sys.exit(f"error: $ {command}\n{wrong}\nall that was printed:\n    " + "\n    ".join(printed))

    def end(self) -> None:
        self.shell.run("kill $SERVER; wait $SERVER")
        self.shell.end()


def main() -> None:
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    page, trammel, examples = (Path(argument).resolve() for argument in sys.argv[1:])
    steps = blocks(page.read_text())
    if len(steps) < 10:
        sys.exit(f"error: {page} has {len(steps)} commands")
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "examples").symlink_to(examples)
        tour = Tour(Path(folder), trammel)
        try:
            for command, quoted in steps:
                tour.step(command, quoted)
        finally:
            tour.end()


if __name__ == "__main__":
    main()
