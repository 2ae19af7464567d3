"""Writes a copy of the RTL that holds every mutant behind a run-time selector.

A process, a continuous assignment or a function's statement is a group. The copy has each group twice: unchanged, and
with its mutants. Only the group of the chosen mutant runs the second form, so the copy with mutant 0, the sound design,
is nearly as fast as the design itself.
"""

import argparse
import hashlib
import json
import re
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import List

from pyslang import syntax

from . import operators
from .operators import Alternative, Names, kind_of

MEMBER_BITS = 16
PROCESSES = {"AlwaysFFBlock", "AlwaysCombBlock", "AlwaysBlock"}
ASSIGNMENTS = {"NonblockingAssignmentExpression", "AssignmentExpression"}
# Calls that are evaluated at elaboration.
CONSTANT_CALLS = {"$clog2", "$bits"}
# Places that need a constant: parameters, ranges, generate conditions. A function called there cannot ask for the
# mutant.
CONSTANT_PLACES = {"ParameterDeclaration", "ParameterValueAssignment", "RangeDimensionSpecifier", "IfGenerate",
                   "LoopGenerate"}

# The chosen mutant: its group and its place in the group; 0 is the sound design. Each module declares them, because a
# package would change the class that Verilator writes. That class must equal the sound design's, because the tests are
# compiled against it once.
SELECTOR = """
  import "DPI-C" function int trammel_mutant();
  int mutant_number = trammel_mutant();
  int mutant_group = trammel_mutant() >>> {bits};
  int mutant_member = trammel_mutant() & ((1 << {bits}) - 1);
"""


@dataclass
class Mutant:
    """One mutant. `original` and `mutated` are the whole assignment, condition, label or connection."""

    id: str
    number: int
    module: str
    file: str
    line: int
    kind: str
    original: str
    mutated: str
    nth: int  # number among the mutants of the module with equal texts, from 1


def nodes(root):
    """All syntax nodes below and with `root`, in the order of the text."""
    yield root
    for child in root:
        if isinstance(child, syntax.SyntaxNode):
            yield from nodes(child)


def children(node):
    return [child for child in node if isinstance(child, syntax.SyntaxNode)]


def names_of(module) -> Names:
    names = Names()
    types = {}
    for node in nodes(module):
        kind = kind_of(node)
        if kind == "ParameterDeclaration":
            names.constants |= {declarator.name.valueText for declarator in declarators(node)}
        elif kind == "GenvarDeclaration":
            names.constants |= {str(child).strip() for child in children(node)}
        elif kind == "LoopGenerate":
            names.constants.add(node.identifier.valueText)
        elif kind == "TypedefDeclaration" and kind_of(node.type) == "EnumType":
            members = [declarator.name.valueText for declarator in declarators(node.type)]
            types[node.name.valueText] = members
            names.members.update({member: members for member in members})
    for node in nodes(module):
        kind = kind_of(node)
        if kind in ("DataDeclaration", "ImplicitAnsiPort"):
            data_type = node.type if kind == "DataDeclaration" else getattr(node.header, "dataType", None)
            for declarator in declarators(node):
                note_variable(names, types, declarator, data_type)
    return names


def declarators(node):
    return [child for child in nodes(node) if kind_of(child) == "Declarator"]


def note_variable(names, types, declarator, data_type):
    variable = declarator.name.valueText
    if data_type is None:
        return
    if kind_of(data_type) == "NamedType":
        if str(data_type).strip() in types:
            names.enumerated.add(variable)
        return
    bounds = re.findall(r"\[\s*(\d+)\s*:\s*0\s*\]", str(data_type))
    # Exactly one packed dimension, and no unpacked one.
    if len(bounds) == 1 and str(data_type).count("[") == 1 and "[" not in str(declarator):
        names.top_bit[variable] = int(bounds[0])


class Instrumenter:
    """One source file."""

    def __init__(self, text: str, file: str, first_group: int):
        self.text = text
        self.file = file
        self.group = first_group - 1
        self.mutants: List[Mutant] = []
        # Offsets count bytes. Only comments have characters outside ASCII, and replacing each of their bytes by "?"
        # keeps offsets.
        self.tree = syntax.SyntaxTree.fromText("".join(c if c.isascii() else "?" for c in text))
        self.seen = {}

    # --- text of nodes ---
    def span(self, node):
        extent = node.sourceRange
        return extent.start.offset, extent.end.offset

    def plain(self, node) -> str:
        start, end = self.span(node)
        return self.text[start:end]

    def replaced(self, node, parts) -> str:
        """The node's text with some parts, (node, text), replaced by other texts."""
        start, end = self.span(node)
        result, position = "", start
        for part, text in parts:
            part_start, part_end = self.span(part)
            result += self.text[position:part_start] + text
            position = part_end
        return result + self.text[position:end]

    # --- mutants ---
    def begin_group(self):
        self.group += 1
        self.member = 0

    def add(self, node, alternative: Alternative, whole: str = None) -> int:
        """Adds a mutant, `alternative` in place of `node` within the current construct; returns its number."""
        self.member += 1
        start, end = self.span(node)
        first, last = self.construct
        original = self.prefix + self.text[first:last]
        mutated = whole if whole is not None else (
            self.prefix + self.text[first:start] + alternative.text + self.text[end:last])
        original, mutated = (" ".join(text.split()) for text in (original, mutated))
        key = (self.module, original, mutated)
        nth = self.seen[key] = self.seen.get(key, 0) + 1
        digest = hashlib.sha1("\n".join((*key, str(nth))).encode()).hexdigest()[:8]
        number = (self.group << MEMBER_BITS) + self.member
        self.mutants.append(Mutant(id=f"{self.module}-{digest}", number=number, module=self.module, file=self.file,
                                   line=self.text.count("\n", 0, start) + 1, kind=alternative.kind,
                                   original=original, mutated=mutated, nth=nth))
        return number

    def selected(self, number: int) -> str:
        if self.alone:
            return f"mutant_number == {number}"
        return f"mutant_member == {number & ((1 << MEMBER_BITS) - 1)}"

    def chosen(self, node, alternatives: List[Alternative], text: str) -> str:
        """`text`, the node with the mutants inside it, or one of the alternatives."""
        if not alternatives:
            return text
        choices = "".join(f"{self.selected(self.add(node, a))} ? ({a.text}) : " for a in alternatives)
        return f"({choices}({text}))"

    # --- expressions ---
    def expression(self, node, is_value: bool) -> str:
        kind = kind_of(node)
        if kind == "ParenthesizedExpression":
            return self.replaced(node, [(node.expression, self.expression(node.expression, is_value))])
        if kind in ("SimplePropertyExpr", "SimpleSequenceExpr", "OrderedArgument"):
            return self.replaced(node, [(child, self.expression(child, is_value)) for child in children(node)])
        if kind in operators.BINARY:
            alternatives = operators.binary(node, self.plain)
            parts = [(part, self.expression(part, False)) for part in (node.left, node.right)]
            return self.chosen(node, alternatives, self.replaced(node, parts))
        if kind in operators.NEGATIONS or kind in operators.REDUCTIONS:
            alternatives = operators.unary(node, self.plain)
            return self.chosen(node, alternatives,
                               self.replaced(node, [(node.operand, self.expression(node.operand, False))]))
        if kind == "ConditionalExpression":
            return self.choice(node, is_value)
        if kind == "ConcatenationExpression":
            return self.replaced(node, [(part, self.expression(part, True)) for part in children(node)])
        if kind == "MultipleConcatenationExpression":
            return self.replaced(node, [(node.concatenation, self.expression(node.concatenation, True))])
        if kind == "CastExpression":
            return self.replaced(node, [(node.right, self.expression(node.right, is_value))])
        if kind == "InvocationExpression":
            return self.call(node)
        return self.leaf(node, kind, is_value)

    def leaf(self, node, kind, is_value) -> str:
        text = self.plain(node)
        if kind in ("IntegerVectorExpression", "IntegerLiteralExpression", "UnbasedUnsizedLiteralExpression"):
            return self.chosen(node, operators.literal(text), text)
        if kind == "IdentifierName":
            return self.chosen(node, operators.name(text, self.names, is_value), text)
        if kind == "ScopedName":
            return self.chosen(node, [operators.constant(text)], text)
        if kind == "IdentifierSelectName":
            alternatives = operators.select(node, self.names, self.plain, is_value)
            return self.chosen(node, alternatives, text)
        return text

    def choice(self, node, is_value) -> str:
        predicate = self.predicate(node.predicate)
        parts = [(node.predicate, predicate)]
        parts += [(arm, self.expression(arm, is_value)) for arm in (node.left, node.right)]
        return self.replaced(node, parts)

    def predicate(self, node) -> str:
        inner = node
        while kind_of(inner) in ("ConditionalPredicate", "ConditionalPattern"):
            inner = children(inner)[0]
        alternatives = operators.condition(inner, self.plain)
        return self.chosen(inner, alternatives, self.expression(inner, False))

    def call(self, node) -> str:
        if str(node.left).strip() in CONSTANT_CALLS or node.arguments is None:
            return self.plain(node)
        arguments = [child for child in children(node.arguments)]
        inner = self.replaced(node.arguments, [(child, self.expression(child, True)) for child in arguments])
        return self.replaced(node, [(node.arguments, inner)])

    # --- statements ---
    def statement(self, node) -> str:
        kind = kind_of(node)
        if kind == "SequentialBlockStatement":
            inner = [item for item in node.items if kind_of(item) != "DataDeclaration"]
            return self.replaced(node, [(item, self.statement(item)) for item in inner])
        if kind == "ExpressionStatement" and kind_of(node.expr) in ASSIGNMENTS:
            return self.assignment_statement(node)
        if kind == "ConditionalStatement":
            return self.conditional(node)
        if kind == "CaseStatement":
            return self.case(node)
        if kind == "ForLoopStatement":
            return self.replaced(node, [(node.statement, self.statement(node.statement))])
        return self.plain(node)

    def within(self, start, end, prefix=""):
        self.construct, self.prefix = (start, end), prefix

    def assignment(self, node) -> str:
        self.within(*self.span(node))
        return self.replaced(node, [(node.right, self.expression(node.right, True))])

    def assignment_statement(self, node) -> str:
        self.within(*self.span(node.expr))
        number = self.add(node.expr, Alternative("dropped", ""), whole="")
        return f"begin if (!({self.selected(number)})) {self.assignment(node.expr)}; end"

    def conditional(self, node) -> str:
        self.within(self.span(node)[0], node.closeParen.range.end.offset)
        parts = [(node.predicate, self.predicate(node.predicate)), (node.statement, self.statement(node.statement))]
        if node.elseClause is not None:
            clause = node.elseClause.clause
            parts.append((clause, self.statement(clause)))
        return self.replaced(node, parts)

    def case(self, node) -> str:
        self.within(self.span(node)[0], node.closeParen.range.end.offset)
        parts = [(node.expr, self.expression(node.expr, False))]
        swaps = self.swapped_labels(node)
        for item in node.items:
            if kind_of(item) == "DefaultCaseItem":
                parts.append((item.clause, self.statement(item.clause)))
                continue
            labels = [child for child in children(item) if self.span(child)[0] < self.span(item.clause)[0]]
            if len(labels) == 1 and self.span(labels[0]) in swaps:
                parts.append((labels[0], swaps[self.span(labels[0])]))
            parts.append((item.clause, self.statement(item.clause)))
        return self.replaced(node, parts)

    def swapped_labels(self, node):
        """Mutants in which a label and the next one change places; returns the instrumented text of each label, by its
        span."""
        single = []
        for item in node.items:
            if kind_of(item) == "DefaultCaseItem":
                continue
            labels = [child for child in children(item) if self.span(child)[0] < self.span(item.clause)[0]]
            if len(labels) == 1:
                single.append(labels[0])
        texts = {self.span(label): self.plain(label) for label in single}
        for label, following in zip(single, single[1:]):
            self.within(*self.span(label), prefix="case label ")
            a, b = self.plain(label), self.plain(following)
            condition = self.selected(self.add(label, Alternative("swapped", b), whole=f"case label {b}, and {a} for {b}"))
            for mine, other in ((label, b), (following, a)):
                texts[self.span(mine)] = f"({condition} ? ({other}) : {texts[self.span(mine)]})"
        return texts

    # --- members of a module ---
    def twice(self, node, instrumented: str) -> str:
        """A statement twice: unchanged, and with its mutants."""
        return (f"begin if (mutant_group != {self.group}) begin {self.plain(node)} end\n"
                f"else begin : mutated_{self.group}\n{instrumented} end end")

    def process(self, node):
        body = node.statement
        if kind_of(body) == "TimingControlStatement":
            body = body.statement
        self.begin_group()
        return body, self.twice(body, self.statement(body))

    def continuous(self, node):
        # Signals named unused... exist only for lint.
        for assignment in node.assignments:
            if kind_of(assignment) != "AssignmentExpression" or self.plain(assignment.left).startswith("unused"):
                continue
            self.begin_group()
            self.within(*self.span(assignment))
            text = self.expression(assignment.right, True)
            yield assignment.right, f"((mutant_group == {self.group}) ? {text} : ({self.plain(assignment.right)}))"

    def function(self, node):
        for item in node.items:
            if kind_of(item) != "DataDeclaration":
                self.begin_group()
                yield item, self.twice(item, self.statement(item))

    def instances(self, node):
        for instance in node.instances:
            self.begin_group()
            self.alone = True
            for connection in instance.connections:
                if kind_of(connection) == "NamedPortConnection":
                    text = self.connection(instance.decl.name.valueText, connection)
                    if text:
                        yield connection, text
            self.alone = False

    def connection(self, instance: str, node):
        """The instrumented connection of an input. Clocks get no mutants. The suffix of a port's name tells its
        direction."""
        port = node.name.valueText
        if not port.endswith("_i") or port.startswith("clk"):
            return None
        self.within(*self.span(node), prefix=f"{instance}: ")
        if node.expr is None and node.openParen.rawText != "":
            return None
        expression = node.expr
        text = self.expression(expression, False) if expression is not None else port
        if expression is None or not operators.literal(self.plain(expression)):
            choices = ""
            for constant in ("'0", "'1"):
                mutated = f"{instance}: .{port}({constant})"
                choices += f"{self.selected(self.add(node, Alternative('connection', constant), whole=mutated))} ? {constant} : "
            text = f"({choices}({text}))"
        return f".{port}({text})"

    def module_parts(self, module):
        yield module.header, self.plain(module.header) + SELECTOR.format(bits=MEMBER_BITS)
        self.module = module.header.name.valueText
        self.names = names_of(module)
        self.alone = False
        constant_text = " ".join(str(node) for node in nodes(module) if kind_of(node) in CONSTANT_PLACES - {"LoopGenerate"})
        for node in nodes(module):
            kind = kind_of(node)
            if kind in PROCESSES:
                yield self.process(node)
            elif kind == "ContinuousAssign":
                yield from self.continuous(node)
            elif kind == "FunctionDeclaration":
                if not re.search(rf"\b{re.escape(str(node.prototype.name).strip())}\s*\(", constant_text):
                    yield from self.function(node)
            elif kind == "HierarchyInstantiation":
                yield from self.instances(node)

    def run(self) -> str:
        parts = []
        root = self.tree.root
        for node in nodes(root):
            if kind_of(node) == "ModuleDeclaration":
                parts += list(self.module_parts(node))
        result, position = "", 0
        for part, text in sorted(parts, key=lambda item: self.span(item[0])):
            start, end = self.span(part)
            result += self.text[position:start] + text
            position = end
        return result + self.text[position:]


def instrument(rtl: Path, files: List[Path], out: Path) -> List[Mutant]:
    """Writes the copies of `files`, which lie below `rtl`, below `out`."""
    mutants, group = [], 1
    for file in files:
        relative = file.relative_to(rtl)
        instrumenter = Instrumenter(file.read_bytes().decode("latin-1"), str(relative), group)
        text = instrumenter.run()
        mutants += instrumenter.mutants
        group = instrumenter.group + 1
        target = out / relative
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(text.encode("latin-1"))
    return mutants


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rtl", type=Path, required=True, help="folder of the RTL")
    parser.add_argument("--out", type=Path, required=True, help="folder for the copies and mutants.json")
    parser.add_argument("files", type=Path, nargs="+", help="sources below the folder of the RTL")
    arguments = parser.parse_args()
    mutants = instrument(arguments.rtl, arguments.files, arguments.out)
    (arguments.out / "mutants.json").write_text(json.dumps([asdict(mutant) for mutant in mutants], indent=1) + "\n")
    print(f"{len(mutants)} mutants in {len(arguments.files)} files")
    return 0


if __name__ == "__main__":
    sys.exit(main())
