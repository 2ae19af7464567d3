"""The record of `trammel linuxcnc --record`, judged by the closed form: at the end of each period every axis is at its
rounded target, and within a period it is on the straight line between two targets."""

from bench import UNIT, check


class Stream:
    """The record from switching the machine on until its end."""

    def __init__(self, standing):
        self.standing = standing  # pulses
        self.lines = []           # (number, time in ns, duration in ns, targets in 2^-24 pulses)
        self.steps = []           # (clock, command, axis, direction)

    def furthest(self, lead):
        """Largest distance, in pulses, between a target and the axis at the end of its line, and the number of lines.
        Only lines before the last step count, because lines left in the queue at the machine's end make no steps."""
        steps = {}
        for _, command, axis, direction in self.steps:
            # Steps have the number of their command in the stream. After the first `lead` lines, the stream has one
            # command that is no line.
            steps.setdefault(command if command < lead else command - 1, []).append((axis, direction))
        at, most = list(self.standing), 0.0
        whole = self.lines[:max(steps, default=0)]
        for index, (_, _, _, targets) in enumerate(whole):
            for axis, direction in steps.get(index, []):
                at[axis] += direction
            most = max(most, max(abs(a - t / UNIT) for a, t in zip(at, targets)))
        return most, len(whole)


    def caught_up(self, period):
        """The longest time, in ns, that LinuxCNC's thread caught up after it was late. The card's queue then has this
        much more than the lead, because the late periods arrived in quick succession."""
        lateness = [time - number * period for number, time, _, _ in self.lines]
        most, behind = 0, max(lateness[:1], default=0)
        for late in lateness:
            behind = max(behind, late)
            most = max(most, behind - late)
        return most


class Record:
    def __init__(self, path):
        self.streams, self.net = [], {}
        for line in open(path):
            kind, *words = line.strip().split(",")
            numbers = [int(word) for word in words]
            if kind == "open":
                self.streams.append(Stream(numbers[1:]))
            elif kind == "line":
                self.streams[-1].lines.append((numbers[0], numbers[1], numbers[2], numbers[3:]))
            elif kind == "step":
                self.net[numbers[2]] = self.net.get(numbers[2], 0) + numbers[3]
                if self.streams:
                    self.streams[-1].steps.append(tuple(numbers))
        check(self.streams, "nothing was streamed")

    def caught_up(self, period):
        return max(stream.caught_up(period) for stream in self.streams)

    def judge(self, least, lead):
        """Checks that every axis is within half a pulse of every target, in at least `least` lines; returns a text for
        the log."""
        found = [stream.furthest(lead) for stream in self.streams]
        most, lines = max(most for most, _ in found), sum(lines for _, lines in found)
        check(lines >= least, f"{lines} lines were compared, fewer than {least}")
        check(most <= 0.5, f"an axis was {most} pulses from its target")
        return f"{lines} lines of {len(self.streams)} streams: at most {most:.4f} pulses from the target"
