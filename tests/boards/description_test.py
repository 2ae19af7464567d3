#!/usr/bin/env python3
"""Descriptions of boards: suggested roles, and variants with another device. Each error must be named."""
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

PROJECT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(PROJECT / "scripts"))
from board_tools import description, write  # noqa: E402

ULX3S = (PROJECT / "boards" / "ulx3s" / "board.toml").read_text()


def with_description(text, what):
    """The board that the description gives, or the message with which the program exits."""
    (PROJECT / "build").mkdir(exist_ok=True)  # messages name files from the project's folder
    with tempfile.TemporaryDirectory(dir=PROJECT / "build") as folder:
        board = Path(folder) / "tried"
        board.mkdir()
        (board / "board.toml").write_text(text)
        with mock.patch.object(description, "BOARDS", Path(folder)):
            try:
                return what(description.load("tried"))
            except SystemExit as end:
                return str(end)


def changed(old, new):
    assert old in ULX3S, old
    return ULX3S.replace(old, new, 1)


class Roles(unittest.TestCase):
    def test_stand_beside_their_pins(self):
        pins = {pin.signal: pin for pin in description.load("ulx3s").pins}
        self.assertEqual(pins["input_i[0]"].roles, ("x_limit_minus", "x_home"))
        self.assertEqual(pins["output_o[2]"].roles, ("enable",))
        self.assertEqual(pins["input_i[15]"].roles, ())
        self.assertEqual(write.note_of(pins["input_i[5]"]), "pull-up; `z_limit_plus`, `z_home`")
        self.assertEqual(write.note_of(pins["emergency_stop_i"]), "pull-up; high is stop")

    def test_are_a_machine_files(self):
        text = write.machine_file_text(description.load("ulx3s"))
        self.assertIn("[inputs]\nx_limit_minus = 0\nx_home = 0\nx_limit_plus = 1\n", text)
        self.assertIn("\n[outputs]\nm3 = 0\nm8 = 1\nenable = 2\n", text)
        self.assertTrue(text.split("[probe]\n")[1].startswith("input = 9\n"))
        self.assertNotIn("probe = ", text)

    def test_that_a_machine_file_would_refuse(self):
        for old, new, said in (
                ('"feed_hold"', '"feet_hold"', "roles: input: feet_hold is unknown, or named twice"),
                ('"cycle_start"', '"feed_hold"', "roles: input: feed_hold is unknown, or named twice"),
                ('"m8", "enable"', '"m8", "x_home"', "roles: output: x_home is unknown, or named twice"),
                ('output = ["m3"', 'outputs = ["m3"', "roles: only input and output have any"),
                ('"m3", "m8"', '"m3", "", "", "", "", "m8"', "roles: 10 of output, the board has 8"),
                ("Captures = 4\nCaptureFifo = 1", "Captures = 0", "roles: input: a card without Captures cannot home")):
            self.assertIn(said, with_description(changed(old, new), lambda board: "no error"), new)


class Variants(unittest.TestCase):
    def test_share_the_board_but_for_the_device(self):
        board = description.load("ulx3s")
        small, large = description.variants(board)
        self.assertEqual((small.name, small.device, large.name, large.device), ("ulx3s-12f", "12k", "ulx3s-85f", "85k"))
        self.assertEqual((small.top, small.folder, small.pins), (board.top, board.folder, board.pins))
        self.assertEqual(write.constraints_file(small), write.constraints_file(board))
        self.assertIn("described and **not built**:\n- ULX3S 12F: `scripts/boards ulx3s-12f`, device `12k`\n", write.table_text(board))
        self.assertEqual(description.variants(description.load("hx8k")), [])

    def test_that_are_wrong(self):
        for old, new, said in (('device = "12k"', 'device = "13k"', "device '13k' is unknown, or the board's own"),
                               ('device = "12k"', 'device = "25k"', "device '25k' is unknown, or the board's own"),
                               ('device = "12k"', "", "variant.12f: needs title and device"),
                               ('device = "25k"', 'device = "26k"', "device '26k': only 12k, 25k, 45k, 85k")):
            self.assertIn(said, with_description(changed(old, new), lambda board: str(description.variants(board))), new)


if __name__ == "__main__":
    unittest.main()
