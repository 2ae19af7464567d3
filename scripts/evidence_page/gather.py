"""Collects the data of the evidence page from tracked files only, so that the page can be made from any clone.

Nothing is computed here: figures of runs come from verif/evidence/*.json (scripts/evidence keep writes them), those of
modules from verif/evidence/modules.json (scripts/rtl/judges), sizes from boards/results, the papers from docs/papers."""
import json
import re
import tomllib
from pathlib import Path

from records import counts, keep, suite

ROOT = Path(__file__).resolve().parents[2]
EVIDENCE = ROOT / "verif/evidence"
VERDICTS = ("PASS", "CORRECTED", "ADDED", "OPEN", "FAIL")


def releases(folder: Path) -> list[dict]:
    """The release candidates with their runs, the oldest first."""
    files = [file for file in folder.glob("*.json") if keep.RELEASE.fullmatch(file.stem)]
    files.sort(key=lambda file: tuple(map(int, keep.RELEASE.fullmatch(file.stem).groups())))
    return [{"release": file.stem, "file": f"verif/evidence/{file.name}", "records": list(keep.read_release(file).values())}
            for file in files]


def sizes() -> list[dict]:
    """Recorded builds and bitstreams, with the clock of each seed in MHz."""
    rows = []
    for device, unit in (("hx8k", "LC"), ("ecp5-25k", "COMB")):
        file = ROOT / f"boards/results/{device}.json"
        for name, build in json.loads(file.read_text())["builds"].items():
            rows.append(size_row(name, build, unit, file))
    file = ROOT / "boards/results/boards.json"
    for name, build in json.loads(file.read_text()).items():
        rows.append(size_row(f"board {name}", build, "LC" if "ice40" in build["tools"] else "COMB", file))
    return rows


def size_row(name: str, build: dict, unit: str, file: Path) -> dict:
    return {"build": name, "area": build["area"], "unit": unit, "memory": build["memory"], "fmax_mhz": build["fmax_mhz"],
            "median_fmax_mhz": build["median_fmax_mhz"], "tools": build["tools"], "rtl": build.get("rtl"),
            "file": str(file.relative_to(ROOT))}


def papers() -> list[dict]:
    """Number of items per verdict for each paper, from docs/papers/README.md, below the paper's title."""
    rows, title = [], None
    for line in (ROOT / "docs/papers/README.md").read_text().splitlines():
        if heading := re.match(r"## \[(.+)\]\((.+)\)", line):
            title = heading
        elif title and re.match(r"\d+ PASS, ", line):
            counts = {verdict: int(number) for number, verdict in re.findall(r"(\d+) ([A-Z]+)", line)}
            rows.append({"paper": title.group(1), "file": f"docs/papers/{title.group(2)}", **counts})
    if len(rows) != 2 or any(set(VERDICTS) - set(row) for row in rows):
        raise SystemExit("error: docs/papers/README.md does not have both papers with the number of their items: trammel reproduce")
    return rows


def foreign_judges(records: list[dict]) -> list[dict]:
    """Each foreign judge with its runs: those of its part of scripts/test, and the tests that its pattern matches."""
    judges = tomllib.loads(suite.JUDGES.read_text())["judge"]
    for judge in judges:
        runs = [r for r in records if "part" in judge and r["job"] == f"part-{judge['part']}"]
        tests = {name: result for r in records for name, result in r.get("tests", {}).items()
                 if "tests" in judge and re.search(judge["tests"], name)}
        results = [r["result"] == "passed" for r in runs] + [result == "passed" for result in tests.values()]
        judge |= {"runs": [r["job"] for r in runs], "passed_tests": sum(v == "passed" for v in tests.values()), "all_tests": len(tests),
                  "result": "not recorded" if not results else "passed" if all(results) else "failed"}
    return judges


def coverage(records: list[dict]) -> dict:
    """Each module's points by kind, from the newest run that has counted the kind."""
    found: dict = {}
    for record in sorted((r for r in records if "coverage" in r), key=lambda r: r["begun"]):
        for module, kinds in record["coverage"].items():
            found.setdefault(module, {}).update(kinds)
    return found


def mutants(records: list[dict]) -> dict:
    """Numbers of tried and killed mutants of each module. Shards of one command are added up. If the mutants were cut
    into shards in two ways, the way that tried more mutants of the module counts."""
    ways: dict = {}
    for record in (r for r in records if "mutants" in r):
        way = re.sub(r"\d+", "", record["job"])
        for module, figure in record["mutants"].items():
            found = ways.setdefault(module, {}).setdefault(way, dict.fromkeys(figure, 0))
            ways[module][way] = {name: found[name] + number for name, number in figure.items()}
    return {module: max(found.values(), key=lambda figure: figure["tried"]) for module, found in ways.items()}


def proofs(records: list[dict]) -> dict:
    """Each proof's runs, with covers and seeded bugs, from the newest record of the proof."""
    found: dict = {}
    for record in sorted((r for r in records if "proofs" in r), key=lambda r: r["begun"]):
        found.update(record["proofs"])
    return found


def clocks(records: list[dict]) -> dict:
    """The clocks that each lockstep has compared, summed over all runs, because their seeds differ."""
    found: dict = {}
    for record in records:
        for lockstep, number in record.get("clocks", {}).items():
            found[lockstep] = found.get(lockstep, 0) + number
    return found


def parts() -> list[str]:
    """The runs that a release candidate should have: all tests, and each part of scripts/test --long or each of its shards."""
    found = re.findall(r'^part (\w+) \d+ ".*"(?: (\d+))?$', (ROOT / "scripts/test").read_text(), re.M)
    if not found:
        raise SystemExit("error: scripts/test names no parts: lines `part NAME MINUTES \"TEXT\" [SHARDS]` are expected")
    return ["tests"] + [f"part-{name}{shard}" for name, shards in found
                        for shard in ([f"-{number}" for number in range(1, int(shards) + 1)] if shards else [""])]


def gather(folder: Path = EVIDENCE) -> dict:
    """All that the page shows; `folder` holds the release candidates' runs."""
    candidates = releases(folder)
    newest = candidates[-1] if candidates else {"release": None, "file": None, "records": []}
    return {
        "release": newest["release"],
        "runs_file": newest["file"],
        "runs": newest["records"],
        "modules": json.loads((EVIDENCE / "modules.json").read_text()),
        "missing_runs": [part for part in parts() if part not in {record["job"] for record in newest["records"]}],
        "coverage": coverage(newest["records"]),
        "clocks": clocks(newest["records"]),
        "mutants": mutants(newest["records"]),
        "proofs": proofs(newest["records"]),
        "foreign_judges": foreign_judges(newest["records"]),
        "sizes": sizes(),
        "papers": papers(),
        "peers": tomllib.loads((EVIDENCE / "peers.toml").read_text())["figure"],
        "history": [{"release": c["release"], "totals": totals(c["records"])} for c in candidates],
    }


def totals(records: list[dict]) -> dict:
    """Sums over the runs of a release candidate, for the charts."""
    sums = {"runs": len(records), "failed runs": sum(record["result"] != "passed" for record in records),
            "processor hours": round(sum(record["processor_seconds"] for record in records) / 3600, 2)}
    for record in filter(counts.add_up, records):
        for name, count in record["counts"].items():
            sums[name] = sums.get(name, 0) + count
    return sums
