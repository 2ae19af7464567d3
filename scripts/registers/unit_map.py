"""The card's units and the engines as plain data, read from TOML and checked against the register map."""

import tomllib
from dataclasses import dataclass
from typing import List, Optional, Union

from .errors import DescriptionError

# Widths of a descriptor's fields (rtl/regs/units.toml).
TAG_MAX, VERSION_MAX, INSTANCES_MAX, FEATURES = 0xFF, 0xF, 0xFF, 8
BASE_MAX, WORDS_MAX, STRIDE_MAX, LOAD_UNIT_NONE = 0x3FF, 0xFF, 0x7F, 31
DESCRIPTOR_WORDS = 2
# Numbers of instances that are parameters of the card.
COUNTS = ["Axes", "SnapshotAreas", "Ports", "Inputs", "Outputs", "Captures"]


class UnitError(DescriptionError):
    """A unit that its descriptor cannot express, or that does not fit the register map."""


@dataclass
class Engine:
    name: str
    low: int  # bit in the mask of engines
    brief: str


@dataclass
class Feature:
    bit: int
    engine: str
    brief: str


@dataclass
class Unit:
    name: str
    tag: int
    major: int
    minor: int
    brief: str
    engine: str  # engine that the unit needs; empty: every card has the unit
    instances: Union[int, str]  # a number, or one of COUNTS
    first: str  # first and last register of an instance; empty: none
    last: str
    stride: int  # words
    load_unit: int
    features: List[Feature]


@dataclass
class UnitMap:
    table: int  # byte address of the first descriptor
    slots: int
    units: List[Unit]
    engines: List[Engine]

    def engine_bit(self, name):
        """Bit of an engine; 0 (lines, which every card has) for an empty name."""
        return next(e.low for e in self.engines if e.name == name) if name else 0


def read_unit_map(path):
    with open(path, "rb") as file:
        data = tomllib.load(file)
    engines = [Engine(e["name"], e["bit"], e["brief"]) for e in data["engine"]]
    units = [_unit(entry) for entry in data["unit"]]
    result = UnitMap(data["table"], data["slots"], units, engines)
    _check(result)
    return result


def _unit(entry):
    major, minor = entry["version"]
    return Unit(
        name=entry["name"],
        tag=entry["tag"],
        major=major,
        minor=minor,
        brief=entry["brief"],
        engine=entry.get("engine", ""),
        instances=entry["instances"],
        first=entry.get("first", ""),
        last=entry.get("last", ""),
        stride=entry.get("stride", 0),
        load_unit=entry.get("load_unit", LOAD_UNIT_NONE),
        features=[Feature(f["bit"], f["engine"], f["brief"]) for f in entry.get("feature", [])],
    )


def _check(unit_map):
    known = {e.name for e in unit_map.engines}
    if len({u.tag for u in unit_map.units}) != len(unit_map.units):
        raise UnitError("two units share a tag")
    if len(unit_map.units) >= unit_map.slots:
        raise UnitError("more descriptors than slots, the ending one included")
    for unit in unit_map.units:
        def need(condition, text):
            if not condition:
                raise UnitError(f"{unit.name}: {text}")

        need(0 < unit.tag <= TAG_MAX, "a tag is 1 to 255")
        need(max(unit.major, unit.minor) <= VERSION_MAX, "a version's parts are 0 to 15")
        need(unit.instances in COUNTS or isinstance(unit.instances, int), f"instances {unit.instances}")
        need(bool(unit.first) == bool(unit.last), "first and last register go together")
        need(0 <= unit.stride <= STRIDE_MAX and 0 <= unit.load_unit <= LOAD_UNIT_NONE, "stride or load unit too large")
        for engine in [unit.engine] + [f.engine for f in unit.features]:
            need(not engine or engine in known, f"no engine {engine}")
        need(all(0 <= f.bit < FEATURES for f in unit.features), "a feature is one of 8 bits")


def span(unit, registers):
    """First and last register of an instance as Register objects, or None."""
    if not unit.first:
        return None
    by_name = {r.name: r for r in registers}
    for name in (unit.first, unit.last):
        if name not in by_name:
            raise UnitError(f"{unit.name}: no register {name}")
    return by_name[unit.first], by_name[unit.last]


def last_axis_bound(unit, register) -> Optional[int]:
    """Bytes by which this register moves with each further axis, if it is the slot of the card's last axis; otherwise
    0."""
    return 0 if unit.instances == "Axes" or not register.is_array else register.stride
