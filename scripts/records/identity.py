"""Inputs of a result: the commit, the contents of tracked files, the machine and its tools."""

import hashlib
import os
import platform
import re
import subprocess
from datetime import datetime, timezone
from functools import lru_cache
from pathlib import Path
from typing import Dict, Iterable, Tuple

ROOT = Path(__file__).resolve().parents[2]
EVIDENCE = "verif/evidence"  # has only results: writing one makes no other result stale


def git(*arguments: str) -> str:
    return subprocess.run(["git", *arguments], cwd=ROOT, check=True, capture_output=True, text=True).stdout


def commit() -> str:
    return git("rev-parse", "HEAD").strip()


def is_clean() -> bool:
    """Whether the work tree equals the commit: no file changed, none added."""
    return not git("status", "--porcelain", "--", ".", f":!{EVIDENCE}")


@lru_cache(maxsize=None)
def _of_files(folders: Tuple[str, ...]) -> str:
    digest = hashlib.sha256()
    for name in filter(None, git("ls-files", "-z", "--", *folders).split("\0")):
        path = ROOT / name
        digest.update(f"\0{name}\0".encode())
        if path.is_symlink():
            digest.update(os.readlink(path).encode())
        elif path.is_file():
            digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


def forget():
    """Makes inputs() read the files again, because they may have changed."""
    _of_files.cache_clear()


def inputs(folders: Iterable[str], arguments: Iterable[str]) -> str:
    """SHA-256 over the tracked files below the folders, as they were at the first call or after forget(), and over the
    arguments."""
    text = "\0".join([_of_files(tuple(folders)), *arguments])
    return hashlib.sha256(text.encode()).hexdigest()


def now() -> str:
    return datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%f")[:-3] + "Z"


def machine() -> dict:
    return {"processors": len(os.sched_getaffinity(0)), "architecture": platform.machine()}


@lru_cache(maxsize=None)
def version(tool: str) -> str:
    """The first number with a decimal point that the tool prints as its version; "missing" when there is no such
    tool."""
    option = "-V" if tool.endswith("yosys") else "--version"
    try:
        done = subprocess.run([tool, option], capture_output=True, text=True, timeout=60)
    except (OSError, subprocess.TimeoutExpired):
        return "missing"
    found = re.search(r"\d+\.\d[\w.+-]*", done.stdout + done.stderr)
    return found.group(0) if found else "unknown"


def versions(tools: Iterable[str]) -> Dict[str, str]:
    return {Path(tool).name: version(tool) for tool in tools}
