"""Charts over release candidates, drawn by uPlot in the browser; the page contains the library, from
web/node_modules."""
import json
from html import escape
from pathlib import Path

UPLOT = Path(__file__).resolve().parents[2] / "web/node_modules/uplot/dist"
LEAST = 2  # least number of release candidates for a chart; with fewer, a chart shows no more than the tables

DRAW = """
for (const chart of CHARTS) {
  const place = document.getElementById(chart.id);
  const names = (u, splits) => splits.map(n => Number.isInteger(n) ? RELEASES[n] ?? "" : "");
  new uPlot({width: 520, height: 200, title: chart.title, scales: {x: {time: false}},
             axes: [{values: names, space: 90}, {size: 80}], series: [{value: (u, n) => RELEASES[n] ?? ""}, {label: chart.title, stroke: "#0b68cb", width: 2}]},
            [RELEASES.map((name, n) => n), chart.values], place);
}
"""


def are_drawn(history: list[dict]) -> bool:
    return len(history) >= LEAST and (UPLOT / "uPlot.iife.min.js").exists()


def head(history: list[dict]) -> str:
    if not are_drawn(history):
        return ""
    return f"<style>{(UPLOT / 'uPlot.min.css').read_text()}</style><script>{(UPLOT / 'uPlot.iife.min.js').read_text()}</script>"


def section(history: list[dict]) -> str:
    if len(history) < LEAST:
        return f"<p>Charts over release candidates begin with the second; there {'is one' if history else 'is none'}.</p>"
    if not are_drawn(history):
        return "<p>Charts need uPlot in web/node_modules; scripts/demo installs it.</p>"
    titles = sorted({title for release in history for title in release["totals"]})
    charts = [{"id": f"chart{n}", "title": title, "values": [release["totals"].get(title) for release in history]}
              for n, title in enumerate(titles)]
    names = json.dumps([release["release"] for release in history])
    places = "".join(f'<div id="{chart["id"]}" title="{escape(chart["title"])}"></div>' for chart in charts)
    return f'<h2>Over release candidates</h2><div class="sums">{places}</div><script>const RELEASES = {names}, CHARTS = {json.dumps(charts)};{DRAW}</script>'
