"""Logic cells of every module of a block on an iCE40.

The block is synthesised with its hierarchy and flattened afterwards, so that the name of every cell tells its module;
the cells are counted as nextpnr packs them. The sum is a little larger than the flat synthesis, which optimises across
modules.
"""
import json
from collections import Counter

from synthesis.tools import BUILD, ice40, read_block, run

# Row for the cells that nextpnr adds at the ends of carry chains, which belong to no module.
ADDED = "(ends of carry chains)"


def module_name(kind):
    """The name of a module, without the decoration that Yosys adds for its parameters."""
    return kind.split("\\")[1] if kind.startswith("$paramod") else kind


def instances(modules, kind, path=(), names=()):
    """Every instance below a module: its path, and the path of its modules' names."""
    yield path, names + (module_name(kind),)
    for cell, what in modules[kind]["cells"].items():
        if what["type"] in modules:
            yield from instances(modules, what["type"], path + (cell,), names + (module_name(kind),))


def owner(cell, paths):
    """The path of the instance that a cell belongs to."""
    parts, found = cell.replace("$flatten", "").replace("\\", ""), ()
    for path in paths:
        if len(path) > len(found) and parts.startswith(".".join(path) + "."):
            found = path
    return found


def modules_area(name, block, parameters):
    """Rows {modules, instances, own, all, memories}, in the order of the hierarchy; `own` sums up to the whole."""
    at = f"build/synthesis/{name}.modules"
    log = BUILD / f"{name}.modules.log"
    synth = ice40(block, options="-noflatten ")
    run(["yosys", "-q", "-p", f"{read_block(block, parameters)}; {synth}; write_json {at}.hierarchy.json; flatten; "
         f"write_json {at}.json"], log)
    run(["nextpnr-ice40", "--hx8k", "--package", "ct256", "--pcf-allow-unconstrained", "--pack-only", "--json", f"{at}.json",
         "--write", f"{at}.packed.json"], BUILD / f"{name}.pack.log")
    modules = json.loads((BUILD / f"{name}.modules.hierarchy.json").read_text())["modules"]
    modules = {kind: m for kind, m in modules.items() if not m["attributes"].get("blackbox")}
    top = next(kind for kind, m in modules.items() if m["attributes"].get("top"))
    tree = dict(instances(modules, top))
    packed = json.loads((BUILD / f"{name}.modules.packed.json").read_text())["modules"]
    cells = next(iter(packed.values()))["cells"]
    own, memories = Counter(), Counter()
    for cell, what in cells.items():
        added = cell.startswith("$nextpnr_")
        where = (ADDED,) if added else tree[owner(cell, tree)]
        own[where] += what["type"] == "ICESTORM_LC"
        memories[where] += what["type"] == "ICESTORM_RAM"
    rows, count = [], Counter(tree.values())
    for where in list(dict.fromkeys(tree.values())) + [(ADDED,)]:
        inside = [w for w in own if w[:len(where)] == where]
        rows.append({"modules": where, "instances": count[where], "own": own[where], "all": sum(own[w] for w in inside),
                     "memories": sum(memories[w] for w in inside)})
    total = sum(what["type"] == "ICESTORM_LC" for what in cells.values())
    assert sum(row["own"] for row in rows) == total
    return rows, total
