"""The record of `trammel linuxcnc --record`, judged by the closed form: behind each period every axis is at its target,
rounded; within a period it is on the straight line between two targets."""

from bench import UNIT, check


class Stream:
    def __init__(self, standing):
        self.standing = standing
        self.periods = []  # (number, clocks, targets)
        self.steps = []    # (command, tick, axis, direction)


class Record:
    def __init__(self, path):
        self.streams = []
        self.pins = []  # (cycle, axis, direction)
        for line in open(path):
            words = line.split()
            if words[0] == "open":
                self.streams.append(Stream([int(word) for word in words[1:]]))
            elif words[0] == "period":
                numbers = [int(word) for word in words[1:]]
                self.streams[-1].periods.append((numbers[0], numbers[1], numbers[2:]))
            elif words[0] == "path" and self.streams:
                self.streams[-1].steps.append(tuple(int(word) for word in words[1:]))
            elif words[0] == "pin":
                self.pins.append(tuple(int(word) for word in words[1:]))

    def net(self, axis):
        """Pulses at the pins from the beginning."""
        return sum(direction for _, number, direction in self.pins if number == axis)
