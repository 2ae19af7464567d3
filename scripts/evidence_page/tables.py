"""The parts of the evidence page as HTML: a function for each section, from the data of gather()."""
import re
from html import escape as escaped

# Target of the page's links: the site's pages of the files (scripts/documentation/site-pages), relative to
# build/site/evidence.
SOURCE = "../source"


def escape(text: str) -> str:
    """A text of the data as HTML; text between backticks becomes code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escaped(text))


def link(path: str, text: str) -> str:
    """A link to the site's page of a file of the project."""
    page = path.removesuffix(".md")
    target = f"../{page.removeprefix('docs/')}.html" if path.startswith("docs/") else f"{SOURCE}/{page}.html"
    return f'<a href="{escaped(target)}">{escape(text)}</a>'


def code(text: str) -> str:
    return f"<code>{escaped(text)}</code>"


def mark(result: str) -> str:
    """A verdict as a word with its colour's class."""
    kind = {"passed": "good", "failed": "bad", "timeout": "bad", "cancelled": "bad"}.get(result, "none")
    return f'<span class="{kind}">{escape(result)}</span>'


def table(head: list[str], rows: list[list[str]], caption: str) -> str:
    """Cells are HTML already. A table without rows says so instead of showing an empty frame."""
    if not rows:
        return f"<p>{escape(caption)}: <span class=\"none\">nothing is recorded yet</span></p>"
    lines = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>\n" for row in rows)
    heads = "".join(f"<th>{escape(title)}</th>" for title in head)
    return f"<table><caption>{escape(caption)}</caption><thead><tr>{heads}</tr></thead>\n<tbody>{lines}</tbody></table>"


KINDS = ("line", "branch", "toggle")


def number(value: int) -> str:
    return f"{value:,}"


def runs(data: dict) -> str:
    rows = [[code(run["job"]), mark(run["result"]), "; ".join(f"{number(n)} {escape(in_words(what))}" for what, n in sorted(run["counts"].items())),
             f"{run['processor_seconds']:,.0f}", f"{run['seconds']:,.0f}", code(run["commit"][:8]), code(run["command"])]
            for run in data["runs"]]
    return (table(["run", "result", "counted", "processor s", "s", "commit", "command"], rows, "Complete runs of this release candidate")
            + missing(data["missing_runs"]))


def in_words(count: str) -> str:
    """What a record counts. Tests print "of them" for a part of the clocks in the line before; the table is sorted."""
    return count.replace("_", " ").replace("of them with", "clocks with")


def missing(jobs: list[str]) -> str:
    """The runs without a record; the shards of a part as one entry."""
    shards: dict = {}
    for job in jobs:
        part, _, number = job.removeprefix("part-").rpartition("-")
        shards.setdefault(part if number.isdigit() else job.removeprefix("part-"), []).append(number)
    names = [code(part) + (f" (shards {', '.join(numbers)})" if numbers[0].isdigit() else "") for part, numbers in shards.items()]
    return f'<p><span class="none">Not recorded yet</span>: {", ".join(names)}.</p>' if names else ""


def modules(data: dict) -> str:
    rows = []
    for row in data["modules"]:
        rows.append([link(f"rtl/{row['file']}", row["module"]), code(row["lockstep"]), compared(data["clocks"], row["lockstep"]),
                     number(row["seeded_bugs"]),
                     proved(data["proofs"], row), killed(data["mutants"], row), number(row["listed"]),
                     *(covered(data["coverage"], row["module"], kind) for kind in KINDS)])
    return table(["module", "smallest lockstep", "clocks compared in it", "seeded bugs", "proof: runs as expected", "mutants killed", "listed as equivalent",
                  *(f"{kind} points covered" for kind in KINDS)], rows, "Modules of the RTL")


def compared(clocks: dict, lockstep: str) -> str:
    return number(clocks[lockstep]) if lockstep in clocks else '<span class="none">not recorded</span>'


def proved(proofs: dict, row: dict) -> str:
    """A proof with its covers and seeded bugs, named if it is not the module's own; a module that only connects others
    has none."""
    name = row["proof"]
    if not name:
        return '<span class="none">none</span>'
    figure = proofs.get(name)
    text = f"{figure['as_expected']} of {figure['runs']}" if figure else "not recorded"
    verdict = "none" if not figure else "plain" if figure["as_expected"] == figure["runs"] else "bad"
    named = "" if name == row["module"] else f"{name}: "
    return f'<span class="{verdict}">{link(f"verif/formal/{name}.properties", named + text)}</span>'


def killed(mutants: dict, row: dict) -> str:
    """Killed out of all mutants of the module. Mutants that are listed with a reason need not be killed."""
    figure = mutants.get(row["module"], {"tried": 0, "killed": 0})
    if figure["tried"] < row["mutants"]:
        return f'<span class="none">{number(figure["tried"])} of {number(row["mutants"])} tried</span>'
    text = f"{number(figure['killed'])} of {number(row['mutants'])}"
    return text if figure["killed"] + row["listed"] >= figure["tried"] else f'<span class="bad">{text}</span>'


def covered(coverage: dict, module: str, kind: str) -> str:
    """Covered points out of all, and the waived ones. Modules with only wires have no lines and no branches."""
    if module not in coverage:
        return '<span class="none">not recorded</span>'
    points = coverage[module].get(kind)
    if points is None:
        measured = any(kind in kinds for kinds in coverage.values())
        return "none" if measured else '<span class="none">not recorded</span>'
    missing = points["points"] - points["covered"] - points["waived"]
    text = f"{number(points['covered'])} of {number(points['points'])}" + (f", {points['waived']} waived" if points["waived"] else "")
    return f'<span class="bad">{text}</span>' if missing else text


def foreign_judges(data: dict) -> str:
    rows = []
    for judge in data["foreign_judges"]:
        seen = [f"{judge['passed_tests']} of {judge['all_tests']} tests"] if judge["all_tests"] else []
        seen += [code(job) for job in judge["runs"]]
        rows.append([link(judge["page"], judge["name"]), escape(judge["version"]), escape(judge["judges"]), mark(judge["result"]),
                     ", ".join(seen)])
    return table(["judge", "version", "what it judges", "result", "in"], rows, "Third-party judges")


def sizes(data: dict) -> str:
    rows = [[escape(row["build"]), f"{number(row['area'])} {row['unit']}", number(row["memory"]), f"{row['median_fmax_mhz']:g}",
             " ".join(f"{f:g}" for f in row["fmax_mhz"]), code(str(row["rtl"])), link("boards/results/README.md", row["tools"])]
            for row in data["sizes"]]
    return table(["build", "size", "block RAMs", "MHz, median", "MHz, each seed", "RTL of", "tools"], rows, "Sizes and clocks")


def papers(data: dict) -> str:
    verdicts = ["PASS", "CORRECTED", "ADDED", "OPEN", "FAIL"]
    rows = [[link(row["file"], row["paper"]), *(f'<span class="{"bad" if v == "FAIL" and row[v] else "plain"}">{row[v]}</span>' for v in verdicts)]
            for row in data["papers"]]
    return table(["paper", *verdicts], rows, "Items of both papers, as trammel reproduce found them")


def peers(data: dict) -> str:
    rows = [[escape(row["what"]), escape(row["peer"]), with_address(row["source"]), escape(row["here"]), code(row["shown_by"])]
            for row in data["peers"]]
    return table(["what", "another controller", "read in", "this card", "shown by"], rows, "Figures of other controllers")


def with_address(source: str) -> str:
    """A source is an address, a blank, and the place in the document."""
    address, _, place = source.partition(" ")
    return f'<a href="{escaped(address)}">{escaped(address.split("//")[-1].split("/")[0])}</a> {escape(place)}'
