"""Diagrams of a page: a fence ```dot (Graphviz), ```wavedrom or ```wiring (wiring.py), and below it the caption, a paragraph in
*italics*.

The site shows the drawing as an SVG file; the plain page shows the source and the caption."""
import re
import subprocess
import sys
from pathlib import Path

import wavedrom
import wiring

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from board_tools.description import load, names  # noqa: E402

DIAGRAM = re.compile(r"^```(dot|wavedrom|wiring)\n(.*?)^```$(?:\n\n\*([^*]+)\*$)?", re.MULTILINE | re.DOTALL)
# The style of every block diagram, so that a source has only blocks and connections.
DOT = ["dot", "-Tsvg", "-Gbgcolor=white", "-Gfontname=Helvetica", "-Gfontsize=12", "-Glabeljust=l", "-Gnodesep=0.25", "-Granksep=0.35",
       "-Nshape=box", "-Nstyle=rounded,filled", "-Nfillcolor=#eef3fa", "-Ncolor=#44628c", "-Nfontname=Helvetica", "-Nfontsize=12",
       "-Nheight=0.35", "-Nmargin=0.12,0.06", "-Ecolor=#555555", "-Efontname=Helvetica", "-Efontsize=10", "-Earrowsize=0.7"]


def block_diagram(source: str) -> str:
    run = subprocess.run(DOT, input=source, capture_output=True, text=True, check=False)
    if run.returncode or run.stderr:
        raise ValueError(run.stderr.strip())
    return run.stdout


def timing_diagram(source: str) -> str:
    drawing = wavedrom.render(source)
    drawing.elements.insert(1, drawing.rect(size=("100%", "100%"), fill="white"))  # behind all but definitions
    return drawing.tostring()


def with_places(label: str) -> str:
    """Replaces pins in a label by their places on the board: "@ulx3s.step_o[0]" by the place in
    boards/ulx3s/board.toml."""

    def place(match: re.Match) -> str:
        board, signal = match.groups()
        found = [pin.place for pin in load(board).pins if pin.signal == signal] if board in names() else []
        if not found:
            raise ValueError(f"{match.group(0)}: no such pin of a board")
        return found[0]

    return re.sub(r"@([\w-]+)\.([\w\[\]]+)", place, label)


def wiring_diagram(source: str) -> str:
    return wiring.draw(source, with_places)


DRAW = {"dot": block_diagram, "wavedrom": timing_diagram, "wiring": wiring_diagram}


def with_drawings(markdown: str, page: str, folder: Path) -> str:
    """Replaces each diagram of the page by an image, and writes the image files into FOLDER. Exits when a diagram
    fails."""
    number = 0

    def drawn(match: re.Match) -> str:
        nonlocal number
        number += 1
        kind, source, caption = match.groups()
        place = f"{page}:{markdown.count(chr(10), 0, match.start()) + 1}"
        if not caption:
            sys.exit(f"error: {place}: a diagram needs a caption below it, a paragraph in *italics*")
        name = f"{Path(page).stem.lower()}-{number}.svg"
        try:
            drawing = DRAW[kind](source)
        except Exception as problem:  # the tools raise various exceptions for a wrong source
            sys.exit(f"error: {place}: this {kind} diagram cannot be drawn: {problem}")
        folder.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(drawing)
        alternative = re.sub(r"[\[\]`]|\([^)]*\)", "", " ".join(caption.split()))
        return f"![{alternative}]({name})\n\n*{caption}*"

    return DIAGRAM.sub(drawn, markdown)
