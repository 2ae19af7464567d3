"""Inputs in the Python package: filters, roles, stops by inputs, and the state of the card after a stop."""
import unittest

import trammel

SECOND = 1_000_000_000
TICK_EVERY_16 = 1 << 60


class Inputs(unittest.TestCase):
    X_PLUS, HOLD, START = 3, 5, 6  # inputs

    def set(self, card, number, level):
        card.set_input(number, level)
        card.wait(200)

    def test_levels_and_filters(self):
        card = trammel.simulate()
        self.assertEqual((card.inputs_present, card.outputs_present), (16, 4))
        card.set_input_filter(15, 100_000)
        self.assertEqual(card.read_input_filter(15), 128_000)
        card.set_input_polarity(2)
        card.set_inputs(0x8003)
        card.wait(100)
        self.assertEqual((card.read_raw_inputs(), card.read_inputs()), (0x8001, 1))
        card.wait(200)
        self.assertEqual(card.read_inputs(), 0x8001)
        card.set_output_safe(2, 2)
        card.abort()
        self.assertEqual(card.read_outputs(), 2)

    def test_roles_and_buttons(self):
        card = trammel.simulate()
        limit = trammel.Role(trammel.AxisRole.LIMIT_MINUS, 1)
        card.set_role(limit, 0x14)
        card.set_role(trammel.CardRole.FEED_HOLD, 1 << self.HOLD)
        card.set_role(trammel.Role(trammel.CardRole.CYCLE_START), 1 << self.START)
        self.assertEqual((card.read_role(limit), limit.number, limit.name), (0x14, 1, "limit minus of axis 1"))
        self.set(card, 4, True)
        roles = card.read_roles()
        self.assertEqual((roles.limit_minus, roles.limit_plus), ([False, True, False, False], [False] * 4))
        self.set(card, self.HOLD, True)
        status = card.read_status()
        self.assertTrue(card.read_roles().feed_hold and status.button_hold and status.settled)
        self.set(card, self.HOLD, False)
        self.assertFalse(card.read_roles().feed_hold)
        self.assertTrue(card.read_status().button_hold)
        self.set(card, self.START, True)
        self.assertTrue(card.read_roles().cycle_start)
        self.assertFalse(card.read_status().button_hold)

    def on_a_limits_ramp(self, overtravel):
        """A card that has stepped into a limit switch and stopped on a ramp of 0.1 s, which takes 50 pulses."""
        card = trammel.simulate()
        card.set_slew_time(100_000_000)
        card.set_role(trammel.Role(trammel.AxisRole.LIMIT_PLUS, 0), 1 << self.X_PLUS)
        card.set_input_stops(limit_ramps=True)
        card.set_overtravel(0, overtravel)
        self.assertEqual(card.read_rest().time, 0)
        card.start_line([500], duration_ns=SECOND // 2)
        card.wait(200_000)
        self.set(card, self.X_PLUS, True)
        card.wait(20_000)
        return card

    def test_a_limit(self):
        card = self.on_a_limits_ramp(60)
        self.assertTrue(card.read_status().stopping)
        self.assertRaisesRegex(trammel.StateError, "on its way to a stop", card.read_rest)
        card.wait_until_stopped()
        rest = card.read_rest()
        self.assertTrue(rest.exact and rest.status.direct and 230 < rest.position[0] < 260)
        self.assertEqual(rest.position, card.read_snapshot().position)
        self.assertEqual(rest.ticks_left // 1000, 500 - rest.position[0])
        self.assertEqual(card.read_limit_state().plus, [True, False, False, False])
        self.assertEqual(card.read_fault_text(), "LIMIT (axis 0 plus)")
        card.name_axes(["X"])
        self.assertEqual(card.read_fault_text(), "LIMIT (X plus)")
        self.assertEqual(trammel.describe_faults(0x800, 0x201, ["X"]), "LIMIT (X minus, axis 1 plus)")
        card.clear_faults()
        self.assertEqual(card.read_fault_text(), "none")
        card.run_line([-20], duration_ns=20_000_000)
        with self.assertRaisesRegex(trammel.FaultError, "X plus"):
            card.run_line([10], duration_ns=10_000_000)
        card.clear_faults()
        card.override_limits(plus=[0])
        card.run_line([10], duration_ns=10_000_000)

    def test_overtravel_ends_at_once(self):
        card = self.on_a_limits_ramp(5)
        card.wait_until_stopped(0)
        self.assertTrue(200 < card.read_rest().position[0] < 210)

    def test_clearing_on_the_ramp_waits_for_its_end(self):
        card = self.on_a_limits_ramp(60)
        card.clear_faults()
        self.assertFalse(card.read_status().stopping or card.read_status().faulted)
        card.run_line([-20], duration_ns=20_000_000)

    def test_an_abort_in_motion_is_not_exact(self):
        card = trammel.simulate()
        card.start_line([500], duration_ns=SECOND // 2)
        card.wait(100_000)
        card.abort()
        rest = card.read_rest()
        self.assertEqual((rest.exact, rest.ticks_left, rest.faults), (False, 0, 0))

    def test_status_of_an_under_run_and_of_a_late_period(self):
        card = trammel.simulate()
        stream = trammel.Stream(card)
        stream.send([trammel.feed(1000, TICK_EVERY_16, stop_distance=500), trammel.line(1000, [10])])
        stream.flush()
        card.wait(100_000)
        self.assertTrue(card.read_status().underrun)
        card = trammel.simulate()
        positions = trammel.PositionStream(card, stale_periods=100, ahead=1)
        positions.send([positions.PULSE], SECOND // 1000)
        card.wait(2000)
        self.assertTrue(card.read_status().stale)

    def test_bad_arguments(self):
        card = trammel.simulate()
        for call in (lambda: trammel.Role(trammel.AxisRole.HOME, 8),
                     lambda: card.set_role(trammel.Role(trammel.AxisRole.HOME, 4), 1),
                     lambda: card.set_role(trammel.CardRole.PROBE, 0x10000),
                     lambda: card.set_input_filter(16, 0), lambda: card.read_input_filter(16),
                     lambda: card.set_input_stops(shared=[4]), lambda: card.set_overtravel(0, 65_536),
                     lambda: card.override_limits(minus=[4]), lambda: card.set_input(16, True)):
            self.assertRaises(trammel.ArgumentError, call)


if __name__ == "__main__":
    unittest.main()
