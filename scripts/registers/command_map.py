"""The stream commands as plain data, read from TOML, and checked for rules that the card's checker cannot express."""

import tomllib
from dataclasses import dataclass
from typing import List, Optional

from .errors import DescriptionError

HALFWORD = 16
HEADER_HALFWORDS = 2
COUNT_HALFWORDS = 3
COUNT_BITS = 40
MAX_AXES = 8
PLANE_AXES = 2
MASK_RULES = ["none", "any", "plane", "plane_and_axes", "flags"]
# The only limit, apart from the width of a field's halfwords, that the checker can compare with: one pulse per tick.
UNIT_LIMIT = 1 << 40
UNIT_LIMIT_HALFWORDS = 3


class CommandError(DescriptionError):
    """A layout that the generated files cannot express."""


@dataclass
class Count:
    name: str
    minimum: int
    maximum: int
    unit: str
    brief: str


@dataclass
class Field:
    name: str
    kind: str  # unsigned or signed
    bits: int
    per_axis: bool
    offset: int  # in halfwords from the payload's start (for a field per axis: of the first axis)
    halfwords: int
    minimum: int
    limit: Optional[int]  # largest magnitude, if the bits allow more
    bit_mask: Optional[int]  # bits that may be set, if they are not contiguous
    optional_bits: int  # more bits that may be set when `optional_engine` is built in
    optional_engine: str
    at_most_count: bool
    unit: str
    brief: str
    why: str


@dataclass
class Flags:
    maximum: int  # largest value of the mask byte without the bits `free`
    engine: str  # engine that values other than 0 need
    free: int  # bits that every card accepts
    brief: str


@dataclass
class Command:
    name: str
    opcode: int
    queues: List[str]
    mask: str  # one of MASK_RULES
    engine: str  # engine (units.toml) without which the opcode is unknown; empty: always there
    built: bool  # false: only specified; every card rejects the opcode as unknown
    flags: Optional[Flags]  # only with the mask rule `flags`
    brief: str
    notes: str  # Markdown text after the fields
    count: Count
    fields: List[Field]

    @property
    def fixed_halfwords(self):
        """Length of the payload before the part that is repeated for every axis."""
        return sum(f.halfwords for f in self.fields if not f.per_axis)

    @property
    def axis_halfwords(self):
        return sum(f.halfwords for f in self.fields if f.per_axis)

    @property
    def axes_in_base(self):
        """Number of axes whose fields are in the fixed part of the payload instead of the repeated part."""
        return PLANE_AXES if self.mask == "plane_and_axes" else 0

    @property
    def base_halfwords(self):
        return HEADER_HALFWORDS + COUNT_HALFWORDS + self.fixed_halfwords


@dataclass
class Constant:
    """A number that the design of the card determines, for hosts, models and RTL."""

    name: str
    value: int
    brief: str


@dataclass
class CommandMap:
    version: int
    commands: List[Command]


def read_command_map(path):
    with open(path, "rb") as file:
        data = tomllib.load(file)
    commands = [_command(entry) for entry in data["command"]]
    if len({c.opcode for c in commands}) != len(commands):
        raise CommandError("two commands share an opcode")
    return CommandMap(data["version"], commands)


def read_constants(path):
    with open(path, "rb") as file:
        return [Constant(**entry) for entry in tomllib.load(file)["constant"]]


def _command(entry):
    count = entry["count"]
    flags = entry.get("flags")
    command = Command(
        name=entry["name"],
        opcode=entry["opcode"],
        queues=entry["queues"],
        mask=entry["mask"],
        engine=entry.get("engine", ""),
        built=entry.get("built", True),
        flags=Flags(flags["max"], flags["engine"], flags["free"], flags["brief"]) if flags else None,
        brief=entry["brief"],
        notes=entry.get("notes", ""),
        count=Count(
            name=count["name"],
            minimum=count["min"],
            maximum=count.get("max", (1 << COUNT_BITS) - 1),
            unit=count["unit"],
            brief=count["brief"],
        ),
        fields=[],
    )
    offset = 0
    for description in entry.get("field", []):
        field = _field(description, offset)
        offset += field.halfwords
        command.fields.append(field)
    _check(command)
    return command


def _field(entry, offset):
    optional = entry.get("optional", {})
    return Field(
        name=entry["name"],
        kind=entry["kind"],
        bits=entry["bits"],
        per_axis=entry.get("per_axis", False),
        offset=offset,
        halfwords=-(-entry["bits"] // HALFWORD),
        minimum=entry.get("min", 0),
        limit=entry.get("magnitude_max", entry.get("max")),
        bit_mask=entry.get("mask"),
        optional_bits=optional.get("bits", 0),
        optional_engine=optional.get("engine", ""),
        at_most_count=entry.get("at_most_count", False),
        unit=entry.get("unit", ""),
        brief=entry["brief"],
        why=entry["why"],
    )


def _check(command):
    def need(condition, text):
        if not condition:
            raise CommandError(f"{command.name}: {text}")

    need(command.mask in MASK_RULES, f"mask {command.mask}")
    need((command.flags is not None) == (command.mask == "flags"), "flags are described where the mask byte has them")
    need(command.count.minimum in (0, 1), "a count's minimum is 0 or 1")
    need(command.count.maximum in (0, (1 << COUNT_BITS) - 1), "a count's maximum is 0 or all ones")
    after_axis_part = False
    for field in command.fields:
        need(field.kind in ("unsigned", "signed"), f"kind {field.kind}")
        need(field.per_axis or not after_axis_part, f"{field.name} follows a field per axis")
        after_axis_part = field.per_axis
        need(field.minimum in (0, 1), f"{field.name}: a minimum is 0 or 1")
        if field.limit is not None:
            need(field.limit == UNIT_LIMIT, f"{field.name}: only 2^40 is a limit")
            need(field.halfwords == UNIT_LIMIT_HALFWORDS, f"{field.name}: a limited field has 3 halfwords")
        elif field.kind == "signed":
            need(field.bits % HALFWORD == 0, f"{field.name}: a signed field without limit fills its halfwords")
        if field.at_most_count:
            need(field.halfwords == COUNT_HALFWORDS, f"{field.name}: as wide as the count")
        if field.bit_mask is not None:
            need(field.halfwords == 1, f"{field.name}: a mask covers one halfword")
        else:
            need(not field.optional_bits, f"{field.name}: optional bits come on top of a mask")
