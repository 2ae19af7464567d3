"""The record of `trammel linuxcnc --record`, judged by the closed form: behind each period every axis is at its target,
rounded, and within a period it is on the straight line between two targets."""

from bench import UNIT, check


class Stream:
    """From the machine's switching on until its end."""

    def __init__(self, standing):
        self.standing = standing  # pulses
        self.lines = []           # (number, duration in ns, targets in 2^-24 pulses)
        self.steps = []           # (clock, command, axis, direction)

    def furthest(self):
        """Largest distance, in pulses, between a target and the axis when its line has ended. A stream that was stopped
        ends before its last lines: only those with a later step count."""
        steps = {}
        for _, command, axis, direction in self.steps:
            steps.setdefault(command, []).append((axis, direction))
        if not steps:
            return 0.0, 0
        first = self.first_command(steps)
        at, most, compared = list(self.standing), 0.0, 0
        for index, (_, _, targets) in enumerate(self.lines):
            if first + index > max(steps):
                break
            for axis, direction in steps.get(first + index, []):
                at[axis] += direction
            if first + index == max(steps):
                break  # may have been cut short
            compared += 1
            most = max(most, max(abs(a - t / UNIT) for a, t in zip(at, targets)))
        return most, compared

    def first_command(self, steps):
        return 0


class Record:
    def __init__(self, path):
        self.streams, self.net = [], {}
        for line in open(path):
            kind, *words = line.strip().split(",")
            numbers = [int(word) for word in words]
            if kind == "open":
                self.streams.append(Stream(numbers[1:]))
            elif kind == "line":
                self.streams[-1].lines.append((numbers[0], numbers[1], numbers[2:]))
            elif kind == "step":
                self.net[numbers[2]] = self.net.get(numbers[2], 0) + numbers[3]
                if self.streams:
                    self.streams[-1].steps.append(tuple(numbers))
        check(self.streams, "nothing was streamed")
