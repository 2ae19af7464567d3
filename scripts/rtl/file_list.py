"""The list of RTL sources, rtl/trammel.f: one path a line, relative to rtl/, the package first."""
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
RTL = ROOT / "rtl"
LIST = RTL / "trammel.f"
CORE = RTL / "trammel.core"

# The FuseSoC core file repeats the list here, because FuseSoC reads no other file.
CORE_BEGIN = "      # from trammel.f\n"
CORE_END = "      # end of trammel.f\n"


def listed():
    """The paths of the list, relative to rtl/, in its order."""
    lines = (line.strip() for line in LIST.read_text().splitlines())
    return [line for line in lines if line and not line.startswith("//")]


def sources():
    """The same, relative to the project's root."""
    return [f"rtl/{path}" for path in listed()]


def present():
    """Every SystemVerilog file below rtl/, without those for lint; packages come first, because some readers need them
    first."""
    paths = [f.relative_to(RTL) for f in RTL.rglob("*.sv") if f.relative_to(RTL).parts[0] != "lint"]
    return [str(p) for p in sorted(paths, key=lambda p: (not p.stem.endswith("_pkg"), p))]


def list_text(paths):
    """The text of rtl/trammel.f for these paths."""
    comment = [line for line in LIST.read_text().splitlines() if line.startswith("//")]
    return "\n".join(comment + paths) + "\n"


def core_text(paths):
    """The text of rtl/trammel.core with these paths."""
    text = CORE.read_text()
    begin, end = text.index(CORE_BEGIN) + len(CORE_BEGIN), text.index(CORE_END)
    return text[:begin] + "".join(f"      - {path}\n" for path in paths) + text[end:]
