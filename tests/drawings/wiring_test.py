#!/usr/bin/env python3
"""The generator of wiring drawings. A drawing, read back from its SVG as a person would read it, must connect the same
pins as the text. Ambiguous drawings must be refused."""
import re
import sys
import unittest
import xml.etree.ElementTree as xml
from pathlib import Path
from unittest import mock

PROJECT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(PROJECT / "scripts" / "documentation"))
import wiring  # noqa: E402

SVG = "{http://www.w3.org/2000/svg}"
TWO = """
box a "A"
> 1 "one"
> 2 "two"
> 3 "three"
column
box b "B"
< 1 "one"
< 2 "two"
< 3 "three"
"""
# The same with the right pins half a row lower, so that any two pins can be connected.
SHIFTED = TWO.replace('box b "B"', 'box b "B" "lower"')


def group_points(points, joined):
    """A number for each point; points that are joined have the same."""
    number = {point: n for n, point in enumerate(points)}
    for a, b in joined:
        old, new = number[a], number[b]
        number = {point: new if n == old else n for point, n in number.items()}
    return number


def crosses(line, point):
    """Whether the point lies on the line, its ends included."""
    (x1, y1), (x2, y2) = line
    x, y = point
    return min(x1, x2) <= x <= max(x1, x2) and min(y1, y2) <= y <= max(y1, y2)


def nets_of(svg):
    """The sets of pins that the drawing connects. Wires join at common ends and at dots; elsewhere they only cross."""
    root = xml.fromstring(svg)
    lines = [((float(e.get("x1")), float(e.get("y1"))), (float(e.get("x2")), float(e.get("y2")))) for e in root.iter(f"{SVG}line")]
    circles = [(e, (float(e.get("cx")), float(e.get("cy")))) for e in root.iter(f"{SVG}circle")]
    dots = [place for e, place in circles if e.get("class") == "dot"]
    pins = {e.get("data-pin"): place for e, place in circles if e.get("class") == "pin"}
    points = sorted({*(end for line in lines for end in line), *dots, *pins.values()})
    joined = list(lines) + [(line[0], dot) for line in lines for dot in dots if crosses(line, dot)]
    number = group_points(points, joined)
    nets = {}
    for name, place in pins.items():
        nets.setdefault(number[place], set()).add(name)
    return sorted(tuple(sorted(net)) for net in nets.values() if len(net) > 1)


def error_of(source):
    try:
        wiring.draw(source)
    except wiring.WiringError as error:
        return str(error)
    return "no error"


class ReadBack(unittest.TestCase):
    def test_straight_and_crossed(self):
        self.assertEqual(nets_of(wiring.draw(TWO + "wire a.1 b.1\nwire a.2 b.2\nwire a.3 b.3\n")),
                         [("a.1", "b.1"), ("a.2", "b.2"), ("a.3", "b.3")])
        self.assertEqual(nets_of(wiring.draw(SHIFTED + "wire a.1 b.1\nwire a.2 b.3\nwire a.3 b.2\n")),
                         [("a.1", "b.1"), ("a.2", "b.3"), ("a.3", "b.2")])
        # Two wires share a height, so only one order of the lanes works.
        self.assertEqual(nets_of(wiring.draw(TWO + "wire a.1 b.2\nwire a.2 b.3\n")), [("a.1", "b.2"), ("a.2", "b.3")])
        self.assertEqual(nets_of(wiring.draw(TWO + "wire a.3 b.2\nwire a.2 b.1\n")), [("a.2", "b.1"), ("a.3", "b.2")])

    def test_a_net_of_many(self):
        self.assertEqual(nets_of(wiring.draw(TWO + "wire a.2 b.1 b.2 b.3\n")), [("a.2", "b.1", "b.2", "b.3")])
        self.assertEqual(nets_of(wiring.draw(TWO + "wire b.2 a.1 a.3\n")), [("a.1", "a.3", "b.2")])
        # One net on the left side only, and one from right to left.
        self.assertEqual(nets_of(wiring.draw(TWO + "wire a.1 a.3\nwire b.3 a.2\n")), [("a.1", "a.3"), ("a.2", "b.3")])

    def test_a_part_in_line_parts_the_wire(self):
        for kind in sorted(wiring.PARTS):
            self.assertEqual(nets_of(wiring.draw(TWO + f'wire a.1 {kind} "x" b.1\nwire a.2 b.2\n')), [("a.2", "b.2")], kind)

    def test_a_part_that_hangs_does_not(self):
        spread = TWO.replace('> 2', '-\n' * 4 + '> 2').replace('< 2', '-\n' * 4 + '< 2')
        svg = wiring.draw(spread + 'wire a.1 down C "10 nF" GND b.1\nwire a.2 up R "1 kΩ" "+3.3 V" b.2\n')
        self.assertEqual(nets_of(svg), [("a.1", "b.1"), ("a.2", "b.2")])
        self.assertEqual(svg.count('class="dot"'), 2)

    def test_many_random_nets(self):
        """Random nets between five left and five right pins, three of them with more pins, must be drawn as
        described."""
        import random
        chance = random.Random(1)
        rows = "".join(f'{{0}} {n} "{n}"\n' for n in range(5))
        for _ in range(200):
            right = chance.sample(range(5), 5)
            source = 'box a "A"\n' + rows.format(">") + 'column 240\nbox b "B" "lower"\n' + rows.format("<")
            nets = [(f"a.{n}", f"b.{right[n]}") for n in range(4)]
            nets[chance.randrange(4)] += (f"b.{right[4]}", "a.4")
            source += "".join(f"wire {' '.join(net)}\n" for net in nets)
            self.assertEqual(nets_of(wiring.draw(source)), sorted(tuple(sorted(net)) for net in nets), source)

    def test_drawings_of_the_pages(self):
        pages = 0
        for page in sorted((PROJECT / "docs").rglob("*.md")):
            for source in re.findall(r"^```wiring\n(.*?)^```$", page.read_text(), re.MULTILINE | re.DOTALL):
                pages += 1
                drawing = wiring.read(source, lambda label: label)
                expected = [tuple(sorted(wire.pins)) for wire in drawing.wires
                            if len(wire.pins) > 1 and all(part.hangs for part in wire.parts)]
                found = nets_of(wiring.draw(source))
                for net in expected:
                    self.assertTrue(any(set(net) <= set(other) for other in found), (page.name, net, found))
        self.assertGreater(pages, 8)


class SeededBugs(unittest.TestCase):
    """The tests above must find each bug."""

    def test_a_dot_that_is_missing(self):
        with mock.patch.object(wiring.Sheet, "dot", lambda *_: None):
            self.assertNotEqual(nets_of(wiring.draw(TWO + "wire a.2 b.1 b.2 b.3\n")), [("a.2", "b.1", "b.2", "b.3")])

    def test_a_dot_too_many(self):
        crossed = SHIFTED + "wire a.1 b.3\nwire a.2 b.2\n"
        drawn = wiring.Sheet.wire

        def dotted(sheet, net, x1, y1, x2, y2):
            drawn(sheet, net, x1, y1, x2, y2)
            for other in sheet.segments:
                if y1 == y2 and not other.level and min(x1, x2) < other.x1 < max(x1, x2) and other.y1 < y1 < other.y2:
                    sheet.dot(other.x1, y1)
        with mock.patch.object(wiring.Sheet, "wire", dotted):
            self.assertEqual(nets_of(wiring.draw(crossed)), [("a.1", "a.2", "b.2", "b.3")])
        self.assertEqual(nets_of(wiring.draw(crossed)), [("a.1", "b.3"), ("a.2", "b.2")])

    def test_lanes_on_each_other(self):
        with mock.patch.object(wiring, "LANE", 0):
            self.assertIn("two wires lie on each other", error_of(SHIFTED + "wire a.1 b.2\nwire a.2 b.3\n"))

    def test_lanes_in_the_wrong_order(self):
        with mock.patch.object(wiring, "in_order", lambda drawing, wires: wires):
            self.assertIn("two wires lie on each other", error_of(TWO + "wire a.1 b.2\nwire a.2 b.3\n"))


class Refusals(unittest.TestCase):
    def test_what_an_eye_could_not_tell_apart(self):
        self.assertIn("C1: a wire lies on it", error_of(TWO + 'wire a.1 down C "C1" GND b.1\nwire a.2 b.2\n'))
        self.assertIn("lies on it", error_of(TWO + 'wire a.1 down R "R1" GND b.1\nwire a.2 up R "R2" "+5 V" b.2\n'))
        self.assertIn("parts need", error_of(TWO + 'wire a.1 R "1 kΩ" R "1 kΩ" R "1 kΩ" b.1\n'))
        self.assertIn("would change places", error_of(TWO + "wire a.1 b.2\nwire a.2 b.1\n"))
        self.assertIn("do not face the same gap", error_of(TWO + 'column\nbox c "C"\n< 1 "one"\nwire a.1 c.1\n'))

    def test_what_cannot_be_read(self):
        for source, said in (("wire a.1 b.9\n", "line 10: no pin b.9"), ("wire a.1\n", "line 10: a wire needs an end"),
                             ("wire a.1 b.1 GND\n", "line 10: a wire ends at pins or at one symbol"),
                             ('wire a.1 down Q "x" GND b.1\n', "line 10: no part Q"), ("lamp\n", "line 10: lamp: not one of"),
                             ('< 1 "again"\n', "line 10: pin b.1 twice"), ('wire a.1 R "x b.1\n', "line 10: cannot be read"),
                             ('wire a.1 R\n', "line 10: cannot be read")):
            self.assertIn(said, error_of(TWO.lstrip("\n") + source), source)
        self.assertIn("column 3 has no box", error_of(TWO + "column\n"))

    def test_labels_take_the_places_of_a_board(self):
        svg = wiring.draw(TWO, lambda label: label.replace("one", "GP0 & <J1>"))
        self.assertIn(">GP0 &amp; &lt;J1&gt;</text>", svg)


if __name__ == "__main__":
    unittest.main()
