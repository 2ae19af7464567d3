"""The plan of the register window as plain data, read from TOML and checked against the registers."""

import tomllib
from dataclasses import dataclass

from .errors import DescriptionError


class WindowError(DescriptionError):
    """Ranges with a gap or an overlap, or a register that is in a reserved range, in two ranges, or in a word that the
    card does not store."""


@dataclass
class Range:
    first: int  # byte address
    words: int
    content: str
    reserved: bool
    kept: int  # words at the start of each `repeat` words that the hardware stores; the others alias these
    repeat: int

    @property
    def last(self):
        """Byte address of the last byte."""
        return self.first + 4 * self.words - 1


def read_window(path, registers):
    with open(path, "rb") as file:
        data = tomllib.load(file)
    ranges = [Range(r["first"], r["words"], r["content"], r.get("reserved", False), r.get("kept", 0),
                    r.get("repeat", r["words"])) for r in data["range"]]
    _check_tiling(ranges, 4 * data["words"])
    for register in registers:
        _check_register(register, ranges)
    return ranges


def _check_tiling(ranges, size):
    end = 0
    for r in ranges:
        if r.first != end:
            raise WindowError(f"the range at 0x{r.first:03X} does not follow on 0x{end:03X}")
        end = r.last + 1
    if end != size:
        raise WindowError(f"the ranges end at 0x{end:03X}, the window at 0x{size:03X}")


def _check_register(register, ranges):
    places = {next(i for i, r in enumerate(ranges) if address <= r.last) for address in register.addresses}
    if len(places) != 1:
        raise WindowError(f"{register.name}: in more than one range of the window")
    place = ranges[places.pop()]
    if place.reserved:
        raise WindowError(f"{register.name}: in the range at 0x{place.first:03X}, which is reserved until "
                          f"rtl/regs/window.toml gives it to a unit: {place.content}")
    word = max((address - place.first) // 4 % place.repeat for address in register.addresses)
    # A write to a command register has an effect, but is not stored.
    if register.access != "command" and word >= place.kept:
        raise WindowError(f"{register.name}: word {word} of its range at 0x{place.first:03X}, where the hardware keeps "
                          f"{place.kept} apart (rtl/registers/register_fold_pkg.sv, register_live.sv): it would share a "
                          "place with another register")
