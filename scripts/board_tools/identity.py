"""Identifies the sources of a bitstream or a figure: BUILD_ID, and the commit of the RTL."""
import hashlib
import subprocess
import sys

from rtl.file_list import ROOT

# Sources of every bitstream, in addition to the board's own folder.
INTO = ("rtl", "boards/rtl", "scripts/boards", "scripts/board_tools", "scripts/synthesis", "scripts/rtl/file_list.py",
        "requirements-synthesis.txt")
# Files in those folders that do not affect a bitstream.
NOT_INTO = ("rtl/lint/", "rtl/trammel.core", "rtl/regs/trammel.rdl", "rtl/regs/CMakeLists.txt", "rtl/regs/generated/include/")


def git(*arguments):
    done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"error: the sources are hashed as git knows them, and git says: {done.stderr.strip()}")
    return done.stdout


def tracked(board):
    """The files that git tracks and that go into the board's bitstream."""
    files = git("ls-files", "--", *INTO, str(board.folder.relative_to(ROOT))).splitlines()
    return [file for file in files if not file.startswith(NOT_INTO)]


def identity(board):
    """BUILD_ID, the first 32 bits of a SHA-256 over names and contents, and whether a file differs from its commit."""
    files = tracked(board)
    whole = hashlib.sha256()
    for file in files:
        path = ROOT / file
        if path.exists():
            whole.update(f"{file} {hashlib.sha256(path.read_bytes()).hexdigest()}\n".encode())
    changed = git("status", "--porcelain", "--untracked-files=no", "--", *files)
    return int(whole.hexdigest()[:8], 16), bool(changed.strip())


def rtl_commit():
    """The last commit that changed the RTL, and whether the RTL was changed since."""
    changed = git("status", "--porcelain", "--", "rtl").strip()
    return git("log", "-1", "--format=%h", "--abbrev=7", "--", "rtl").strip() + (" and changes" if changed else "")


def rtl_lines(known):
    """A line per RTL commit with the names of the records, {name: record}, that were made from it."""
    names = {}
    for name, record in known.items():
        names.setdefault(record["rtl"], []).append(name)
    return [f"RTL of commit {commit}: {', '.join(of)}." for commit, of in names.items()]
