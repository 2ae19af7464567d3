"""Captures, soft limits, drives and the emergency stop in the Python package."""
import unittest

import trammel
from trammel import Fault, SoftRange

SECOND = 1_000_000_000


def start_line(card, pulses):
    """1000 pulses/s along axis 0."""
    card.start_line([pulses], duration_ns=abs(pulses) * 1_000_000)


class Captures(unittest.TestCase):
    TOUCH = 3  # the input, with a filter of 640 clocks

    def setUp(self):
        self.card = trammel.simulate()
        self.card.set_input_filter(self.TOUCH, 640_000)
        self.card.wait(3000)

    def set(self, level, clocks):
        self.card.set_input(self.TOUCH, level)
        self.card.wait(clocks)

    def test_an_edge_in_motion(self):
        card = self.card
        self.assertEqual(card.captures_present, 4)
        card.select_capture(2, self.TOUCH)
        self.assertIsNone(card.take_capture(2))
        start_line(card, 100)
        card.wait(41_100)
        before = card.read_snapshot()
        self.set(True, 20)
        self.set(False, 30)  # a bounce
        self.set(True, 100)
        self.assertTrue(card.read_captures().units[2].pending)
        card.wait(2000)
        states = card.read_captures()
        self.assertEqual([unit.valid for unit in states.units], [False, False, True, False])
        self.assertEqual((states.units[2].pending, states.units[2].active, states.snapshots), (False, True, 1))
        capture = card.take_capture(2)
        self.assertEqual((capture.active, capture.overrun), (True, False))
        self.assertTrue(before.time <= capture.at.time < before.time + 200)
        self.assertEqual(capture.at.position, before.position)
        self.assertGreater(before.position[0], 30)
        self.assertIsNone(card.take_capture(2))

    def test_waiting_for_edges(self):
        card = self.card
        card.select_capture(0, self.TOUCH, to_inactive=True, continuous=True)
        self.assertRaises(trammel.TimeoutError, card.wait_for_capture, 0, 10_000_000)
        self.set(True, 2000)
        self.set(False, 2000)
        self.assertTrue(card.read_captures().units[0].overrun)
        first = card.wait_for_capture(0, 10_000_000)
        self.assertEqual((first.active, first.overrun), (True, True))
        self.set(True, 2000)
        second = card.wait_for_capture(0, 10_000_000)
        self.assertEqual((second.active, second.overrun), (True, False))
        self.assertGreater(second.at.time, first.at.time + 3900)
        card.stop_capture(0)
        self.set(False, 2000)
        self.assertFalse(card.read_captures().units[0].valid)

    def test_a_queue_of_edges(self):
        card = self.card
        self.assertTrue(card.has_capture_queue)
        card.select_capture(3, self.TOUCH, to_inactive=True, continuous=True, queue=True)
        for n in range(18):
            self.set(n % 2 == 0, 2000)
        queue = card.read_capture_queue()
        self.assertEqual((queue.captures, queue.lost), (16, 2))
        self.assertTrue(card.read_captures().units[3].overrun)
        card.clear_captures(1 << 3)
        self.assertFalse(card.read_captures().units[3].overrun)
        captures = card.take_queued_captures()
        self.assertEqual([(c.unit, c.active) for c in captures], [(3, n % 2 == 0) for n in range(16)])
        times = [c.at.time for c in captures]
        self.assertTrue(all(after > before + 1900 for before, after in zip(times, times[1:])))
        self.assertEqual(card.take_queued_captures(), [])

    def test_bad_arguments(self):
        card = self.card
        for call in (lambda: card.select_capture(4, 0), lambda: card.select_capture(0, 16),
                     lambda: card.stop_capture(4), lambda: card.take_capture(4),
                     lambda: card.wait_for_capture(0, -1)):
            self.assertRaises(trammel.ArgumentError, call)


class SoftLimits(unittest.TestCase):
    def test_set_read_and_switched_off(self):
        card = trammel.simulate()
        self.assertTrue(card.has_soft_limits)
        card.set_slew_time(10_000_000)
        card.set_soft_limits([SoftRange(-50, 500), None, SoftRange(2**31 - 1, -2**31)])
        ranges = card.read_soft_limits()
        self.assertEqual([ranges[1], ranges[3], len(ranges)], [None, None, 4])
        self.assertEqual((ranges[0].minus, ranges[0].plus), (-50, 500))
        self.assertEqual((ranges[2].minus, ranges[2].plus), (2**31 - 1, -2**31))
        start_line(card, 600)
        with self.assertRaisesRegex(trammel.FaultError, r"SOFT_LIMIT \(axis 0 plus\)") as caught:
            card.wait_until_idle(SECOND)
        self.assertEqual(caught.exception.faults, Fault.SOFT_LIMIT)
        limits = card.read_limit_state()
        self.assertEqual((limits.soft_axis, limits.soft_plus), (0, True))
        card.clear_faults()
        card.set_soft_limits([])
        self.assertEqual(card.read_soft_limits(), [None] * 4)
        card.run_line([100], duration_ns=100_000_000)

    def test_reaction(self):
        beyond = {}
        for ramp in (False, True):
            card = trammel.simulate()
            card.set_slew_time(100_000_000)
            card.set_soft_limits([SoftRange(0, 100)])
            card.set_soft_limit_ramps(ramp)
            start_line(card, 600)
            self.assertRaises(trammel.FaultError, card.wait_until_idle, SECOND)
            card.wait_until_stopped()
            beyond[ramp] = card.read_rest().position[0] - 100
        self.assertLessEqual(beyond[False], 2)
        self.assertGreater(beyond[True], 40)

    def test_bad_arguments(self):
        card = trammel.simulate()
        self.assertRaisesRegex(trammel.ArgumentError, "3 to 2 is no range", card.set_soft_limits, [SoftRange(3, 2)])
        self.assertRaisesRegex(trammel.ArgumentError, "the card has 4", card.set_soft_limits, [None] * 5)


class Drives(unittest.TestCase):
    # The card rounds up to multiples of 4,096 clocks, and idle_ns to 2^20 clocks of 1 us.
    TIMES = {"brake_release_ns": 4_096_000, "before_first_step_ns": 8_192_000, "after_last_step_ns": 12_288_000,
             "brake_set_ns": 16_384_000, "idle_ns": 1}

    def state(self, card):
        status = card.read_status()
        return status.enabled, status.enable_waits, card.read_outputs()

    def test_motion_waits_for_the_sequence(self):
        card = trammel.simulate()
        card.set_output_roles(enable=1, brake=2)
        card.set_enable_sequence(range(4), disable_causes=Fault.LIMIT | Fault.WATCHDOG, **self.TIMES)
        self.assertEqual(self.state(card), (False, False, 0))
        start_line(card, 20)
        card.wait(2000)
        self.assertEqual(self.state(card), (True, True, 1))
        card.wait(4096)
        self.assertEqual(self.state(card), (True, True, 3))
        card.wait(4096)
        self.assertEqual(self.state(card), (True, True, 3))
        card.wait(4096)
        self.assertEqual(self.state(card), (True, False, 3))
        card.wait_until_idle(SECOND)
        card.wait(1 << 20)  # the 12,288 clocks of after_last_step_ns have begun
        self.assertEqual(self.state(card), (True, False, 3))
        card.wait(12_288)
        self.assertEqual(self.state(card), (True, False, 1))
        card.wait(16_384)
        self.assertEqual(self.state(card), (False, False, 0))

    def test_by_hand(self):
        card = trammel.simulate()
        card.set_enable_sequence([0], manual=True, **self.TIMES)
        start_line(card, 20)
        card.wait(100_000)
        self.assertEqual(self.state(card)[:2], (False, True))
        card.enable()
        card.wait_until_idle(SECOND)
        self.assertEqual(self.state(card)[:2], (True, False))
        card.enable(False)
        card.wait(40_000)
        self.assertEqual(self.state(card)[:2], (False, False))

    def test_health_and_safe_levels(self):
        card = trammel.simulate()
        card.set_output_roles(charge_pump=4, healthy=8)
        card.set_health(causes=Fault.EMERGENCY_STOP, pump_half_period_ns=500_000)
        card.set_output_safe_cause(1, 3)
        card.wait(1000)
        before = card.read_outputs()
        self.assertEqual(before & 8, 8)
        card.wait(500)
        self.assertNotEqual(card.read_outputs() & 4, before & 4)
        card.set_emergency_stop(True)
        card.wait(1000)
        self.assertEqual(card.read_outputs(), 1)

    def test_bad_arguments(self):
        card = trammel.simulate()
        for call in (lambda: card.set_output_roles(enable=16), lambda: card.set_output_roles(enable=1, brake=1),
                     lambda: card.set_enable_sequence([4]),
                     lambda: card.set_enable_sequence([0], idle_ns=10**6 * SECOND),
                     lambda: card.set_health(pump_half_period_ns=65_536_000)):
            self.assertRaises(trammel.ArgumentError, call)


class EmergencyStop(unittest.TestCase):
    def pressed_at_100(self, ramp):
        """The position at which a line of 600 pulses comes to rest after a press at pulse 100."""
        card = trammel.simulate()
        self.assertTrue(card.has_emergency_stop)
        self.assertFalse(card.read_emergency_stop())
        card.set_slew_time(100_000_000)
        card.set_emergency_stop_ramps(ramp)
        start_line(card, 600)
        card.wait(100_000)
        card.set_emergency_stop(True)
        self.assertRaisesRegex(trammel.FaultError, "EMERGENCY_STOP", card.wait_until_idle, SECOND)
        card.wait_until_stopped()
        rest = card.read_rest()
        card.clear_faults()
        self.assertTrue(card.read_emergency_stop())  # as long as it is pressed
        card.set_emergency_stop(False)
        card.wait(100)
        self.assertTrue(card.read_emergency_stop())
        card.clear_faults()
        self.assertFalse(card.read_emergency_stop())
        card.run_line([10], duration_ns=10_000_000)
        return rest.position[0]

    def test_at_once_and_on_a_ramp(self):
        self.assertLess(self.pressed_at_100(False), 103)
        self.assertGreater(self.pressed_at_100(True), 140)


if __name__ == "__main__":
    unittest.main()
