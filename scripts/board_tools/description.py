"""The description of a board, boards/NAME/board.toml, read and checked."""
import math
import re
import sys
import tomllib
from dataclasses import dataclass

from rtl.file_list import ROOT

BOARDS = ROOT / "boards"
RESET_SECONDS = 16e-6  # from the PLL's lock to the reset's end, at least
GROUPS = ("step", "dir", "output", "input")


class DescriptionError(Exception):
    """What is wrong with a description; the file is named by who catches it."""


@dataclass(frozen=True)
class Pin:
    signal: str  # the top's port, with its index: "step_o[2]"
    site: str  # the device's pin
    place: str  # where the board has it
    pull_up: bool = False
    level: int = None  # of a pin that stands still


@dataclass(frozen=True)
class Board:
    name: str
    title: str
    board_id: int
    family: str
    device: str
    package: str
    crystal_mhz: float
    clock_mhz: float
    sources: tuple
    pll: dict
    card: dict
    pins: tuple
    widths: dict  # of the groups of pins
    constants: dict  # ports that stand still: their levels
    emergency_stop: bool  # has a pin for it
    least_set: int = 1

    @property
    def top(self):
        return "top_" + self.name.replace("-", "_")

    @property
    def folder(self):
        return BOARDS / self.name

    @property
    def clock_hz(self):
        return round(self.clock_mhz * 1e6)

    @property
    def reset_bits(self):
        return math.ceil(math.log2(RESET_SECONDS * self.clock_hz))


def split(signal, text, **more):
    """A pin from its text, "SITE where the board has it"."""
    found = re.fullmatch(r"([A-Z]+[0-9]+) (.+)", text)
    if not found:
        raise DescriptionError(f"pins: {signal}: {text!r} is not a pin and its place")
    return Pin(signal, *found.groups(), **more)


def read_pins(raw):
    """All pins of a board, in the order of its table."""
    pins = [split("clk_i", raw["clock"]), split("rx_i", raw["rx"], pull_up=True), split("tx_o", raw["tx"])]
    for group in GROUPS:
        way = "i" if group == "input" else "o"
        pins += [split(f"{group}_{way}[{i}]", text, pull_up=way == "i") for i, text in enumerate(raw[group])]
    # Normally closed to ground: the pull-up makes a broken wire a stop.
    if "emergency_stop" in raw:
        pins.append(split("emergency_stop_i", raw["emergency_stop"], pull_up=True))
    return pins


def ice40_megahertz(pll, crystal):
    """Clock, and what must lie in which range: phase detector and oscillator, MHz."""
    detector = crystal / (pll["Divr"] + 1)
    oscillator = detector * (pll["Divf"] + 1)
    return oscillator / 2**pll["Divq"], [("phase detector", detector, 10, 133), ("oscillator", oscillator, 533, 1066)]


def ecp5_megahertz(pll, crystal):
    oscillator = crystal * pll["FeedbackDiv"]
    return oscillator / pll["ClockDiv"], [("phase detector", crystal, 10, 400), ("oscillator", oscillator, 400, 800)]


MEGAHERTZ = {"ice40": ice40_megahertz, "ecp5": ecp5_megahertz}


def check(board):
    """Raises what does not fit together."""
    if board.family not in MEGAHERTZ:
        raise DescriptionError(f"family {board.family!r}: only {', '.join(MEGAHERTZ)}")
    clock, ranges = MEGAHERTZ[board.family](board.pll, board.crystal_mhz)
    if clock != board.clock_mhz:
        raise DescriptionError(f"pll: its clock is {clock:g} MHz, clock_mhz says {board.clock_mhz:g}")
    for what, value, least, most in ranges:
        if not least <= value <= most:
            raise DescriptionError(f"pll: the {what} runs at {value:g} MHz, and must at {least} to {most}")
    for group, name in (("step", "Axes"), ("dir", "Axes"), ("output", "Outputs"), ("input", "Inputs")):
        if board.widths[group] != board.card[name]:
            raise DescriptionError(f"pins: {board.widths[group]} of {group}, card: {name} = {board.card[name]}")
    if board.emergency_stop != (board.card.get("EmergencyStop", 0) == 1):
        raise DescriptionError("pins: emergency_stop is named without EmergencyStop = 1 of the card, or the other way round")
    sites = [pin.site for pin in board.pins]
    for site in sites:
        if sites.count(site) > 1:
            raise DescriptionError(f"pins: {site} is named {sites.count(site)} times")


def load(name):
    """The board of that name; ends the program where its description is wrong."""
    file = BOARDS / name / "board.toml"
    try:
        raw = tomllib.loads(file.read_text())
        pins, widths = read_pins(raw["pins"]), {group: len(raw["pins"][group]) for group in GROUPS}
        constants = raw.pop("constant", {})
        pins += [split(f"{port}_o", value["pin"], level=value["level"]) for port, value in constants.items()]
        levels = {f"{port}_o": value["level"] for port, value in constants.items()}
        board = Board(name=name, **{**raw, "pins": tuple(pins), "sources": tuple(raw["sources"])}, widths=widths,
                      constants=levels, emergency_stop="emergency_stop" in raw["pins"])
        check(board)
    except (DescriptionError, KeyError, TypeError, tomllib.TOMLDecodeError) as error:
        what = f"{error} is missing" if isinstance(error, KeyError) else error
        sys.exit(f"error: {file.relative_to(ROOT)}: {what}")
    return board


def names():
    """The boards that there are."""
    return sorted(file.parent.name for file in BOARDS.glob("*/board.toml"))
