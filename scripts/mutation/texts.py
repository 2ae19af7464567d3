"""Writes every mutant of one RTL file as a separate file, for judges that read source text: proofs."""

import argparse
import re
import sys
import tempfile
from pathlib import Path
from typing import Optional

from .instrument import Mutant, instrument


def mutated(text: str, mutant: Mutant) -> Optional[str]:
    """The whole text with the mutant's change; None when the change is no replaced text (swapped labels,
    connections)."""
    # The spaces of the mutant's text come from the parser, so they do not count.
    pattern = r"\s*".join(re.escape(token) for token in re.findall(r"\w+|\S", mutant.original))
    places = list(re.finditer(pattern, text))
    if len(places) < mutant.nth:
        return None
    place = places[mutant.nth - 1]
    return text[: place.start()] + mutant.mutated + text[place.end():]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rtl", type=Path, default=Path("rtl"), help="folder of the RTL (rtl)")
    parser.add_argument("--out", type=Path, required=True, help="folder for ID.rtl and `list`: ID, line and slip of each")
    parser.add_argument("file", type=Path, help="source below the folder of the RTL")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as unused:
        mutants = instrument(arguments.rtl, [arguments.file], Path(unused))
    text = arguments.file.read_text()
    arguments.out.mkdir(parents=True, exist_ok=True)
    lines = []
    for mutant in mutants:
        changed = mutated(text, mutant)
        if changed is None:
            print(f"not tried: line {mutant.line}: {mutant.original}  ->  {mutant.mutated}")
            continue
        (arguments.out / f"{mutant.id}.rtl").write_text(changed)
        lines.append(f"{mutant.id} line {mutant.line}: {mutant.original}  ->  {mutant.mutated}\n")
    (arguments.out / "list").write_text("".join(lines))
    return 0


if __name__ == "__main__":
    sys.exit(main())
