"""Mutation operators: for a node of the syntax tree, the texts that replace it in mutants.

They imitate typing mistakes: another operator, a forgotten operand, a constant off by one, a neighbouring bit, a
negated or stuck condition. A change that another operator makes, too, is left out.
"""

import re
from dataclasses import dataclass, field
from typing import Dict, List, Optional, Set

BINARY = {
    "BinaryAndExpression": ("&", ["|"], "both"),
    "BinaryOrExpression": ("|", ["&"], "both"),
    "BinaryXorExpression": ("^", ["|", "&"], "both"),
    "LogicalAndExpression": ("&&", ["||"], "both"),
    "LogicalOrExpression": ("||", ["&&"], "both"),
    "AddExpression": ("+", ["-"], "both"),
    "SubtractExpression": ("-", ["+"], "left"),
    "LogicalShiftLeftExpression": ("<<", [">>"], "left"),
    "LogicalShiftRightExpression": (">>", ["<<"], "left"),
    "EqualityExpression": ("==", ["!="], ""),
    "InequalityExpression": ("!=", ["=="], ""),
    "LessThanExpression": ("<", ["<=", ">="], ""),
    "LessThanEqualExpression": ("<=", ["<", ">"], ""),
    "GreaterThanExpression": (">", [">=", "<="], ""),
    "GreaterThanEqualExpression": (">=", [">", "<"], ""),
}
# The mutants of these operators include the negation, so a condition of this form needs no mutant for it.
COMPARISONS = {kind for kind, (_, _, operands) in BINARY.items() if not operands}
NEGATIONS = {"UnaryBitwiseNotExpression": "~", "UnaryLogicalNotExpression": "!", "UnaryMinusExpression": "-"}
REDUCTIONS = {"UnaryBitwiseAndExpression": ("&", "|"), "UnaryBitwiseOrExpression": ("|", "&"),
              "UnaryBitwiseXorExpression": ("^", "|")}

LITERAL = re.compile(r"(\d+)\s*'\s*([sS]?)([bBdDhHoO])\s*([0-9a-fA-F_]+)$")
LOWEST_BIT = "1'b1"
BYTES_OF_A_REGISTER = "12'd4"
BASES = {"b": 2, "o": 8, "d": 10, "h": 16}
FORMATS = {"b": "b", "o": "o", "d": "d", "h": "X"}


@dataclass
class Alternative:
    """A text that replaces a node."""

    kind: str
    text: str


@dataclass
class Names:
    """The declarations of a module that decide which mutants are legal."""

    constants: Set[str] = field(default_factory=set)  # parameters
    members: Dict[str, List[str]] = field(default_factory=dict)  # enumeration constant: all of its type
    enumerated: Set[str] = field(default_factory=set)  # variables of an enumeration
    top_bit: Dict[str, int] = field(default_factory=dict)  # of a vector declared with a literal range [n:0]


def kind_of(node):
    return node.kind.name


def unwrapped(node):
    while kind_of(node) == "ParenthesizedExpression":
        node = node.expression
    return node


def binary(node, text_of) -> List[Alternative]:
    operator, others, operands = BINARY[kind_of(node)]
    left, right = text_of(node.left), text_of(node.right)
    result = [Alternative("operator", f"{left} {other} {right}") for other in others]
    if operands:
        result.append(Alternative("operand", left))
    if operands == "both":
        result.append(Alternative("operand", right))
    return result


def unary(node, text_of) -> List[Alternative]:
    operand = text_of(node.operand)
    if kind_of(node) in NEGATIONS:
        return [Alternative("negation", operand)]
    return [Alternative("operator", REDUCTIONS[kind_of(node)][1] + operand)]


def condition(node, text_of) -> List[Alternative]:
    """The condition of an if statement or of a conditional operator."""
    inner = kind_of(unwrapped(node))
    result = []
    if inner not in COMPARISONS and inner not in NEGATIONS:
        result.append(Alternative("negation", f"!({text_of(node)})"))
    return result + [Alternative("stuck", "1'b0"), Alternative("stuck", "1'b1")]


def literal(text: str) -> List[Alternative]:
    text = text.strip()
    if text in ("'0", "'1"):
        return [Alternative("constant", "'1" if text == "'0" else "'0")]
    if text.isdigit():
        value = int(text)
        return [Alternative("constant", str(other)) for other in (value + 1, value - 1) if other >= 0]
    match = LITERAL.match(text)
    if not match:
        return []
    width, sign, base, digits = int(match[1]), match[2], match[3].lower(), match[4].replace("_", "")
    value = int(digits, BASES[base])
    others = sorted({(value + 1) % (1 << width), (value - 1) % (1 << width)} - {value})
    return [Alternative("constant", f"{width}'{sign}{base}{other:{FORMATS[base]}}") for other in others]


def constant(text: str) -> Alternative:
    """A named constant, or bits of one: the lowest bit that has an effect. The two lowest bits of a register's byte
    address select nothing, because registers are words."""
    is_address = re.fullmatch(r"(\w+::)?ADDR_\w+", text)
    return Alternative("constant", f"({text} ^ {BYTES_OF_A_REGISTER if is_address else LOWEST_BIT})")


def name(text: str, names: Names, is_value: bool) -> List[Alternative]:
    """A plain name. A name used as a value (`is_value`) is inverted, unless an operator around it has that mutant
    already."""
    if text in names.members:
        all_of_it = names.members[text]
        return [Alternative("constant", all_of_it[(all_of_it.index(text) + 1) % len(all_of_it)])]
    if text in names.constants:
        return [constant(text)]
    if is_value and text not in names.enumerated:
        return [Alternative("inverted", f"~{text}")]
    return []


def select(node, names: Names, text_of, is_value: bool) -> List[Alternative]:
    """A bit-select or part-select: its neighbours."""
    identifier, text = node.identifier.valueText, text_of(node)
    if identifier in names.constants:
        return [constant(text)]
    result = [Alternative("inverted", f"~{text}")] if is_value else []
    selectors = list(node.selectors)
    if len(selectors) == 1 and identifier in names.top_bit:
        bounds = literal_bounds(selectors[0].selector)
        if bounds:
            high, low = bounds
            for shift in (1, -1):
                if 0 <= low + shift and high + shift <= names.top_bit[identifier]:
                    place = f"{high + shift}:{low + shift}" if high != low else f"{high + shift}"
                    result.append(Alternative("neighbour", f"{identifier}[{place}]"))
    return result


def literal_bounds(selector) -> Optional[tuple]:
    """(high, low) of a selector that consists of plain numbers, else None."""
    kind = kind_of(selector) if selector is not None else ""
    if kind == "BitSelect":
        parts = [selector.expr, selector.expr]
    elif kind == "SimpleRangeSelect":
        parts = [selector.left, selector.right]
    else:
        return None
    texts = [str(part).strip() for part in parts]
    return (int(texts[0]), int(texts[1])) if all(text.isdigit() for text in texts) else None
