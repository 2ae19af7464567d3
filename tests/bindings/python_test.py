"""The Python package: driver, simulated card, interpolators, and their errors."""
import math
import os
import signal
import socket
import threading
import time
import unittest

import trammel
from trammel import interpolation as ip

SECOND = 1_000_000_000
TICK_EVERY_16 = 1 << 60


class Cards(unittest.TestCase):
    def test_identification(self):
        card = trammel.simulate(axes=7, clock_hz=25_000_000)
        self.assertEqual((card.identification.axes, card.identification.clock_hz), (7, 25_000_000))
        self.assertEqual(trammel.open("sim:?axes=3").identification.axes, 3)
        units = {unit.name: unit for unit in card.identification.units}
        axes = units["axes"]
        self.assertEqual((axes.instances, axes.address, axes.stride), (7, 0x800, 32))
        self.assertEqual(units["queues"].words, 1)

    def test_close_and_with(self):
        with trammel.simulate() as card:
            stream = trammel.Stream(card)
            card.run_line([20, 40], duration_ns=1_000_000)
        for use in (card.read_snapshot, stream.finish, lambda: card.wait(1),
                    lambda: card.run_line([1], duration_ns=1_000_000)):
            self.assertRaisesRegex(trammel.StateError, "the card is closed", use)
        card.close()
        self.assertEqual(card.identification.axes, 4)

    def test_lines_in_one_burst(self):
        card = trammel.simulate()
        card.record_steps()
        plan = card.run_line([20, -40], duration_ns=2_000_000)
        self.assertEqual((plan.parts, plan.clocks, plan.slowed), (1, 2000, False))
        self.assertEqual(card.read_snapshot().position, [20, -40, 0, 0, 0, 0, 0, 0])
        self.assertEqual(sum(1 for _, axis, way in card.pin_steps if axis == 1 and way == -1), 40)
        self.assertEqual(card.run_line([30, 40], speed=1000).clocks, 50_000)
        plan = card.run_line([30, 40], speed=1000, max_velocity=[0, 400], slow_down=True)
        self.assertEqual((plan.clocks, plan.slowed), (100_000, True))

    def test_hold_override_stop(self):
        card = trammel.simulate()
        card.set_slew_time(1_000_000)
        card.start_line([10_000], duration_ns=SECOND)
        card.set_hold()
        card.wait(2000)
        self.assertTrue(card.read_status().held)
        card.set_hold(False)
        card.set_override(50)
        card.wait(100_000)
        self.assertTrue(450 < card.read_snapshot().position[0] < 550)
        rest = card.stop()
        card.wait(100_000)
        self.assertEqual(card.read_snapshot().position, rest.position)

    def test_another_thread_stops(self):
        card = trammel.simulate()
        thread = threading.Timer(0.05, card.request_stop)
        thread.start()
        with self.assertRaises(trammel.StoppedError):
            card.run_line([1], duration_ns=(1 << 39) * 1000)
        thread.join()


class Places(unittest.TestCase):
    """The machine's position, which a card keeps from one program to the next."""

    def cut_off(self, card):
        card.start_line([1000], duration_ns=SECOND)
        card.wait(100_000)
        self.assertRaisesRegex(trammel.StateError, "the card moves", card.begin_at_place)
        card.abort()
        card.wait(1000)

    def test_the_first_program_sets_it_and_the_next_goes_on(self):
        card = trammel.simulate()
        card.run_line([7], duration_ns=1_000_000)
        self.assertFalse(card.read_place().was_set)
        begin = card.begin_at_place()
        self.assertEqual((begin.first, begin.was_set, begin.scales), (True, True, 1))
        self.assertEqual((begin.machine_zero, begin.pulses), ([7, 0, 0, 0], [0, 0, 0, 0]))
        self.assertEqual((begin.valid, begin.homed, begin.keeps), ([True] * 4, [False] * 4, [False] * 4))
        card.run_line([20, -40], duration_ns=1_000_000)
        again = card.begin_at_place([0, 1])
        self.assertEqual((again.first, again.pulses), (False, [20, -40, 0, 0]))
        card.reset()
        self.assertEqual((card.read_place().was_set, card.read_place().valid), (False, [False] * 4))

    def test_a_lost_place_is_refused(self):
        card = trammel.simulate()
        card.begin_at_place()
        self.cut_off(card)
        self.assertEqual(card.read_place().valid, [False, True, True, True])
        self.assertRaisesRegex(trammel.StateError, "of axis 0 was lost", card.begin_at_place)
        card.begin_at_place([1, 2])
        self.assertFalse(card.read_place().valid[0])
        self.assertTrue(all(card.begin_at_place(trust=True).valid))
        card.set_keeps_place([0])
        self.cut_off(card)
        self.assertEqual((card.read_place().valid[0], card.read_place().keeps), (True, [True, False, False, False]))

    def test_set_by_hand(self):
        card = trammel.simulate()
        card.run_line([100], duration_ns=1_000_000)
        card.begin_at_place()
        card.set_place([0], valid=False)
        card.set_machine_zero(0, 75)
        card.set_place([0], homed=True)
        card.set_scales(0xC0FFEE)
        place = card.begin_at_place()
        self.assertEqual((place.pulses[0], place.homed, place.scales), (25, [True, False, False, False], 0xC0FFEE))

    def test_bad_arguments(self):
        card = trammel.simulate()
        for call in (lambda: card.begin_at_place([4]), lambda: card.set_place([0], valid=False, homed=True),
                     lambda: card.set_machine_zero(4, 0), lambda: card.set_keeps_place([7])):
            self.assertRaises(trammel.ArgumentError, call)
        self.assertFalse(card.read_place().was_set)


class Holds(unittest.TestCase):
    def test_a_hold_from_before_is_found_at_once(self):
        card = trammel.simulate()
        card.set_hold()
        with self.assertRaisesRegex(trammel.HeldError, "set by this program"):
            card.run_line([10], duration_ns=1_000_000)
        self.assertIsNone(card.take_over())
        card.start_line([10], duration_ns=SECOND)
        card.set_hold()
        self.assertFalse(card.take_over().status.busy)
        card.run_line([10], duration_ns=1_000_000)


class Interrupts(unittest.TestCase):
    """A real SIGINT while a call waits must raise KeyboardInterrupt and leave the card at rest with empty queues."""

    HOURS = 10**6 * SECOND
    # Seconds of the processor, and of the clock: on a busy machine much more time passes than this process uses.
    HEARD = 0.2
    HEARD_BY_THE_CLOCK = 2

    def interrupted(self, call, calls):
        """From the signal to the exception: seconds of the processor, and of the clock. The signal is sent when `calls`,
        a count of progress, no longer changes."""
        sent = []

        def send():
            before = None
            while before != calls():
                before = calls()
                time.sleep(0.06)
            sent.extend((time.process_time(), time.monotonic()))
            os.kill(os.getpid(), signal.SIGINT)

        sender = threading.Thread(target=send)
        sender.start()
        with self.assertRaises(KeyboardInterrupt) as raised:
            call()
        heard = (time.process_time() - sent[0], time.monotonic() - sent[1])
        sender.join()
        self.assertIsInstance(raised.exception.__cause__, trammel.Error)
        return heard

    def expect_heard(self, call, calls=lambda: 0):
        used, passed = self.interrupted(call, calls)
        self.assertLess(used, self.HEARD)
        self.assertLess(passed, self.HEARD_BY_THE_CLOCK)

    def expect_rest(self, card):
        self.assertFalse(card.read_status().busy or card.read_status().held)
        before = card.read_snapshot().position
        card.wait(1_000_000)
        self.assertEqual(card.read_snapshot().position, before)

    def test_lines(self):
        card = trammel.simulate()
        card.set_slew_time(10_000_000)
        self.expect_heard(lambda: card.run_line([10**6], duration_ns=self.HOURS))
        self.expect_rest(card)
        card.start_line([10**6], duration_ns=self.HOURS)
        self.expect_heard(lambda: card.wait_until_idle(2 * self.HOURS))
        self.expect_rest(card)
        card.run_line([10], duration_ns=1_000_000)

    def test_a_line_in_a_hold(self):
        card = trammel.simulate()
        card.request_hold()
        self.expect_heard(lambda: card.run_line([10**6], duration_ns=self.HOURS))
        self.expect_rest(card)

    def test_streams(self):
        card = trammel.simulate()
        for progress in (None, lambda is_: None, lambda is_: time.sleep(0.001)):
            stream = trammel.Stream(card, progress=progress)
            stream.send([trammel.feed(10**9, TICK_EVERY_16), trammel.line(10**9, [1000]), trammel.end()])
            self.expect_heard(stream.finish)
            self.expect_rest(card)
        stream.restart()
        stream.send([trammel.feed(64, TICK_EVERY_16), trammel.line(64, [1]), trammel.end()])
        stream.finish()

    def test_a_full_queue(self):
        card = trammel.simulate()
        stream = trammel.Stream(card)
        put = [0]

        def fill():
            while True:
                put[0] += 1
                stream.put(trammel.feed(10**9, TICK_EVERY_16))
                stream.put(trammel.line(10**9, [1000]))

        self.expect_heard(fill, calls=lambda: put[0])
        self.expect_rest(card)

    def test_other_waits(self):
        card = trammel.simulate()
        self.expect_heard(lambda: card.wait(1 << 62))
        card.set_slew_time(SECOND)
        card.start_line([10**6], duration_ns=self.HOURS)
        card.wait(10_000)
        with self.assertRaises(trammel.TimeoutError):
            card.wait_until_idle(1000)

    def test_a_silent_link(self):
        with socket.create_server(("127.0.0.1", 0)) as server:
            url = "tcp://127.0.0.1:%d" % server.getsockname()[1]
            self.expect_heard(lambda: trammel.open(url))
            self.expect_heard(lambda: trammel.open(url + "?hello=no&timeout=60000"))

    def test_a_handler_of_ones_own(self):
        def end(*_):
            raise KeyError("enough")

        before = signal.signal(signal.SIGALRM, end)
        try:
            card = trammel.simulate()
            signal.setitimer(signal.ITIMER_REAL, 0.05)
            with self.assertRaises(KeyError):
                card.run_line([10**6], duration_ns=self.HOURS)
            self.expect_rest(card)
        finally:
            signal.signal(signal.SIGALRM, before)


class Streams(unittest.TestCase):
    def test_all_commands(self):
        card = trammel.simulate()
        card.record_steps()
        stream = trammel.Stream(card)
        quarter = {"centre": (-25_600, 0), "end": (-100, 100), "sweep": math.pi / 2}
        stream.send([
            trammel.feed(512 + 1000 + 20_000, TICK_EVERY_16),
            trammel.line(512, [100, -300]),
            trammel.arc(1000, **quarter),
            trammel.helix(20_000, **quarter, further=[0, 0, 77]),
            trammel.output(set=4),
            trammel.mark(),
            trammel.dwell(1000),
            trammel.wait_input(3, level=False),
            trammel.end(),
        ])
        self.assertTrue(stream.finish().ended)
        self.assertEqual(stream.sent, 9)
        self.assertEqual(card.read_snapshot().position[:4], [-100, -100, 77, 0])
        self.assertEqual((card.read_outputs(), card.read_marks(), card.read_mark_snapshot().position[2]), (4, 1, 77))
        self.assertEqual(len(card.path_steps), 400 + 200 + len([s for s in card.path_steps if s[0] == 3]))
        self.assertEqual(trammel.dwell(7).name, "DWELL")
        self.assertEqual(len(trammel.end().words()), 3)

    def test_probing(self):
        card = trammel.simulate()
        card.set_slew_time(1_000_000)
        stream = trammel.Stream(card, progress=lambda is_: card.set_inputs(2) if is_.status.path_active else None)
        result = stream.probe(1, [trammel.feed(10_000, TICK_EVERY_16), trammel.line(10_000, [1000])])
        self.assertEqual(result.outcome, trammel.ProbeOutcome.TRIPPED)
        self.assertTrue(0 < result.edge.position[0] <= result.rest.position[0] < 1000)

    def test_an_exception_of_progress_passes_through(self):
        def stop(_):
            raise KeyError("enough")

        stream = trammel.Stream(trammel.simulate(), progress=stop)
        stream.send([trammel.feed(10_000, TICK_EVERY_16), trammel.line(10_000, [1000])])
        with self.assertRaises(KeyError):
            stream.finish()

    def test_a_stream_keeps_its_card(self):
        stream = trammel.Stream(trammel.simulate())
        stream.send([trammel.end()])
        self.assertTrue(stream.finish().ended)


class Positions(unittest.TestCase):
    PERIOD = 1_000_000  # ns, 1000 clocks

    def open(self, **options):
        card = trammel.simulate()
        card.set_slew_time(10_000_000)
        return card, trammel.PositionStream(card, **options)

    def test_periods_in_time_and_late(self):
        card, stream = self.open(stale_periods=2)
        late = []
        for i in range(1, 41):
            due = 1000 * (i + 5) + (1500 if i == 21 else 0)
            card.wait(max(0, due - card.read_snapshot().time))
            late.append(stream.send([20 * i * stream.PULSE, 5 * i * stream.PULSE], self.PERIOD).stale_ticks)
        self.assertEqual([i for i, ticks in enumerate(late, 1) if ticks], [21])
        self.assertEqual((sum(late), stream.ticks_behind), (stream.stale_ticks, 0))
        stream.send([800 * stream.PULSE, 200 * stream.PULSE], self.PERIOD)
        self.assertEqual(stream.finish()[:3], [800 * stream.PULSE, 200 * stream.PULSE, 0])
        self.assertEqual(card.read_snapshot().position[:3], [800, 200, 0])
        with self.assertRaises(trammel.StateError):
            stream.send([0], self.PERIOD)

    def test_a_missing_period(self):
        card, stream = self.open()
        for i in range(1, 11):
            stream.send([20 * i * stream.PULSE], self.PERIOD)
        card.wait(50_000)
        with self.assertRaises(trammel.FaultError) as fault:
            stream.send([220 * stream.PULSE], self.PERIOD)
        stopped = stream.recover()
        self.assertEqual(trammel.describe_faults(stopped.faults), "MISSING_PERIOD")
        self.assertEqual(stopped.faults, fault.exception.faults)
        self.assertGreater(stopped.stale_ticks, 0)
        at = card.read_snapshot().position[0]
        self.assertEqual(stopped.positions[0], at * stream.PULSE)
        self.assertEqual(stream.position[0], stopped.positions[0])
        stream.send([(at + 7) * stream.PULSE], self.PERIOD)
        stream.finish()
        self.assertEqual(card.read_snapshot().position[0], at + 7)

    def test_what_is_refused(self):
        card, stream = self.open(max_speed=[1000])
        self.assertEqual(stream.shortest_period, 88)
        for targets, duration in (([3 * stream.PULSE], self.PERIOD), ([0], 10), ([0] * 9, self.PERIOD)):
            with self.assertRaises(trammel.ArgumentError):
                stream.send(targets, duration)
        with self.assertRaises(trammel.ArgumentError):
            trammel.PositionStream(card, ahead=0)
        self.assertEqual(card.read_snapshot().position[0], 0)


class Errors(unittest.TestCase):
    def test_classes(self):
        for name in ("LinkError", "IdentificationError", "RefusedError", "FaultError", "StateError", "HeldError", "InterruptedError", "ArgumentError", "TimeoutError"):
            self.assertTrue(issubclass(getattr(trammel, name), trammel.Error), name)
        self.assertTrue(issubclass(trammel.StoppedError, trammel.StateError))
        self.assertTrue(issubclass(trammel.ArgumentError, ValueError))

    def test_arguments(self):
        card = trammel.simulate()
        for call in (
            lambda: trammel.simulate(axes=9),
            lambda: trammel.open("carrier pigeon:"),
            lambda: card.start_line([1]),
            lambda: card.start_line([1], duration_ns=1, speed=1),
            lambda: card.start_line([1] * 9, duration_ns=1_000_000),
            lambda: card.configure_axis(4),
            lambda: trammel.line(10, [11]),
            lambda: trammel.arc(10, centre=(0, 0), end=(1, 1), sweep=1),
            lambda: trammel.feed(10, 1, floor=0).words(),
            lambda: trammel.feed(10, 1, slew_shift=4).words(),
        ):
            with self.assertRaises(trammel.ArgumentError):
                call()
        with self.assertRaises(trammel.IdentificationError):
            trammel.simulate(clock_hz=0)
        with self.assertRaises(trammel.LinkError):
            trammel.open("serial:/dev/trammel-is-not-there")

    def test_what_the_card_says(self):
        card = trammel.simulate()
        card.start_line([10], duration_ns=SECOND)
        with self.assertRaises(trammel.RefusedError) as refused:
            card.start_line([10], duration_ns=SECOND)
        self.assertEqual(refused.exception.reason, 8)
        with self.assertRaises(trammel.TimeoutError) as late:
            card.wait_until_idle(1000)
        self.assertGreater(late.exception.waited, 0)
        with self.assertRaises(trammel.StateError):
            trammel.Stream(card)
        card.abort()
        card.wait_until_idle(SECOND)
        stream = trammel.Stream(card)
        stream.send([trammel.feed(100, TICK_EVERY_16), trammel.line(99, [1]), trammel.end()])
        with self.assertRaises(trammel.FaultError) as fault:
            stream.finish()
        self.assertEqual(trammel.describe_faults(fault.exception.faults), "TICK_MISMATCH")
        card.clear_faults()
        stream.restart()
        self.assertEqual(card.read_faults(), 0)

    def test_watchdog(self):
        card = trammel.simulate()
        card.set_watchdog(10_000_000)
        card.wait(1_000_000)
        self.assertIn("WATCHDOG", trammel.describe_faults(card.read_faults()))
        card.set_watchdog(0)
        card.clear_faults()
        card.wait(1_000_000)
        self.assertEqual(card.read_faults(), 0)


class Interpolators(unittest.TestCase):
    def test_every_method_comes_to_the_end(self):
        curves = [(ip.line((0, 0), (7, -3)), lambda m: m.line_axes >= 2, (7, -3)),
                  (ip.line((0, 0, 0), (9, 5, -2)), lambda m: m.line_axes >= 3, (9, 5, -2)),
                  (ip.circle(25), lambda m: m.circles, (25, 0)),
                  (ip.arc((0, 0), (30, 0), (-30, 0), semi_axes=(30, 10)), lambda m: m.ellipses, (-30, 0))]
        walks = 0
        for curve, fits, end in curves:
            for method in ip.methods():
                if not fits(method):
                    with self.assertRaises(trammel.ArgumentError):
                        ip.interpolate(method.name, curve)
                    continue
                walk = ip.interpolate(method.name, curve)
                path = walk.path()
                self.assertEqual(path, list(walk), method.name)
                self.assertEqual(walk.position, end, method.name)
                self.assertTrue(walk.done and walk.time <= walk.total_time)
                walks += 1
        self.assertGreater(walks, 15)

    def test_deviation_has_128_bits(self):
        walk = ip.interpolate("steer", ip.arc((0, 0), (1 << 20, 0), (-(1 << 20), 0), semi_axes=(1 << 20, 1 << 19)))
        seen = [walk.deviation for _ in zip(range(5), walk)]
        self.assertTrue(any(abs(f) >= 1 << 40 for f in seen), seen)
        self.assertIsNone(ip.interpolate("one-shot", ip.line((0, 0), (3, 2))).deviation)

    def test_goldbergs_line(self):
        walk = ip.interpolate("steer", ip.line((0, 0), (3, 2)))
        self.assertEqual(walk.deviation, 1)
        self.assertEqual([place for _, place in walk], [(1, 0), (1, 1), (2, 1), (2, 2), (3, 2)])

    def test_unknown_method(self):
        with self.assertRaisesRegex(trammel.ArgumentError, "nonsense"):
            ip.interpolate("nonsense", ip.circle(3))


if __name__ == "__main__":
    unittest.main()
