"""All generated files: path from the repository's root -> text."""

import shutil
import subprocess

from .command_map import read_command_map, read_constants
from .frozen import frozen_text
from .register_map import read_register_map
from .unit_map import read_unit_map
from .window import read_window
from .write_cpp import header_text
from .write_docs import commands_text, registers_text
from .write_sv import package_text


FROZEN = "rtl/regs/frozen.txt"


class Descriptions:
    def __init__(self, root):
        self.units = read_unit_map(root / "rtl/regs/units.toml")
        self.registers = read_register_map(root / "rtl/regs/trammel.rdl", [e.name for e in self.units.engines])
        self.window = read_window(root / "rtl/regs/window.toml", self.registers.registers)
        self.commands = read_command_map(root / "rtl/regs/commands.toml")
        self.constants = read_constants(root / "rtl/regs/constants.toml")

    def positions(self):
        return frozen_text(self.registers, self.commands, self.units, self.window)


def generate(root, descriptions):
    registers, units = descriptions.registers, descriptions.units
    commands, constants = descriptions.commands, descriptions.constants
    header = "rtl/regs/generated/include/trammel/card_map.hpp"
    return {
        "rtl/regs/generated/card_map_pkg.sv": package_text(registers, commands, constants, units),
        header: formatted(root, header, header_text(registers, commands, constants, units)),
        "docs/reference/registers.md": registers_text(registers, commands, units, descriptions.window),
        "docs/reference/commands.md": commands_text(commands, constants),
    }


def formatted(root, path, text):
    tool = shutil.which("clang-format")
    if tool is None:
        raise FileNotFoundError("clang-format is needed to write the C++ header")
    command = [tool, "--style=file", f"--assume-filename={root / path}"]
    return subprocess.run(command, input=text, capture_output=True, text=True, check=True).stdout
