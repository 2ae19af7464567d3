"""Files generated from the descriptions: top, constraints, and the tables in docs/user/boards.md."""
import re

from board_tools.description import variants
from rtl.file_list import ROOT

PAGE = ROOT / "docs" / "user" / "boards.md"
NOTE = "Written by scripts/boards from boards/{}/board.toml; edit that."


def vector(width):
    return f"[{width - 1}:0] " if width > 1 else ""


def top_text(board):
    """The top: PLL, card, and the pins with constant levels."""
    parameters = [("BuildId", "BuildId"), ("BuildDirty", "BuildDirty"), ("BoardId", f"32'd{board.board_id}"),
                  ("ClockHz", f"32'd{board.clock_hz}"), ("ResetBits", board.reset_bits), *board.card.items()]
    widths = board.widths
    ports = ["input wire logic clk_i", "input wire logic rx_i", "output logic tx_o",
             f"input wire logic {vector(widths['input'])}input_i",
             *(["input wire logic emergency_stop_i"] if board.emergency_stop else []),
             f"output logic {vector(widths['output'])}output_o",
             f"output logic {vector(widths['step'])}step_o", f"output logic {vector(widths['dir'])}dir_o",
             *(f"output logic {port}" for port in board.constants)]
    pll = ", ".join(f".{name}({value})" for name, value in board.pll.items())
    listed = ",\n      ".join(f".{name}({value})" for name, value in parameters)
    stop = ".emergency_stop_i" if board.emergency_stop else ".emergency_stop_i(1'b0)"
    still = "".join(f"  assign {port} = 1'b{level};\n" for port, level in board.constants.items())
    return f"""// {board.title}: the card at {board.clock_mhz:g} MHz behind the board's UART.
// {NOTE.format(board.name)}
`default_nettype none

module {board.top} #(
    parameter logic [31:0] BuildId = 0,
    parameter int BuildDirty = 0
) (
    {(","+chr(10)+"    ").join(ports)}
);
  logic clk;
  logic locked;

  board_pll #(
      {pll.replace(", ", "," + chr(10) + "      ")}
  ) pll (
      .crystal_i(clk_i),
      .clk_o(clk),
      .locked_o(locked)
  );

  board_card #(
      {listed}
  ) card (
      .clk_i(clk),
      .locked_i(locked),
      .rx_i,
      .tx_o,
      .input_i,
      {stop},
      .output_o,
      .step_o,
      .dir_o
  );
{chr(10) + still if still else ""}endmodule

`default_nettype wire
"""


def pcf_text(board):
    lines = [f"# {NOTE.format(board.name)}"]
    lines += [f"set_io {'-pullup yes ' if pin.pull_up else ''}{pin.signal} {pin.site}" for pin in board.pins]
    lines.append(f"set_frequency clk_i {board.crystal_mhz:g}")
    return "\n".join(lines) + "\n"


def lpf_text(board):
    lines = [f"# {NOTE.format(board.name)}", f'FREQUENCY PORT "clk_i" {board.crystal_mhz:g} MHZ;']
    for pin in board.pins:
        drive = " DRIVE=8" if "_o" in pin.signal else ""
        pull = "UP" if pin.pull_up else "NONE"
        lines += [f'LOCATE COMP "{pin.signal}" SITE "{pin.site}";',
                  f'IOBUF PORT "{pin.signal}" IO_TYPE=LVCMOS33 PULLMODE={pull}{drive};']
    return "\n".join(lines) + "\n"


CONSTRAINTS = {"ice40": ("pins.pcf", pcf_text), "ecp5": ("pins.lpf", lpf_text)}


def constraints_file(board):
    return board.folder / CONSTRAINTS[board.family][0]


def note_of(pin):
    """The last column of the table."""
    notes = ["pull-up"] if pin.pull_up else []
    notes += ["high is stop"] if pin.signal == "emergency_stop_i" else []
    notes += [] if pin.level is None else [f"stands at {pin.level}"]
    notes += [", ".join(f"`{role}`" for role in pin.roles)] if pin.roles else []
    return "; ".join(notes)


def machine_file_text(board):
    """The suggested roles as lines of a machine file."""
    lines, probe = [], None
    for group in ("input", "output"):
        entries = [f"{role} = {index}" for index, text in enumerate(board.roles.get(group, [])) for role in text.split()]
        probe = next((entry.split(" = ")[1] for entry in entries if entry.startswith("probe")), probe)
        lines += ["", f"[{group}s]", *(entry for entry in entries if not entry.startswith("probe"))] if entries else []
    if probe is not None:
        lines += ["", "[probe]", f"input = {probe}", "touched_level = 0  # a plate that the tool connects to ground"]
    return "\n".join(lines[1:])


def table_text(board):
    """The board's table of pins, for its page."""
    lines = ["| signal | pin of the device | on the board | suggested role |", "|---|---|---|---|"]
    lines += [f"| `{pin.signal}` | {pin.site} | {pin.place} | {note_of(pin)} |" for pin in board.pins]
    if board.roles:
        lines += ["", "The suggested roles in a machine file:", "", "```toml", machine_file_text(board), "```"]
    if others := variants(board):
        lines += ["", "The same pins, described and **not built**:",
                  *(f"- {other.title}: `scripts/boards {other.name}`, device `{other.device}`" for other in others)]
    sources = "\n".join(f"- {source}" for source in board.sources)
    return (f"BOARD_ID {board.board_id}; {board.crystal_mhz:g} MHz crystal, card clock {board.clock_mhz:g} MHz; reset "
            f"{2**board.reset_bits / board.clock_mhz:.1f} us after the PLL's lock.\n\n" + "\n".join(lines)
            + f"\n\nPins are those of:\n{sources}\n")


def page_text(page, boards):
    """The page with each board's table between its marks."""
    for board in boards:
        begin, end = f"<!-- {board.name}: written by scripts/boards -->", f"<!-- end of {board.name} -->"
        page, count = re.subn(f"(?s){re.escape(begin)}.*?{re.escape(end)}",
                              lambda _: f"{begin}\n{table_text(board)}{end}", page)
        if count != 1:
            raise SystemExit(f"error: {PAGE.relative_to(ROOT)} has {count} places {begin}")
    return page


def outputs(boards):
    """Every file that is generated from the descriptions, with its text."""
    texts = {}
    for board in boards:
        texts[board.folder / f"{board.top}.sv"] = top_text(board)
        texts[constraints_file(board)] = CONSTRAINTS[board.family][1](board)
    texts[PAGE] = page_text(PAGE.read_text(), boards)
    return texts
