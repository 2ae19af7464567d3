"""The table of sizes and speeds in README.md, from the same data as the page."""
import tomllib

from evidence_page.gather import EVIDENCE, ROOT, sizes

README = ROOT / "README.md"
HEAD = "| size and speed | | measured by |\n|---|---|---|\n"


class ReadmeError(Exception):
    """A row without data, or a README without the table; the text says what to do."""


def of_build(row: dict, builds: dict) -> str:
    if row["build"] not in builds:
        raise ReadmeError(f"verif/evidence/readme.toml: boards/results has no build {row['build']}")
    build = builds[row["build"]]
    needed = f" ({row['needed_mhz']} needed)" if "needed_mhz" in row else ""
    seeds = len(build["fmax_mhz"])
    return (f"| {row['what']} | {build['area']} {build['unit']}, {build['memory']} block RAMs, {build['median_fmax_mhz']:g} MHz{needed} | "
            f"{row['by']}, median of {seeds} seeds, RTL of {build['rtl'] or 'before commits were recorded'} |\n")


def table() -> str:
    builds = {row["build"]: row for row in sizes()}
    rows = tomllib.loads((EVIDENCE / "readme.toml").read_text())["row"]
    return HEAD + "".join(of_build(row, builds) if "build" in row else f"| {row['what']} | {row['figure']} | {row['by']} |\n" for row in rows)


def with_table(text: str) -> str:
    """Replaces the table in the README's text, from its head to the empty line after it, by the current one."""
    begin = text.find(HEAD)
    end = text.find("\n\n", begin)
    if begin < 0 or end < 0:
        raise ReadmeError("README.md: the table of sizes and speeds is not there")
    return text[:begin] + table().rstrip("\n") + text[end:]
