"""Compiles the template of docs/reference/integration.md in every reader, and compares its tables with the card."""
import json
import math
import re

from checks import readers
from file_list import ROOT, sources

PAGE = ROOT / "docs" / "reference" / "integration.md"
BUILD = ROOT / "build" / "integration"
TOP, CARD = "my_machine", "trammel_card"
AXES, PINS = 3, 4  # axes of the template; its inputs, and also its outputs


def width(text):
    """Evaluates a width of the table, such as `2 Axes + 1`, for the template's axes and pins."""
    terms = (term.split() for term in text.split("+"))
    names = {"Axes": AXES, "Inputs": PINS, "Outputs": PINS}
    return sum(math.prod(names.get(word) or int(word) for word in term) for term in terms)


def table_complaints(page):
    """Missing and superfluous rows of the port table and the parameter table."""
    modules = json.loads((BUILD / "ports.json").read_text())["modules"]
    # With parameters the name is $paramod\name\values or $paramod$hash\name.
    card = next(m for name, m in modules.items() if CARD in name.split("\\"))
    directions = {"input": "in", "output": "out"}
    real = {(name, directions[p["direction"]], len(p["bits"])) for name, p in card["ports"].items()}
    told = {(name, way, width(text)) for name, way, text in
            re.findall(r"^\| `(\w+)` \| (in|out) \| ([\w +]+) \|", page, re.M)}
    wrong = [f"{name} ({way}, {bits} bits): in the {'module' if (name, way, bits) in real else 'table'} only"
             for name, way, bits in sorted(real ^ told)]
    source = next(s for s in sources() if s.endswith(f"/{CARD}.sv"))
    header = (ROOT / source).read_text().split(") (", 1)[0]
    parameters = set(re.findall(r"parameter\s+(?:[\w\[\]:]+\s+)*?(\w+)\s*=\s*(\w+)", header))
    told = set(re.findall(r"^\| `([A-Z]\w+)` \| (\w+) \|", page, re.M)) - {(word, "in") for word in ("Axes", "Inputs", "Outputs")}
    return wrong + [f"parameter {name} = {value}: in the {'module' if (name, value) in parameters else 'table'} only"
                    for name, value in sorted(parameters ^ told)]


def complaints():
    BUILD.mkdir(parents=True, exist_ok=True)
    page = PAGE.read_text()
    template = BUILD / f"{TOP}.sv"
    template.write_text(re.search(r"^```systemverilog\n(.*?)^```$", page, re.M | re.S).group(1))
    ports = f"; proc; check -assert; write_json {BUILD.relative_to(ROOT)}/ports.json"
    wrong = []
    for reader, command in readers.commands(TOP, [str(template.relative_to(ROOT))], last=ports).items():
        said, good = readers.run(command)
        if not good:
            wrong.append(f"{reader} refuses the template of {PAGE.relative_to(ROOT)}:\n{said}")
    return wrong or table_complaints(page)
