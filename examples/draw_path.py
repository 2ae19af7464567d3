#!/usr/bin/env python3
"""Draws a path: what a card makes of a square with a rounded corner, and an interpolator's circle, as SVG.

    python3 examples/draw_path.py path.svg [CARD]     (CARD: the URL of a card; simulated unless it is given)

The steps are those that the simulated card makes; a real card shows where it stands alone. Points are in pulses from
machine zero, which a card keeps from one program to the next: drawn again on the same card, the square begins there.
"""
import math
import sys

import trammel
from trammel import interpolation

TICK_EVERY_16_CLOCKS = 1 << 60


def commands():
    """A square of 60 pulses whose last corner is a quarter of a circle of 20 pulses."""
    paths = [
        trammel.line(600, [60]),
        trammel.line(600, [0, 60]),
        trammel.line(400, [-40]),
        trammel.arc(400, centre=(0, -20 * 256), end=(-20, -20), sweep=math.pi / 2),
        trammel.line(400, [0, -40]),
    ]
    return [trammel.feed(600 + 600 + 400 + 400 + 400, TICK_EVERY_16_CLOCKS), *paths, trammel.end()]


def run(url):
    """Every place on the way, in pulses from machine zero."""
    card = trammel.open(url)
    simulated = url.startswith("sim:")
    if simulated:
        card.record_steps()
    card.take_over()  # a served card holds when the client before has gone
    begin = card.begin_at_place([0, 1])
    if begin.first:
        print("the card was reset: machine zero is where it stands now")
    else:
        print(f"the card stands at {begin.pulses}, in pulses from machine zero")
    start = begin.pulses[:2]
    stream = trammel.Stream(card)
    stream.send(commands())
    stream.finish()
    end = card.read_place().pulses[:2]
    if not simulated:
        return [tuple(start), tuple(end)]
    place, places = list(start), [tuple(start)]
    for _, _, axis, direction in card.path_steps:
        place[axis] += direction
        places.append(tuple(place))
    if place != end:
        sys.exit(f"error: the steps end at {place}, the card at {end}")
    return places


def svg(*lines):
    """Each line of points in a colour, y upwards."""
    points = [point for line in lines for point in line]
    left, right = min(x for x, _ in points) - 5, max(x for x, _ in points) + 5
    low, high = min(y for _, y in points) - 5, max(y for _, y in points) + 5
    shapes = "\n".join(
        f'<polyline fill="none" stroke="{colour}" stroke-width="0.5" points="{" ".join(f"{x},{-y}" for x, y in line)}"/>'
        for line, colour in zip(lines, ("#1f77b4", "#d62728")))
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{left} {-high} {right - left} {high - low}" width="600">\n'
            f"{shapes}\n</svg>\n")


def main():
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    places = run(sys.argv[2] if len(sys.argv) == 3 else "sim:")
    circle = interpolation.interpolate("min-deviation-8", interpolation.circle(15))
    ring = [(15, 0)] + [place for _, place in circle]
    left, low = places[0]
    moved = [(left + x + 30, low + y + 30) for x, y in ring]
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        file.write(svg(places, moved))
    print(f"{len(places) - 1} steps to {places[-1]}; {len(ring) - 1} of the circle; {sys.argv[1]}")


main()
