"""The register map as plain data, elaborated from SystemRDL."""

from dataclasses import dataclass, field
from typing import List, Optional

from systemrdl import RDLCompiler
from systemrdl.node import RegNode
from systemrdl.rdltypes import AccessType, OnWriteType

from .errors import DescriptionError

WORD = 0xFFFFFFFF


class MapError(DescriptionError):
    """The description has something that the generated files cannot express."""


@dataclass
class Field:
    name: str
    low: int
    width: int
    reset: int
    unit: str
    brief: str
    minimum: Optional[int]
    maximum: Optional[int]
    engine: str  # engine (units.toml) that gives the bits their meaning; empty: every card

    @property
    def mask(self):
        return ((1 << self.width) - 1) << self.low


@dataclass
class Register:
    name: str
    address: int  # byte address; in an array, of axis 0's slot
    access: str  # constant, live, snapshot, clear_ones, setting or command
    brief: str
    source: str  # source of a constant's value; empty: the map itself
    count: int
    stride: int  # bytes from one axis to the next; negative for an array with descending addresses
    only_present_axes: bool
    engine: str  # engine that the register needs; empty: every card has it
    area: str  # area of latched values that the register belongs to, or empty
    group_brief: str  # description of its area or array of groups, or empty
    fields: List[Field] = field(default_factory=list)

    @property
    def mask(self):
        return sum(f.mask for f in self.fields)

    @property
    def reset(self):
        return sum(f.reset << f.low for f in self.fields)

    @property
    def optional(self):
        """Bits that need another engine than the register itself, and that engine."""
        fields = [f for f in self.fields if f.engine]
        if len({f.engine for f in fields}) > 1:
            raise MapError(f"{self.name}: fields need more than one engine")
        return (sum(f.mask for f in fields), fields[0].engine) if fields else (0, "")

    @property
    def addresses(self):
        return [self.address + i * self.stride for i in range(self.count)]

    @property
    def is_array(self):
        return self.count > 1

    @property
    def limited(self):
        """The field with a minimum or maximum, or None."""
        limited = [f for f in self.fields if f.minimum is not None or f.maximum is not None]
        if len(limited) > 1:
            raise MapError(f"{self.name}: limits on more than one field")
        return limited[0] if limited else None


@dataclass
class Reason:
    name: str
    value: int
    brief: str


@dataclass
class RegisterMap:
    registers: List[Register]
    reasons: List[Reason]

    @property
    def version(self):
        return next(r for r in self.registers if r.name == "MAP_VERSION").reset

    def areas(self):
        """Areas of latched values: name -> registers. All areas except REST have the layout of the first one."""
        areas = {}
        for r in self.registers:
            if r.area:
                areas.setdefault(r.area, []).append(r)
        return areas


def read_register_map(path, engines):
    """`engines`: names that registers and fields may refer to."""
    compiler = RDLCompiler()
    compiler.compile_file(str(path))
    top = compiler.elaborate().top
    registers = [_register(node) for node in top.descendants(unroll=False) if isinstance(node, RegNode)]
    registers.sort(key=lambda r: min(r.addresses))
    known = set(engines) | {""}
    for r in registers:
        for engine in [r.engine] + [f.engine for f in r.fields]:
            if engine not in known:
                raise MapError(f"{r.name}: no engine {engine}")
    return RegisterMap(registers, _reasons(top))


def _register(node):
    file = node.parent if node.parent.inst_name != node.owning_addrmap.inst_name else None
    array = file if file is not None and file.is_array else node
    area = file.inst_name if file is not None and not file.is_array else ""
    base = node.raw_address_offset + (file.raw_address_offset if file is not None else 0)
    count = array.array_dimensions[0] if array.is_array else 1
    stride = array.array_stride if array.is_array else 0
    if file is not None and file.get_property("downwards"):
        base, stride = base + (count - 1) * stride, -stride
    return Register(
        name=f"{area}_{node.inst_name}" if area else node.inst_name,
        address=base,
        access=_access(node),
        brief=node.get_property("desc"),
        source=node.get_property("source") or "",
        count=count,
        stride=stride,
        only_present_axes=bool(array.get_property("only_present_axes")),
        engine=node.get_property("engine") or (file is not None and file.get_property("engine")) or "",
        area=area,
        group_brief=(file is not None and file.get_property("desc")) or "",
        fields=[_field(f) for f in node.fields()],
    )


def _field(node):
    return Field(
        name=node.inst_name,
        low=node.low,
        width=node.width,
        reset=node.get_property("reset") or 0,
        unit=node.get_property("unit") or "",
        brief=node.get_property("desc") or "",
        minimum=node.get_property("minimum"),
        maximum=node.get_property("maximum"),
        engine=node.get_property("engine") or "",
    )


def _access(node):
    kinds = {_field_access(f) for f in node.fields()}
    if len(kinds) != 1:
        raise MapError(f"{node.inst_name}: fields of different access {sorted(kinds)}")
    return "snapshot" if node.get_property("snapshot") else kinds.pop()


def _field_access(node):
    software = node.get_property("sw")
    if node.get_property("onwrite") == OnWriteType.woclr:
        return "clear_ones"
    if software == AccessType.r:
        return "live" if node.is_hw_writable else "constant"
    if software == AccessType.w:
        return "command"
    if software == AccessType.rw:
        return "setting"
    raise MapError(f"{node.get_path()}: access {software} has no output")


def _reasons(top):
    for node in top.descendants(unroll=False):
        encode = node.get_property("encode") if hasattr(node, "is_hw_writable") else None
        if encode is not None:
            return [Reason(m.name, int(m.value), m.rdl_desc or "") for m in encode]
    raise MapError("no field encodes the refusal reasons")
