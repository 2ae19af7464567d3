"""scripts/registers/window.py must refuse plans of the register window with one error each, and
scripts/generate-registers must report it."""

import dataclasses
import importlib.util
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))

from registers.window import WindowError, read_window  # noqa: E402

PLAN = (ROOT / "rtl/regs/window.toml").read_text()


@dataclasses.dataclass
class Register:
    name: str
    access: str
    addresses: list


class Window(unittest.TestCase):
    def read(self, registers=(), plan=PLAN):
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write(plan)
            file.flush()
            return read_window(file.name, registers)

    def expect_refused(self, text, registers=(), plan=PLAN):
        with self.assertRaisesRegex(WindowError, text):
            self.read(registers, plan)

    def test_the_plan_itself_is_taken(self):
        self.assertEqual(sum(r.words for r in self.read([Register("A", "setting", [0x640, 0x64C])])), 1024)

    def test_gaps_overlaps_and_a_wrong_end(self):
        self.expect_refused("0x100 does not follow on 0x0FC", plan=PLAN.replace("words = 48", "words = 47", 1))
        self.expect_refused("0x100 does not follow on 0x104", plan=PLAN.replace("words = 48", "words = 49", 1))
        self.expect_refused("the window at 0x800", plan=PLAN.replace("words = 1024", "words = 512", 1))

    def test_a_register_across_two_ranges_or_in_a_reserved_one(self):
        self.expect_refused("A: in more than one range", [Register("A", "live", [0x07C, 0x100])])
        self.expect_refused("A: in the range at 0xF80, which is reserved", [Register("A", "setting", [0xF80])])

    def test_a_register_that_would_share_a_word_of_the_ram(self):
        self.expect_refused("A: word 4 of its range at 0x640, where the hardware keeps 4", [Register("A", "setting", [0x650])])
        self.expect_refused("A: word 10 of its range at 0x800", [Register("A", "setting", [0x800, 0x8A8])])
        self.expect_refused("A: word 16 of its range at 0x200", [Register("A", "snapshot", [0x240])])
        self.expect_refused("A: word 16 of its range at 0x040", [Register("A", "live", [0x080])])
        self.read([Register("A", "setting", [0x824, 0x8A4]), Register("B", "command", [0x63C]),
                   Register("C", "live", [0x07C])])

    def test_a_range_that_is_built_without_a_place(self):
        plan = PLAN.replace('encoders, 4 words each"\nreserved = true', 'encoders, 4 words each"')
        self.assertNotEqual(plan, PLAN)
        self.expect_refused("A: word 0 of its range at 0xF80, where the hardware keeps 0", [Register("A", "setting", [0xF80])],
                            plan)


@unittest.skipUnless((ROOT / ".venv/.requirements.txt").exists() or importlib.util.find_spec("systemrdl"),
                     "needs the tools of requirements.txt, which scripts/check installs")
class Message(unittest.TestCase):
    def test_a_refusal_is_one_line_and_nothing_is_written(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for part in ("scripts", "rtl/regs"):
                shutil.copytree(ROOT / part, root / part)
            if (ROOT / ".venv").is_dir():
                (root / ".venv").symlink_to(ROOT / ".venv")
            rdl = root / "rtl/regs/trammel.rdl"
            rdl.write_text(rdl.read_text().replace("INPUT_POLARITY @0x704", "INPUT_POLARITY @0xF80"))
            run = subprocess.run([root / "scripts/generate-registers"], capture_output=True, text=True)
            self.assertEqual(run.returncode, 1)
            self.assertEqual(run.stderr, "rtl/regs: INPUT_POLARITY: in the range at 0xF80, which is reserved until "
                                         "rtl/regs/window.toml gives it to a unit: encoders, 4 words each\n")
            self.assertFalse((root / "docs").exists())


if __name__ == "__main__":
    unittest.main()
