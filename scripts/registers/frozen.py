"""Positions that drivers rely on, as text: rtl/regs/frozen.txt has them for the present versions."""

import re

from . import command_map as cm

ENGINE = re.compile(r" engine (\d+):")

HEAD = """# Positions of the register map and of the command layouts, one line each. scripts/generate-registers refuses a
# description that differs from this file without a new version; a new version is written here with --freeze.
"""


def frozen_text(register_map, commands, units, window):
    lines = [HEAD, f"map 0x{register_map.version:08X}\n"]
    for r in register_map.registers:
        array = f" x{r.count} {r.stride:+#x}" if r.is_array else ""
        engine = f" engine {units.engine_bit(r.engine)}" if r.engine else ""
        fields = " ".join(f"{f.name}[{f.low + f.width - 1}:{f.low}]" for f in r.fields)
        lines.append(f"  0x{r.address:03X} {r.name}{array} {r.access}{engine}: {fields}\n")
    lines += [f"  reason {r.value} {r.name}\n" for r in register_map.reasons]
    lines += [_unit(u) for u in units.units]
    lines += [f"  reserved 0x{r.first:03X} to 0x{r.last:03X}: {r.content}\n" for r in window if r.reserved]
    lines.append(f"commands {commands.version}\n")
    for c in commands.commands:
        engine = f" engine {units.engine_bit(c.engine)}" if c.engine else ""
        fields = " ".join(_field(f) for f in c.fields)
        lines.append(f"  {c.opcode} {c.name} to {'+'.join(c.queues)} mask {c.mask}{engine}: {fields}\n")
    return "".join(lines)


def _unit(unit):
    registers = f" {unit.first}..{unit.last} stride {unit.stride}" if unit.first else ""
    features = "".join(f" {f.bit}={f.engine}" for f in unit.features)
    engine = f" engine {unit.engine}" if unit.engine else ""
    return (f"  unit {unit.tag} {unit.name} {unit.major} x{unit.instances}{registers} load {unit.load_unit}{engine}:"
            f"{features}\n")


def _field(field):
    each = "*" if field.per_axis else ""
    first = cm.HEADER_HALFWORDS + cm.COUNT_HALFWORDS + field.offset
    return f"{field.name}@{first}+{field.halfwords}{each}({field.kind} {field.bits})"


def moved(frozen, text):
    """Lines that differ between the committed text and the description for the same version."""
    differences = []
    old, new = _sections(frozen), _sections(text)
    for version, lines in new.items():
        if version not in old:
            differences.append(f"{version} is not in the file: write it with --freeze")
        elif _only_new_engines(version, old[version], lines):
            differences.append(f"{version}: commands of a new engine: write them with --freeze")
        elif old[version] != lines:
            differences += [f"{version}: -{line}" for line in old[version] if line not in lines]
            differences += [f"{version}: +{line}" for line in lines if line not in old[version]]
            if not differences:
                differences.append(f"{version}: in another order")
    return differences


def _only_new_engines(version, old, new):
    """Whether the only difference is added commands, each of an engine that had no command before. An old driver does
    not know these commands, and none of the units that it drives needs them."""
    added = [line for line in new if line not in old]
    known = set(ENGINE.findall("\n".join(old)))
    return (version.startswith("commands ") and bool(added) and new[:len(old)] == old
            and all(not known.issuperset(ENGINE.findall(line) or known) for line in added))


def _sections(text):
    sections, lines = {}, []
    for line in text.splitlines():
        if line.startswith("#"):
            continue
        if line.startswith(" "):
            lines.append(line)
        else:
            lines = sections.setdefault(line, [])
    return sections
