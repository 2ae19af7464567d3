"""Writes the page and its data. Nothing in it is loaded from a network."""
import json
import re
from html import escape
from pathlib import Path

from evidence_page import charts, tables

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
"""


def sums(data: dict) -> str:
    """The most important figures, as a list."""
    modules = data["modules"]
    failed = sum(run["result"] != "passed" for run in data["runs"])
    judges = data["foreign_judges"]
    figures = [
        (f"{sum(m['proof'] is not None for m in modules)} of {len(modules)}", "modules with a proof"),
        (f"{sum(m['seeded_bugs'] for m in modules):,}", "seeded bugs in the RTL"),
        (f"{sum(m['mutants'] for m in modules):,}", "mutants of the RTL"),
        (f"{sum(j['result'] == 'passed' for j in judges)} of {len(judges)}", "third-party judges passed"),
        (f"{len(data['runs'])}", f"complete runs, {failed} of them failed"),
    ]
    return '<ul class="sums">' + "".join(f"<li><b>{escape(n)}</b>{escape(text)}</li>" for n, text in figures) + "</ul>"


def html(data: dict) -> str:
    sections = [tables.runs(data), charts.section(data["history"]), tables.foreign_judges(data), tables.modules(data),
                tables.sizes(data), tables.papers(data), tables.peers(data)]
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


def dead_links(folder: Path) -> list[str]:
    """Links of the page to missing files; valid only when the page lies in the built site."""
    links = set(re.findall(r'href="([^"#]+)"', (folder / "index.html").read_text()))
    return sorted(link for link in links if "://" not in link and not (folder / link).exists())
