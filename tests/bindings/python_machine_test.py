"""The simulated machine, homing and PWM in the Python package."""
import os
import unittest

import trammel

SECOND = 1_000_000_000
FIRST_MACHINE = os.environ["FIRST_MACHINE"]


def start_x(card, mm):
    """40 mm/s along X of the default world: 80 pulses/mm."""
    card.start_line([round(mm * 80)], duration_ns=round(abs(mm) / 40 * SECOND))


class SimulatedMachine(unittest.TestCase):
    def setUp(self):
        self.card = trammel.simulate_in_world()
        self.world = self.card.world

    def test_what_it_is_like(self):
        state = self.world.state()
        self.assertEqual([axis["axis"] for axis in state["axes"]], ["X", "Y", "Z", "E"])
        self.assertEqual((state["pressed"], state["emergency_stop"]), ([], False))
        self.assertIn({"name": "x_minus", "input": 0, "pressed": False}, state["switches"])
        self.assertIn({"name": "estop", "input": "estop", "pressed": False}, state["buttons"])
        self.assertEqual(self.world.press("feed_hold")["pressed"], ["feed_hold"])
        self.assertEqual(self.world.release("feed_hold")["pressed"], [])

    def test_a_button_in_mid_line(self):
        card, world = self.card, self.world
        card.set_slew_time(SECOND // 10)
        start_x(card, 60)
        with self.assertRaisesRegex(trammel.TimeoutError, "press estop when X > 400"):
            world.press("estop", when="X>400", longest_ns=SECOND // 10)
        state = world.press("estop", when="X > 20")
        self.assertTrue(20 < state["axes"][0]["carriage_mm"] < 21.5 and state["emergency_stop"])
        self.assertRaisesRegex(trammel.FaultError, "EMERGENCY_STOP", card.wait_until_idle, SECOND)
        card.wait_until_stopped()
        card.wait(1_000_000)
        self.assertFalse(world.state()["axes"][0]["powered"])
        self.assertTrue(world.release("estop")["axes"][0]["powered"])
        card.clear_faults()

    def test_bad_arguments(self):
        self.assertRaisesRegex(trammel.ArgumentError, "/nowhere.toml", trammel.simulate_in_world, "/nowhere.toml")
        self.assertRaisesRegex(trammel.ArgumentError, "no such button", self.world.press, "x_minus")
        with self.assertRaisesRegex(trammel.ArgumentError, "longest_ns"):
            self.world.press("estop", longest_ns=0)
        with self.assertRaisesRegex(trammel.StateError, "no machine is simulated"):
            trammel.simulate().world


class Homing(unittest.TestCase):
    def setUp(self):
        self.card = trammel.simulate_in_world()
        self.machine = trammel.Machine(FIRST_MACHINE)

    def test_all_axes(self):
        card, lines = self.card, []
        homed = card.home(self.machine, say=lines.append)
        self.assertEqual([axis.letter for axis in homed], ["X", "Y", "Z"])
        self.assertIn("Z: searches its switch at 30 mm/s, at most 159.5 mm", lines)
        for axis in homed:
            self.assertLess(abs(axis.edge - axis.search_edge), 0.014)
            self.assertEqual(axis.squared_by, 0)
        self.assertEqual(card.read_place().homed[:3], [True] * 3)
        self.assertEqual(card.read_coordinates(self.machine), [0, 0, 0])
        axes = card.world.state()["axes"]
        self.assertAlmostEqual(axes[0]["carriage_mm"], -98, delta=0.1)
        self.assertEqual([axis["lost"] for axis in axes], [0] * 4)

    def test_a_switch_that_does_not_come(self):
        self.machine.change("homing.x.search_distance=20")
        with self.assertRaisesRegex(trammel.HomingError, "X: its home switch at input 0 did not become active within "
                                    "20 mm at 40 mm/s"):
            self.card.home(self.machine, "X")
        self.assertEqual(self.card.read_place().homed, [False] * 4)

    def test_what_the_callback_raises_ends_it(self):
        def say(text):
            raise KeyError(text)
        self.assertRaises(KeyError, self.card.home, self.machine, "X", say)
        self.assertEqual(self.card.read_place().homed, [False] * 4)
        self.assertFalse(self.card.read_status().busy)

    def test_machines(self):
        self.assertEqual(self.machine.letters, "XYZ")
        self.assertEqual(self.machine.pulses_of([1, -2.5]), [80, -200, 0])
        self.assertRaisesRegex(trammel.ArgumentError, "the machine has 3", self.machine.pulses_of, [0] * 4)
        self.assertRaisesRegex(trammel.ArgumentError, "/nowhere.toml", trammel.Machine, "/nowhere.toml")
        self.assertRaisesRegex(trammel.ArgumentError, "steps_per_mm", self.machine.change, "axis.x.steps_per_mm=0")
        self.assertRaisesRegex(trammel.ArgumentError, "no axis Q", self.card.home, self.machine, "Q")
        self.card.set_scales(12345)
        self.assertRaisesRegex(trammel.StateError, "other scales", self.card.read_coordinates, self.machine)


class Pwm(unittest.TestCase):
    def test_a_duty_in_the_stream(self):
        card = trammel.simulate()
        self.assertTrue(card.has_pwm)
        card.set_pwm([trammel.PwmChannel(trammel.pwm_period(1000, 1_000_000), outputs=1), trammel.PwmChannel(200)])
        self.assertEqual([(one.period, one.outputs) for one in card.read_pwm()], [(1000, 1), (200, 0)])
        stream = trammel.Stream(card)
        stream.send([trammel.feed(1000, 1 << 60), trammel.line(1000, [100]), trammel.pwm(0, 0x4000), trammel.end()])
        stream.finish()
        words = trammel.pwm(1, 0x1234).words()
        self.assertTrue(any(0x1234 in (word & 0xFFFF, word >> 16) for word in words), words)

    def test_bad_arguments(self):
        card = trammel.simulate()
        follows = trammel.pwm_for_speed(1, 30_000, 0.0625, 40_000).words()
        self.assertNotEqual(follows, trammel.pwm_for_speed(1, 30_000, 0.0625).words())
        for call in (lambda: trammel.pwm_for_speed(1, 30_000, 1.5), lambda: trammel.pwm_period(0.5, 1_000_000),
                     lambda: card.set_pwm([trammel.PwmChannel()]),
                     lambda: card.set_pwm([trammel.PwmChannel(99), trammel.PwmChannel()]),
                     lambda: trammel.pwm(2, 5).words()):
            self.assertRaises(trammel.ArgumentError, call)


if __name__ == "__main__":
    unittest.main()
