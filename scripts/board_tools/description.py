"""The description of a board, boards/NAME/board.toml, read and checked."""
import math
import re
import sys
import tomllib
from dataclasses import dataclass, replace

from rtl.file_list import ROOT

BOARDS = ROOT / "boards"
RESET_SECONDS = 16e-6  # shortest time from the PLL's lock to the end of reset
GROUPS = ("step", "dir", "output", "input")
DEVICES = {"ice40": {"hx1k", "hx4k", "hx8k"}, "ecp5": {"12k", "25k", "45k", "85k"}}  # as the placers name them
# Roles that a machine file can give to inputs and outputs (docs/user/inputs.md, outputs.md). Those of AXIS_ROLES follow
# the name of an axis: "x_home".
AXIS_ROLES = ("limit_minus", "limit_plus", "home", "drive_fault")
INPUT_ROLES = {*(f"{axis}_{role}" for axis in "xyzabcuvwe" for role in AXIS_ROLES), "feed_hold", "cycle_start", "tool_setter",
               "spindle_at_speed", "probe"}
OUTPUT_ROLES = {"m3", "m4", "m7", "m8", "enable", "brake", "charge_pump", "healthy"} | {f"p{n}" for n in range(16)}


class DescriptionError(Exception):
    """An error in a description. The handler adds the name of the file."""


@dataclass(frozen=True)
class Pin:
    signal: str  # port of the top module, with its index: "step_o[2]"
    site: str  # the device's pin
    place: str  # connector and pin on the board
    pull_up: bool = False
    level: int = None  # of a pin with a constant level
    roles: tuple = ()  # suggested roles, as keys of the machine file


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
    widths: dict  # number of pins per group of GROUPS
    constants: dict  # level of each port with a constant level
    emergency_stop: bool  # whether the board has a pin for it
    roles: dict  # suggested for inputs and outputs: {"input": ["x_limit_minus x_home", ...], "output": [...]}
    least_set: int = 1
    base: str = ""  # of a variant: the board whose folder the variant shares

    @property
    def top(self):
        return "top_" + self.folder.name.replace("-", "_")

    @property
    def folder(self):
        return BOARDS / (self.base or self.name)

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


def roles_of(roles, group, index):
    """The roles that are suggested for an input or an output."""
    suggested = roles.get(group, [])
    return tuple(suggested[index].split()) if index < len(suggested) else ()


def read_pins(raw, roles):
    """All pins of a board, in the order of its table."""
    pins = [split("clk_i", raw["clock"]), split("rx_i", raw["rx"], pull_up=True), split("tx_o", raw["tx"])]
    for group in GROUPS:
        way = "i" if group == "input" else "o"
        pins += [split(f"{group}_{way}[{i}]", text, pull_up=way == "i", roles=roles_of(roles, group, i))
                 for i, text in enumerate(raw[group])]
    # Normally closed to ground: the pull-up makes a broken wire a stop.
    if "emergency_stop" in raw:
        pins.append(split("emergency_stop_i", raw["emergency_stop"], pull_up=True))
    return pins


def ice40_megahertz(pll, crystal):
    """The clock in MHz, and (name, MHz, lowest, highest) of the phase detector and the oscillator."""
    detector = crystal / (pll["Divr"] + 1)
    oscillator = detector * (pll["Divf"] + 1)
    return oscillator / 2**pll["Divq"], [("phase detector", detector, 10, 133), ("oscillator", oscillator, 533, 1066)]


def ecp5_megahertz(pll, crystal):
    oscillator = crystal * pll["FeedbackDiv"]
    return oscillator / pll["ClockDiv"], [("phase detector", crystal, 10, 400), ("oscillator", oscillator, 400, 800)]


MEGAHERTZ = {"ice40": ice40_megahertz, "ecp5": ecp5_megahertz}


def check_roles(board):
    """Raises DescriptionError for roles that a machine file or the card would refuse."""
    for group, known in (("input", INPUT_ROLES), ("output", OUTPUT_ROLES)):
        suggested = board.roles.get(group, [])
        if len(suggested) > board.widths[group]:
            raise DescriptionError(f"roles: {len(suggested)} of {group}, the board has {board.widths[group]}")
        named = [role for text in suggested for role in text.split()]
        wrong = [role for role in named if role not in known or named.count(role) > 1]
        if wrong:
            raise DescriptionError(f"roles: {group}: {wrong[0]} is unknown, or named twice")
        if any(role.endswith("_home") for role in named) and not board.card.get("Captures"):
            raise DescriptionError("roles: input: a card without Captures cannot home")
    if set(board.roles) - {"input", "output"}:
        raise DescriptionError("roles: only input and output have any")


def check(board):
    """Raises DescriptionError for entries that contradict each other."""
    check_roles(board)
    if board.family not in MEGAHERTZ:
        raise DescriptionError(f"family {board.family!r}: only {', '.join(MEGAHERTZ)}")
    if board.device not in DEVICES[board.family]:
        raise DescriptionError(f"device {board.device!r}: only {', '.join(sorted(DEVICES[board.family]))}")
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
    """The board of that name; exits when its description is wrong."""
    file = BOARDS / name / "board.toml"
    try:
        raw = tomllib.loads(file.read_text())
        raw.pop("variant", None)
        roles = raw.pop("roles", {})
        pins, widths = read_pins(raw["pins"], roles), {group: len(raw["pins"][group]) for group in GROUPS}
        constants = raw.pop("constant", {})
        pins += [split(f"{port}_o", value["pin"], level=value["level"]) for port, value in constants.items()]
        levels = {f"{port}_o": value["level"] for port, value in constants.items()}
        board = Board(name=name, **{**raw, "pins": tuple(pins), "sources": tuple(raw["sources"])}, widths=widths,
                      constants=levels, emergency_stop="emergency_stop" in raw["pins"], roles=roles)
        check(board)
    except (DescriptionError, KeyError, TypeError, tomllib.TOMLDecodeError) as error:
        what = f"{error} is missing" if isinstance(error, KeyError) else error
        sys.exit(f"error: {file.relative_to(ROOT)}: {what}")
    return board


def names():
    """Names of all boards."""
    return sorted(file.parent.name for file in BOARDS.glob("*/board.toml"))


def variants(board):
    """The same board with another device, from [variant.NAME]. A variant shares the board's top and constraints and has
    its own bitstream."""
    raw = tomllib.loads((board.folder / "board.toml").read_text()).get("variant", {})
    found = []
    for name, entries in raw.items():
        if set(entries) != {"title", "device"}:
            sys.exit(f"error: boards/{board.name}/board.toml: variant.{name}: needs title and device, and has nothing else")
        if entries["device"] not in DEVICES[board.family] - {board.device}:
            sys.exit(f"error: boards/{board.name}/board.toml: variant.{name}: device {entries['device']!r} is unknown, or the board's own")
        found.append(replace(board, name=f"{board.name}-{name}", base=board.name, **entries))
    return found
