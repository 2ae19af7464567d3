"""The machine behind a served card, used from Python in parallel with the program that moves the card.

Usage: python_world_test.py TRAMMEL, where TRAMMEL is the command."""
import re
import subprocess
import sys
import unittest

import trammel

COMMAND = sys.argv.pop(1)
EMERGENCY_STOP = int(trammel.Fault.EMERGENCY_STOP)
PULSES_PER_MM = 80  # of X in the default world


class AtTheMachine(unittest.TestCase):
    def setUp(self):
        self.server = subprocess.Popen(
            [COMMAND, "serve", "--engine", "model", "--world", "default", "--token", "secret", "--port", "0"],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        lines = [self.server.stdout.readline() for _ in range(3)]
        self.url = re.search(r"tcp://[^?']+", lines[0]).group().strip()
        self.world = trammel.open_world(self.url + "?token=secret")

    def tearDown(self):
        self.server.terminate()
        self.server.wait(10)
        self.server.stdout.close()

    def test_what_the_machine_is_like(self):
        state = self.world.state()
        self.assertEqual([axis["axis"] for axis in state["axes"]], ["X", "Y", "Z", "E"])
        self.assertEqual(state["pressed"], [])
        with trammel.open(self.url + "?token=secret") as card:
            card.run_line([2 * PULSES_PER_MM], duration_ns=100_000_000)
        axis = self.world.state()["axes"][0]
        self.assertEqual((axis["commanded_mm"], axis["lost"]), (2, 0))
        self.assertAlmostEqual(axis["carriage_mm"], 2, delta=0.05)

    def test_a_button_that_stops_the_card(self):
        with trammel.open(self.url + "?token=secret") as card:
            self.assertEqual(self.world.press("estop")["pressed"], ["estop"])
            self.assertTrue(card.read_faults() & EMERGENCY_STOP)
            with self.assertRaises(trammel.FaultError):
                card.run_line([PULSES_PER_MM], duration_ns=100_000_000)
            self.assertEqual(self.world.release("estop")["pressed"], [])
            card.clear_faults()
            self.assertEqual(card.read_faults(), 0)

    def test_the_path_is_counted(self):
        with trammel.open(self.url + "?token=secret") as card:
            self.assertEqual(self.world.count()["path"]["steps"], 0)
            stream = trammel.Stream(card)
            stream.send([trammel.feed(1000, 1 << 56), trammel.line(1000, [300]), trammel.end()])
            stream.finish()
        self.assertEqual(self.world.state()["path"]["steps"], 300)

    def test_what_is_wrong_is_said(self):
        with self.assertRaisesRegex(trammel.Error, "estop"):
            self.world.press("stop")
        with self.assertRaisesRegex(trammel.Error, "token"):
            trammel.open_world(self.url).press("estop")
        with self.assertRaisesRegex(trammel.Error, "serve"):
            trammel.open_world("sim:")
        # Nothing moves the card, so the condition never becomes true.
        with self.assertRaises(trammel.LinkError):
            self.world.press("estop", when="X > 40", longest_ns=100_000_000)


if __name__ == "__main__":
    unittest.main()
