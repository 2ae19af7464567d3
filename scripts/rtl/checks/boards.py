"""Reads the top of each board in every reader, with stand-ins for the devices' primitives."""
import sys
from pathlib import Path

from checks import readers
from file_list import ROOT

sys.path.insert(0, str(ROOT / "scripts"))
from board_tools.description import load, names  # noqa: E402

PRIMITIVES = {"ice40": ["SB_IO", "SB_PLL40_CORE"], "ecp5": ["EHXPLLL", "OFS1P3BX", "OFS1P3DX"]}


def files_of(board):
    """The sources of a top, in addition to those of the card."""
    ours = [*(ROOT / "boards" / "rtl").glob("*.sv"), *(ROOT / "boards" / "rtl" / board.family).glob("*.sv")]
    stand_in = [ROOT / "boards" / "sim" / f"{name}.sv" for name in PRIMITIVES[board.family]]
    return [str(Path(f).relative_to(ROOT)) for f in [*sorted(ours), board.folder / f"{board.top}.sv", *stand_in]]


def complaints():
    wrong = []
    for board in map(load, names()):
        commands = readers.commands(board.top, files_of(board), waivers=["boards/sim/waivers.vlt"], last="; proc; check -assert")
        for reader, command in commands.items():
            said, good = readers.run(command)
            if not good:
                wrong.append(f"{reader} refuses {board.top}:\n{said}")
    return wrong
