"""The register map as plain data, elaborated from SystemRDL."""

from dataclasses import dataclass, field
from typing import List, Optional

from systemrdl import RDLCompiler
from systemrdl.node import RegNode
from systemrdl.rdltypes import AccessType, OnWriteType

WORD = 0xFFFFFFFF


class MapError(Exception):
    """The description says something that the outputs cannot express."""


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

    @property
    def mask(self):
        return ((1 << self.width) - 1) << self.low


@dataclass
class Register:
    name: str
    address: int
    access: str  # constant, live, snapshot, clear_ones, setting or command
    brief: str
    source: str  # what gives a constant its value; empty: the map itself
    count: int
    stride: int
    only_present_axes: bool
    always_needed: bool
    single_pulse: bool
    fields: List[Field] = field(default_factory=list)

    @property
    def mask(self):
        return sum(f.mask for f in self.fields)

    @property
    def reset(self):
        return sum(f.reset << f.low for f in self.fields)

    @property
    def is_array(self):
        return self.count > 1

    @property
    def limited(self):
        """The field with limits of its own, or None."""
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


def read_register_map(path):
    compiler = RDLCompiler()
    compiler.compile_file(str(path))
    top = compiler.elaborate().top
    registers = [_register(node) for node in top.descendants(unroll=False) if isinstance(node, RegNode)]
    registers.sort(key=lambda r: r.address)
    return RegisterMap(registers, _reasons(top))


def _register(node):
    in_file = node.parent.inst_name != node.owning_addrmap.inst_name
    array = node.parent if in_file else node
    register = Register(
        name=node.inst_name,
        address=node.raw_address_offset + (node.parent.raw_address_offset if in_file else 0),
        access=_access(node),
        brief=node.get_property("desc"),
        source=node.get_property("source") or "",
        count=array.array_dimensions[0] if array.is_array else 1,
        stride=array.array_stride if array.is_array else 0,
        only_present_axes=bool(array.get_property("only_present_axes")),
        always_needed=bool(node.get_property("always_needed")),
        single_pulse=any(f.get_property("singlepulse") for f in node.fields()),
        fields=[_field(f) for f in node.fields()],
    )
    return register


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
