"""A test bench in Verilog that replays a recording (verif/netlist/recorder.hpp) on a netlist, or on the RTL with 4-state
values, and compares every output."""
import re

# Outputs that are valid only with another one: before the first answer they are unknown.
MEANS_WITH = {"rdata_o": "rvalid_o"}


def recorded_ports(recording):
    """Names, directions and widths of the ports that a recording has, in its order."""
    with open(recording) as file:
        heads = [re.fullmatch(r"(\w+)([<>])(\d+)", word).groups() for word in file.readline().split()]
    return [(name, "input" if sign == "<" else "output", int(width)) for name, sign, width in heads]


def bench(ports, top, four_state=False):
    """The bench, which reads the recording from +recording=FILE. A netlist's flip-flops start at 0, and its outputs are
    compared from the first clock. With four_state, registers start unknown, and outputs are compared from the second
    clock under reset on, because the card registers its reset once."""
    inputs = [p for p in ports if p[1] == "input"]
    outputs = [p for p in ports if p[1] == "output"]
    lines = ["module replay;", "  integer file, got, clocks, wrong;", "  reg [8*4096-1:0] name;", "  reg clk_i;",
             f"  reg judged = {int(not four_state)};", "  integer under_reset = 0;"]
    lines += [f"  reg [{w - 1}:0] {n};" for n, _, w in inputs]
    lines += [f"  wire [{w - 1}:0] {n};\n  reg [{w - 1}:0] {n}_then;" for n, _, w in outputs]
    connections = ", ".join(f".{n}({n})" for n, _, _ in ports)
    values = ", ".join(n if d == "input" else f"{n}_then" for n, d, _ in ports)
    form = " ".join(["%h"] * len(ports))
    lines += [f"  {top} card (.clk_i(clk_i), {connections});", "  initial begin", "    clk_i = 0; clocks = 0; wrong = 0;",
              '    if (!$value$plusargs("recording=%s", name)) $display("no recording");',
              '    file = $fopen(name, "r");',
              "    got = $fgets(name, file);  // the names of the ports",
              "    while (wrong == 0 && !$feof(file)) begin",
              f'      got = $fscanf(file, "{form}\\n", {values});',
              f'      if (got != {len(ports)}) begin $display("a line of %0d values", got); wrong = wrong + 1; end',
              "      #1 clk_i = 1;", "      #1 clocks = clocks + 1;",
              "      if (rst_i === 1) under_reset = under_reset + 1;", "      if (under_reset >= 2) judged = 1;"]
    lines += [f"      if (judged && {MEANS_WITH.get(n, 1)} && {n} !== {n}_then) begin wrong = wrong + 1; "
              f'$display("clock %0d: {n} is %h, recorded %h", clocks, {n}, {n}_then); end' for n, _, _ in outputs]
    if four_state:  # a bench without any comparison would prove nothing
        lines += ['      if (clocks == 8 && !judged) begin wrong = wrong + 1; $display("no reset at the beginning"); end']
    lines += ["      clk_i = 0;", "    end", '    $display("%0d clocks replayed, %0d differences", clocks, wrong);',
              "    $finish;", "  end", "endmodule", ""]
    return "\n".join(lines)
