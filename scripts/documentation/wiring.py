"""Wiring drawings of a page, from the text of a ```wiring fence to SVG. One line of text is one of

    column [GAP]                  a further column of boxes, GAP pixels right of the one before (160)
    box NAME "TITLE" ["SECOND"]   a box in it, below the one before
    < PIN "LABEL"                 its next row: a pin on the left,
    > PIN "LABEL"                 a pin on the right,
    < PIN "LABEL" > PIN "LABEL"   or both;
    -                             or an empty row
    led PIN PIN                   inside, between two pins of the left: the resistor and the LED of an optocoupler,
    contact PIN PIN               or a contact that opens
    wire BOX.PIN PART ... BOX.PIN [BOX.PIN ...]
                                  a net between two columns, its parts in line from the first pin
    wire BOX.PIN PART ... GND     or one that ends in a symbol: GND, or a supply as "+5 V"

PART is R "TEXT", NC "TEXT" (a contact that opens), NO "TEXT", FUSE "TEXT", or hangs off the wire: `up R "TEXT" "+3.3 V"` or
`down C "TEXT" GND`. In a label @BOARD.SIGNAL gives the place of the pin in boards/BOARD/board.toml. Lengths are pixels.

A drawing that would be unclear is an error: wires of two nets on each other, parts on wires or boxes, an unknown
pin."""
import shlex
from dataclasses import dataclass, field

ROW, TITLE, MARGIN, GAP, LANE = 28, 34, 20, 160, 14
LETTER = 6.3  # pixels per letter of a label, an upper bound of the average
PART_LENGTH, HANGING = 54, 36  # pixels of the wire that a part in line, or a hanging part without its text, occupies
PARTS = {"R", "C", "NC", "NO", "FUSE"}


class WiringError(Exception):
    """An error in a drawing, with the line of the source if there is one."""


@dataclass
class Pin:
    name: str  # "BOX.PIN"
    label: str
    side: str  # "left" or "right"
    row: int
    x: float = 0
    y: float = 0


@dataclass
class Box:
    name: str
    titles: list
    column: int
    pins: list = field(default_factory=list)
    inside: list = field(default_factory=list)  # ("led" or "contact", names of its two pins)
    rows: int = 0
    x: float = 0
    y: float = 0
    width: float = 0

    @property
    def top(self):
        return TITLE + 14 * (len(self.titles) - 1)

    @property
    def height(self):
        return self.top + ROW * self.rows


@dataclass
class Part:
    kind: str
    text: str
    hangs: str = ""  # "up", "down", or "" in line
    end: str = ""  # symbol at the end of a hanging part


@dataclass
class Wire:
    line: int
    pins: list  # names; the parts come after the first pin
    parts: list
    end: str = ""  # symbol at the end of a wire without a second pin
    lane: float = None


@dataclass
class Drawing:
    gaps: list = field(default_factory=list)
    boxes: dict = field(default_factory=dict)
    pins: dict = field(default_factory=dict)
    wires: list = field(default_factory=list)


# --- reading


def read_pins(drawing, words, places):
    """Reads a row of the current box."""
    box = list(drawing.boxes.values())[-1]
    while words:
        side, name, label, *words = words
        pin = Pin(f"{box.name}.{name}", places(label), {"<": "left", ">": "right"}[side], box.rows)
        if pin.name in drawing.pins:
            raise WiringError(f"pin {pin.name} twice")
        drawing.pins[pin.name] = pin
        box.pins.append(pin)
    box.rows += 1


def read_part(words):
    """The part at the beginning of the words, and the words after it."""
    hangs = words.pop(0) if words[0] in ("up", "down") else ""
    kind, text = words.pop(0), words.pop(0)
    if kind not in PARTS:
        raise WiringError(f"no part {kind}: {', '.join(sorted(PARTS))}")
    return Part(kind, text, hangs, words.pop(0) if hangs else ""), words


def read_wire(drawing, line, words):
    first, *words = words
    parts = []
    while words and (words[0] in PARTS or words[0] in ("up", "down")):
        part, words = read_part(words)
        parts.append(part)
    if not words:
        raise WiringError("a wire needs an end")
    ends = [word for word in words if word == "GND" or word.startswith("+")]
    pins = [first, *(word for word in words if word not in ends)]
    unknown = [name for name in pins if name not in drawing.pins]
    if unknown:
        raise WiringError(f"no pin {unknown[0]}")
    if len(ends) + (len(pins) > 1) != 1:
        raise WiringError("a wire ends at pins or at one symbol")
    drawing.wires.append(Wire(line, pins, parts, ends[0] if ends else ""))


def read_line(drawing, line, words, places):
    kind, *rest = words
    if kind == "column":
        drawing.gaps.append(int(rest[0]) if rest else GAP)
    elif kind == "box":
        name, *titles = rest
        if not drawing.gaps:
            drawing.gaps.append(GAP)
        drawing.boxes[name] = Box(name, titles, len(drawing.gaps) - 1)
    elif kind in "<>":
        read_pins(drawing, words, places)
    elif kind == "-":
        list(drawing.boxes.values())[-1].rows += 1
    elif kind in ("led", "contact"):
        box = list(drawing.boxes.values())[-1]
        names = [f"{box.name}.{name}" for name in rest]
        if len(names) != 2 or any(drawing.pins[name].side != "left" for name in names):
            raise WiringError(f"{kind}: needs two pins of the left")
        box.inside.append((kind, names))
    elif kind == "wire":
        read_wire(drawing, line, rest)
    else:
        raise WiringError(f"{kind}: not one of column, box, <, >, -, led, contact, wire")


def read(source, places):
    """The drawing that the text describes. `places` resolves the pins in a label."""
    drawing = Drawing()
    for line, text in enumerate(source.splitlines(), 1):
        try:
            words = shlex.split(text, comments=True)
            if words:
                read_line(drawing, line, words, places)
        except WiringError as error:
            raise WiringError(f"line {line}: {error}") from error
        except (ValueError, IndexError, KeyError) as error:
            raise WiringError(f"line {line}: cannot be read: {text.strip()}") from error
    return drawing


# --- placing


def room_for(part):
    """Length, in pixels, that a part occupies on the horizontal segment of its wire."""
    return HANGING + width_of(part.text) if part.hangs else max(PART_LENGTH, width_of(part.text) + 10)


def width_of(text, letter=LETTER):
    return len(text) * letter


def place_boxes(drawing):
    """Places columns from left to right, each as wide as its widest box, and the pins on the edges of the boxes."""
    x = MARGIN
    for column, gap in enumerate(drawing.gaps):
        boxes = [box for box in drawing.boxes.values() if box.column == column]
        if not boxes:
            raise WiringError(f"column {column + 1} has no box")
        x += gap if column else 0
        width, y = max(width_of_box(box) for box in boxes), MARGIN
        for box in boxes:
            box.x, box.y, box.width = x, y, width
            y += box.height + ROW
            for pin in box.pins:
                pin.x = x if pin.side == "left" else x + width
                pin.y = box.y + box.top + ROW * pin.row + ROW / 2
        x += width


def width_of_box(box):
    sides = {side: max((width_of(pin.label) for pin in box.pins if pin.side == side), default=0) for side in ("left", "right")}
    needed = sides["left"] + sides["right"] + 24 + (100 if box.inside else 0)
    return max(needed, *(width_of(title, 7.6) + 20 for title in box.titles), 80)


def gap_of(drawing, wire):
    """The index of the gap that has the wire: gap N is to the right of column N."""
    gaps = set()
    for name in wire.pins:
        pin = drawing.pins[name]
        gaps.add(drawing.boxes[name.split(".")[0]].column - (pin.side == "left"))
    if len(gaps) > 1:
        raise WiringError(f"line {wire.line}: the pins do not face the same gap between two columns")
    return gaps.pop()


def stubs(drawing, wire, side):
    """The heights of a wire's pins on that side of its gap."""
    return {drawing.pins[name].y for name in wire.pins if drawing.pins[name].side != side}


def in_order(drawing, wires):
    """The wires in the order of their lanes from the left. If horizontal segments of two wires have the same height,
    the wire that comes from the left turns off first."""
    before = {id(b): [a for a in wires if a is not b and stubs(drawing, a, "left") & stubs(drawing, b, "right")] for b in wires}
    order = []
    while len(order) < len(wires):
        ready = [wire for wire in wires if wire not in order and all(other in order for other in before[id(wire)])]
        if not ready:
            left = next(wire for wire in wires if wire not in order)
            raise WiringError(f"line {left.line}: this wire and another would change places; move a pin by a row")
        order.append(ready[0])
    return order


def place_lanes(drawing):
    """Places a vertical segment for each net that needs one, near its last pins, so that parts have room near the first
    pin."""
    groups = {}
    for wire in drawing.wires:
        gap, pins = gap_of(drawing, wire), [drawing.pins[name] for name in wire.pins]
        if len(pins) > 1 and len({pin.y for pin in pins}) > 1:
            groups.setdefault((gap, pins[1].side), []).append(wire)
    for (_, side), wires in groups.items():
        edge = drawing.pins[wires[0].pins[1]].x
        for number, wire in enumerate(in_order(drawing, wires)):
            # In a net between pins of one side, the parts lie between the first pin and the lane.
            out = sum(map(room_for, wire.parts)) if all(drawing.pins[name].side == side for name in wire.pins) else 0
            wire.lane = edge + 10 + LANE * number + out if side == "right" else edge - 10 - LANE * (len(wires) - 1 - number) - out


# --- drawing


@dataclass(frozen=True)
class Segment:
    net: int
    x1: float
    y1: float
    x2: float
    y2: float

    @property
    def level(self):
        return self.y1 == self.y2


@dataclass(frozen=True)
class Area:
    """An area that no other wire and no other part may touch."""
    net: int
    what: str
    x1: float
    y1: float
    x2: float
    y2: float


class Sheet:
    """The SVG under construction, with the segments and areas that must not touch each other."""

    def __init__(self):
        self.texts, self.segments, self.areas = [], [], []
        self.left, self.right, self.bottom = 0, 0, 0

    def reach(self, left, right, bottom):
        """Enlarges the sheet to contain these bounds with a margin."""
        self.left, self.right = min(self.left, left - MARGIN), max(self.right, right + MARGIN)
        self.bottom = max(self.bottom, bottom + MARGIN)

    def add(self, text):
        self.texts.append(text)

    def wire(self, net, x1, y1, x2, y2):
        if (x1, y1) != (x2, y2):
            self.segments.append(Segment(net, x1, y1, x2, y2))
            self.reach(min(x1, x2), max(x1, x2), max(y1, y2))
            self.add(f'<line class="wire" x1="{x1:g}" y1="{y1:g}" x2="{x2:g}" y2="{y2:g}"/>')

    def dot(self, x, y):
        self.add(f'<circle class="dot" cx="{x:g}" cy="{y:g}" r="3"/>')

    def label(self, x, y, text, anchor="middle", kind="label"):
        escaped = text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
        self.add(f'<text class="{kind}" x="{x:g}" y="{y:g}" text-anchor="{anchor}">{escaped}</text>')

    def area(self, net, what, x, y, width, height):
        self.reach(x - width / 2, x + width / 2, y + height / 2)
        self.areas.append(Area(net, what, x - width / 2, y - height / 2, x + width / 2, y + height / 2))


def draw_body(sheet, kind, x, y, upright):
    """Draws a part's symbol around (x, y), 30 pixels long, without the wires to its ends."""
    turned = f' transform="rotate(90 {x:g} {y:g})"' if upright else ""
    bodies = {
        "R": f'<rect x="{x - 15:g}" y="{y - 5:g}" width="30" height="10"/>',
        "FUSE": f'<rect x="{x - 15:g}" y="{y - 5:g}" width="30" height="10"/><path d="M{x - 15:g} {y:g}h30"/>',
        "C": f'<path d="M{x - 15:g} {y:g}h12m0 -9v18m6 -18v18m0 -9h12"/>',
        # Contacts are drawn at rest: one that opens is drawn closed.
        "NC": f'<path d="M{x - 15:g} {y:g}h5l21 -6m-1 -5v11m0 0h5"/>',
        "NO": f'<path d="M{x - 15:g} {y:g}h5l19 -9m1 9h5"/>',
    }
    sheet.add(f'<g class="part"{turned}>{bodies[kind]}</g>')


def draw_end(sheet, net, end, x, y, way):
    """Draws the symbol of ground or of a supply at the end of a wire; `way` is the wire's direction towards the
    symbol."""
    if end == "GND":
        sheet.add(f'<path class="part" d="M{x - 9:g} {y:g}h18m-15 4h12m-9 4h6"/>' if way == "down" else
                  f'<path class="part" d="M{x:g} {y:g}v6m-9 0h18m-15 4h12m-9 4h6"/>')
        sheet.area(net, "GND", x, y + 6, 18, 12)
        return
    upright = way in ("up", "down")
    sheet.add(f'<path class="part" d="M{x - 9:g} {y:g}h18"/>' if upright else f'<path class="part" d="M{x:g} {y - 9:g}v18"/>')
    dx, dy, anchor = {"up": (0, -5, "middle"), "down": (0, 13, "middle"), "right": (7, 4, "start"), "left": (-7, 4, "end")}[way]
    sheet.label(x + dx, y + dy, end, anchor)
    if upright:
        sheet.area(net, end, x, y + dy - 4, width_of(end), 12)
    else:
        sheet.area(net, end, x + dx * (1 + width_of(end) / 14), y, width_of(end), 12)


def draw_hanging(sheet, net, part, x, y):
    """Draws a part that hangs off the wire at (x, y), with the symbol at its end."""
    way = 1 if part.hangs == "down" else -1
    sheet.dot(x, y)
    sheet.wire(net, x, y, x, y + way * 7)
    draw_body(sheet, part.kind, x, y + way * 22, True)
    sheet.wire((net, x), x, y + way * 37, x, y + way * 42)
    sheet.area(net, part.text, x, y + way * 25, 24, 34)
    sheet.label(x + 13, y + way * 22 + 4, part.text, "start")
    sheet.area(net, part.text, x + 14 + width_of(part.text) / 2, y + way * 22, width_of(part.text), 12)
    draw_end(sheet, net, part.end, x, y + way * 42, part.hangs)


def draw_level(sheet, net, wire, x1, x2, y):
    """Draws the horizontal segment from the first pin at x1 to x2, with the wire's parts spread over it. A part in line
    separates two nets; returns the last one."""
    way, needed = 1 if x2 > x1 else -1, sum(map(room_for, wire.parts))
    if needed > abs(x2 - x1):
        raise WiringError(f"line {wire.line}: parts need {needed:.0f} pixels, there are {abs(x2 - x1):.0f}")
    # The spare length is spread evenly.
    spare, at, here, number = (abs(x2 - x1) - needed) / (len(wire.parts) or 1), 0, x1, 0
    for part in wire.parts:
        # A hanging part has its text on its right.
        room = room_for(part) + spare
        x = x1 + way * (at + (room / 2 if not part.hangs else spare / 2 + (16 if way > 0 else room - spare - 16)))
        at += room
        if part.hangs:
            draw_hanging(sheet, (net, number), part, x, y)
            continue
        sheet.wire((net, number), here, y, x - way * 15, y)
        draw_body(sheet, part.kind, x, y, False)
        sheet.area((net, number), part.text, x, y, 28, 16)
        sheet.label(x, y - 9 if part.kind in ("R", "FUSE") else y - 14, part.text)
        here, number = x + way * 15, number + 1
    sheet.wire((net, number), here, y, x2, y)
    return (net, number)


def draw_wire(sheet, drawing, net, wire):
    pins = [drawing.pins[name] for name in wire.pins]
    first, y = pins[0], pins[0].y
    if wire.end:
        way = 1 if first.side == "right" else -1
        x = first.x + way * (sum(map(room_for, wire.parts)) + 18)
        draw_end(sheet, draw_level(sheet, net, wire, first.x, x, y), wire.end, x, y, "right" if way > 0 else "left")
        return
    if wire.lane is None:
        if len(pins) > 2:
            raise WiringError(f"line {wire.line}: more than two pins at one height")
        draw_level(sheet, net, wire, first.x, pins[1].x, y)
        return
    last = draw_level(sheet, net, wire, first.x, wire.lane, y)
    heights = sorted({pin.y for pin in pins})
    sheet.wire(last, wire.lane, heights[0], wire.lane, heights[-1])
    for pin in pins[1:]:
        sheet.wire(last, wire.lane, pin.y, pin.x, pin.y)
    for height in heights:
        touching = sum(pin.y == height for pin in pins) + (height != heights[0]) + (height != heights[-1])
        if touching > 2:
            sheet.dot(wire.lane, height)


def draw_led(sheet, box, pins):
    """Inside a box: draws a resistor and an LED from the upper pin to the lower one."""
    x, top, bottom = box.x + width_of(max((pin.label for pin in pins), key=len)) + 52, pins[0].y, pins[1].y
    middle = (top + bottom) / 2
    sheet.add(f'<path class="part" d="M{box.x + width_of(pins[0].label) + 14:g} {top:g}H{x - 26:g}m20 0H{x + 18:g}V{middle - 6:g}'
              f'm-7 0h14l-7 12zm0 12h14M{x + 18:g} {middle + 6:g}V{bottom:g}H{box.x + width_of(pins[1].label) + 14:g}"/>')
    sheet.add(f'<rect class="part" x="{x - 26:g}" y="{top - 5:g}" width="20" height="10"/>')
    sheet.add(f'<path class="part" d="M{x + 29:g} {middle - 5:g}l8 -5m-4 0h4v4M{x + 29:g} {middle + 3:g}l8 -5m-4 0h4v4"/>')


def draw_contact(sheet, box, pins):
    """Inside a box: a contact that opens, drawn at rest."""
    (upper, lower), x = pins, box.x + width_of(max((pin.label for pin in pins), key=len)) + 40
    middle = (upper.y + lower.y) / 2
    sheet.add(f'<path class="part" d="M{box.x + width_of(upper.label) + 14:g} {upper.y:g}H{x:g}V{middle - 12:g}h9'
              f'M{x + 7:g} {middle - 16:g}L{x:g} {middle + 12:g}V{lower.y:g}H{box.x + width_of(lower.label) + 14:g}"/>')


def draw_box(sheet, drawing, box):
    sheet.reach(box.x, box.x + box.width, box.y + box.height)
    sheet.add(f'<rect class="box" x="{box.x:g}" y="{box.y:g}" width="{box.width:g}" height="{box.height:g}" rx="4"/>')
    for number, title in enumerate(box.titles):
        sheet.label(box.x + box.width / 2, box.y + 18 + 14 * number, title, kind="title" if number == 0 else "second")
    for pin in box.pins:
        way, anchor = (1, "start") if pin.side == "left" else (-1, "end")
        sheet.add(f'<circle class="pin" data-pin="{pin.name}" cx="{pin.x:g}" cy="{pin.y:g}" r="2.5"/>')
        sheet.label(pin.x + way * 9, pin.y + 4, pin.label, anchor)
    for kind, names in box.inside:
        (draw_led if kind == "led" else draw_contact)(sheet, box, [drawing.pins[name] for name in names])


# --- checks


def overlaps(a, b):
    """Whether two segments lie on each other over some length."""
    if a.level != b.level:
        return False
    if a.level:
        return a.y1 == b.y1 and min(max(a.x1, a.x2), max(b.x1, b.x2)) > max(min(a.x1, a.x2), min(b.x1, b.x2))
    return a.x1 == b.x1 and min(max(a.y1, a.y2), max(b.y1, b.y2)) > max(min(a.y1, a.y2), min(b.y1, b.y2))


def meets(a, b):
    """Whether a segment enters an area."""
    return (min(a.x1, a.x2) < b.x2 and max(a.x1, a.x2) > b.x1 and min(a.y1, a.y2) < b.y2 and max(a.y1, a.y2) > b.y1)


def check(sheet, drawing):
    """Raises WiringError when a reader could take two nets for one, or one part for another."""
    for number, a in enumerate(sheet.segments):
        for b in sheet.segments[number + 1:]:
            if a.net != b.net and overlaps(a, b):
                raise WiringError(f"two wires lie on each other at ({a.x1:g}, {a.y1:g})")
    boxes = [Area(None, box.name, box.x, box.y, box.x + box.width, box.y + box.height) for box in drawing.boxes.values()]
    for area in [*sheet.areas, *boxes]:
        crossing = [s for s in sheet.segments if meets(s, area) and (area.net is None or owner(s.net) != owner(area.net))]
        touching = [other for other in sheet.areas if other is not area and meets(other, area)]
        if crossing or touching:
            raise WiringError(f"{area.what}: a {'wire' if crossing else 'part'} lies on it")


def owner(net):
    """The wire of the description that a net belongs to."""
    while isinstance(net, tuple):
        net = net[0]
    return net


STYLE = ("text{font:12px Helvetica,Arial,sans-serif;fill:#222}.title{font-weight:bold}.second{fill:#555;font-size:11px}"
         ".box{fill:#eef3fa;stroke:#44628c}.wire,.part{stroke:#333;fill:none;stroke-width:1.3}.part rect{fill:#fff}"
         ".dot,.pin{fill:#333}")


def draw(source, places=lambda label: label):
    """The SVG of a description; raises WiringError."""
    drawing, sheet = read(source, places), Sheet()
    place_boxes(drawing)
    place_lanes(drawing)
    for box in drawing.boxes.values():
        draw_box(sheet, drawing, box)
    for net, wire in enumerate(drawing.wires):
        draw_wire(sheet, drawing, net, wire)
    check(sheet, drawing)
    width = sheet.right - sheet.left
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}" height="{sheet.bottom:g}" '
            f'viewBox="{sheet.left:g} 0 {width:g} {sheet.bottom:g}"><style>{STYLE}</style>'
            f'<rect x="{sheet.left:g}" width="{width:g}" height="{sheet.bottom:g}" fill="white"/>{"".join(sheet.texts)}</svg>\n')
