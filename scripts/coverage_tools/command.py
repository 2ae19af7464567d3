"""The options of scripts/coverage."""

import argparse
import os
import sys
from pathlib import Path

from records import identity

from . import cpp, points, rtl, waivers


def arguments_of(argv):
    parser = argparse.ArgumentParser(
        prog="scripts/coverage",
        description="Measures which lines and branches of the RTL the locksteps reach, each at its usual length: "
                    "docs/developer/coverage.md. Exit status 0 when every point is covered or waived with a reason; 1 when not, when "
                    "a lockstep fails, or when a waiver is stale.")
    parser.add_argument("--cpp", action="store_true",
                        help="instead lines and branches of driver, planner, G-code reader and golden model that their unit tests "
                        "reach, by gcov; exit status 1 below 95 %%")
    parser.add_argument("--toggle", action="store_true", help="also whether each bit went up and down: a build of its own")
    parser.add_argument("--cards", action="store_true",
                        help="also the locksteps of whole cards, which take most of the time and should add no point")
    parser.add_argument("--only", default="", metavar="REGEX",
                        help="only locksteps whose name has this, whole cards included: a look at a part, the missing points are listed and not judged")
    parser.add_argument("--build-only", action="store_true", help="build, and run nothing")
    parser.add_argument("--no-build", action="store_true", help="run what is built")
    parser.add_argument("--no-run", action="store_true", help="read what the last runs have counted, after a change of waivers")
    parser.add_argument("-j", "--jobs", type=int, default=len(os.sched_getaffinity(0)), metavar="N",
                        help="compilers and tests at once (default: as many as processors)")
    parser.add_argument("--out", type=Path, default=identity.ROOT / "build" / "coverage-results", metavar="DIR",
                        help="folder of results: rtl/coverage.json, rtl/lcov.info, rtl/logs, cpp/coverage.json, cpp/missing.txt "
                        "(default build/coverage-results)")
    return parser.parse_args(argv)


def main(argv) -> int:
    try:
        arguments = arguments_of(argv)
        return cpp.run(arguments) if arguments.cpp else rtl.run(arguments)
    except (points.PointError, waivers.WaiverError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
