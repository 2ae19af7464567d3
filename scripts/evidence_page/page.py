"""Writes the page and its data. Nothing in it is loaded from a network."""
import json
import re
import shutil
from html import escape
from pathlib import Path

from evidence_page import charts, tables
from evidence_page.gather import ROOT

STYLE = """
:root { color-scheme: light dark; --line: #8886; }
body { font: 15px/1.45 system-ui, sans-serif; margin: 2rem auto; max-width: 76rem; padding: 0 1rem; }
table { border-collapse: collapse; display: block; font-size: 13px; margin: 1rem 0 2rem; overflow-x: auto; }
caption { font-weight: 600; padding: .4rem 0; text-align: left; }
th, td { border-bottom: 1px solid var(--line); padding: .2rem .45rem; text-align: left; vertical-align: top; }
code { font-size: 12px; } td:first-child code { white-space: nowrap; }
.good, .bad, .none { white-space: nowrap; } .good { color: #18794e; font-weight: 600; } .bad, .bad a { color: #c62828; font-weight: 700; } .none, .none a { color: #9a6700; }
@media (prefers-color-scheme: dark) { .good { color: #4cc38a; } .bad, .bad a { color: #ff6369; } .none, .none a { color: #f1a10d; } }
.sums { display: flex; flex-wrap: wrap; gap: .6rem 2rem; padding: 0; } .sums li { list-style: none; } .sums b { display: block; font-size: 1.5rem; }
table:has(+ .raw) { margin-bottom: .3rem; } .raw { font-size: 13px; margin: 0 0 2rem; }
"""

# Each section: the function that writes it, its raw files, and the commands that make them. RUNS is the release
# candidate's file.
RUNS = "RUNS"
SECTIONS = [
    (tables.runs, [RUNS], ["scripts/test", "scripts/test --long", "scripts/evidence keep"]),
    (lambda data: charts.section(data["history"]), [], []),
    (tables.foreign_judges, [RUNS, "verif/evidence/foreign_judges.toml"], ["scripts/test", "scripts/test --long"]),
    (tables.modules, ["verif/evidence/modules.json", RUNS], ["scripts/rtl/judges", "scripts/test", "scripts/test --long", "scripts/mutate", "scripts/prove"]),
    (tables.sizes, ["boards/results/hx8k.json", "boards/results/ecp5-25k.json", "boards/results/boards.json"], ["scripts/synthesise", "scripts/boards"]),
    (tables.papers, ["docs/papers/README.md"], ["trammel reproduce"]),
    (tables.peers, ["verif/evidence/peers.toml"], []),
]


def sums(data: dict) -> str:
    """The most important figures, as a list."""
    modules = data["modules"]
    failed = sum(run["result"] != "passed" for run in data["runs"])
    judges = data["foreign_judges"]
    totals = data["history"][-1]["totals"] if data["history"] else {}
    figures = [
        (f"{sum(m['proof'] is not None for m in modules)} of {len(modules)}", "modules with a proof"),
        (f"{sum(m['seeded_bugs'] for m in modules):,}", "seeded bugs in the RTL"),
        (f"{sum(m['mutants'] for m in modules):,}", "mutants of the RTL"),
        (f"{totals.get('seeded_bugs_found', 0):,}", "seeded bugs found by tests"),
        (f"{totals.get('frames through a bad link', 0):,}", "frames through a bad link"),
        (f"{totals.get('clocks compared in lockstep', 0):,}", "clocks compared in lockstep"),
        (f"{sum(j['result'] == 'passed' for j in judges)} of {len(judges)}", "third-party judges passed"),
        (f"{len(data['runs'])}", f"complete runs, {failed} of them failed"),
    ]
    return '<ul class="sums">' + "".join(f"<li><b>{escape(n)}</b>{escape(text)}</li>" for n, text in figures) + "</ul>"


def raw_files(files: list[str], data: dict) -> list[str]:
    """The files, RUNS replaced by the release candidate's, if there is one."""
    return [data["runs_file"] if file is RUNS else file for file in files if file is not RUNS or data["runs_file"]]


def raw(files: list[str], commands: list[str]) -> str:
    """The line below a table that links to its raw files and names the commands that make them."""
    if not files:
        return ""
    links = ", ".join(f'<a href="raw/{Path(file).name}">{escape(file)}</a>' for file in files)
    made = f"; made by {', '.join(map(tables.code, commands))}" if commands else "; kept by hand"
    return f'<p class="raw">Raw data: {links}{made}.</p>'


def html(data: dict) -> str:
    sections = [write_section(data) + raw(raw_files(files, data), commands) for write_section, files, commands in SECTIONS]
    release = data["release"] or "no release candidate yet"
    return (f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
            f"<title>Evidence, {escape(release)}</title><style>{STYLE}</style>{charts.head(data['history'])}</head><body>\n"
            f"<h1>Evidence: {escape(release)}</h1>\n"
            '<p>The tests and checks ("judges") of this release candidate and their results. Each run was complete and used the '
            'sources of the commit in its row; failures are red. <a href="evidence.json">The same as data</a>; '
            f'{tables.link("docs/developer/evidence.md", "which faults would have to occur together for a wrong pulse to go unnoticed")}.</p>\n'
            f"{sums(data)}\n" + "\n".join(sections) + "\n</body></html>\n")


def write(folder: Path, data: dict) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "evidence.json").write_text(json.dumps(data, indent=1) + "\n")
    (folder / "index.html").write_text(html(data))
    (folder / "raw").mkdir(exist_ok=True)
    for file in {file for _, files, _ in SECTIONS for file in raw_files(files, data)}:
        shutil.copyfile(ROOT / file, folder / "raw" / Path(file).name)


def dead_links(folder: Path) -> list[str]:
    """Links of the page to missing files; valid only when the page lies in the built site."""
    links = set(re.findall(r'href="([^"#]+)"', (folder / "index.html").read_text()))
    return sorted(link for link in links if "://" not in link and not (folder / link).exists())
