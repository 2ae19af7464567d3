"""Jobs over the C++ build: builds, locksteps by seed, fuzzers, programs, sanitizers."""

from pathlib import Path
from typing import List

from .job import WORK, Job

ROOT = Path(__file__).resolve().parents[2]
BUILD = "scripts/farm_tools/build"
COMPILERS = ("g++", "cmake", "verilator")

# Sources of a build, and so inputs of every job that runs in it.
SOURCES = ("CMakeLists.txt", "CMakePresets.json", "cmake", "rtl", "frames", "cpp-model", "driver", "transport", "host", "sim",
           "world", "serve", "bindings", "clients", "apps", "web", "boards", "examples", "tests", "verif", ":!verif/formal",
           ":!verif/evidence", "requirements.txt", BUILD)
# SOURCES without the parts that only the host software uses.
LOCKSTEP = ("CMakeLists.txt", "cmake", "rtl", "frames", "cpp-model", "driver", "sim", "boards", "tests/support", "verif/lockstep",
            "requirements.txt")
COVERED = (*SOURCES, "scripts/coverage", "scripts/coverage_tools")
LIMIT_OF_BUILDS = 4 * 3600

# Locksteps that draw their scenarios at random, from the seed; all others run once.
RANDOM = ("^lockstep[.].*(Random|Storm|EqualsModelInEvery|EveryOutputInEvery|AllHostsAtOnce|AnyLevels|BouncingLevels|"
          "BouncingInputs|CapturesAndDrops|LockstepUnderTraffic|OnTimesFollow)")
WHOLE_CARDS = "^lockstep[.](card[.]|card_engines|motion_core)"
NO_LOCKSTEP = "^lockstep[.](checker|selftest)"
COVERAGE_SAMPLE = "^(step_shaper|time_base)$"
# Seconds below are guesses until scripts/farm expect has measured them.
# Five seeds of four times the length: as many clocks as scripts/test --long lockstep.
SEEDS, LENGTH = range(1, 6), "4"
STOP_SHARDS, SANITIZER_SHARDS = 4, 16
# Ten seeds of 10^9 clocks: as many as scripts/test --long soak.
SOAK_SEEDS, SOAK_LENGTH = range(1, 11), "200"
FUZZERS, FUZZ_SEEDS, FUZZ_SECONDS = ("interpolation", "gcode", "frames"), range(1, 3), 600

# Programs of ../shared/gcode, by GoogleTest's names.
PROGRAMS = {
    **{name.replace("_", "-"): f"Gcode/Jobs.RunsOnBothEngines/{name}"
       for name in ("jsdc_laser", "tball", "arc_xz_plane", "arc_yz_plane", "g2_arc", "circle_inch")},
    "octocat-slow-bus": "Gcode.OctocatOnASlowBusHasNoUnderRun",
    "octocat-first-lines": "Gcode.OctocatsFirstLinesOverASlowLineToTheVerilatedCard",
    "octocat-slow-line": "Gcode.OctocatOverASlowLine",
    "refused": "Gcode.CircleDiamondSquareIsRefused:Gcode.FullCircleWithoutXyzIsRefused",
}


def ctest(name: str, kind: str, build: str, *options: str, inputs=SOURCES, seconds=300.0, **environment: str) -> Job:
    return Job(name, kind, ("ctest", "--test-dir", WORK, "--no-tests=error", "-V", *options), inputs, (f"build-{build}",),
               environment, tests=build, tools=COMPILERS, seconds=seconds)


def builds() -> List[Job]:
    def made(name: str, needs=(), products=(), seconds=600.0, command=()) -> Job:
        return Job(f"build-{name}", "build", (BUILD, *(command or (name,))), SOURCES, needs, products=products, tools=COMPILERS,
                   seconds=seconds, limit=LIMIT_OF_BUILDS)

    # The builds need each other, so that they run one after the other: two builds in one folder would wait for each
    # other, and each uses all processors of its machine.
    return [made("release", products=("build/release/bin/trammel",), seconds=1200),
            made("mutation-sample", ("build-release",), ("build/release/mutation/sample_judges.json",)),
            made("mutation", ("build-mutation-sample",), ("build/release/mutation/judges.json",)),
            made("dev-sample", ("build-release",), ("build/dev/bin/test_driver",), 300, ("dev", "test_driver")),
            made("dev", ("build-dev-sample",), ("build/dev/bin/trammel",), 3600),
            made("coverage-sample", ("build-release",), ("build/rtl-coverage/bin/lockstep_time_base",), 120,
                 ("coverage", "--only", COVERAGE_SAMPLE)),
            made("coverage", ("build-coverage-sample",),
                 ("build/rtl-coverage/bin/lockstep_motion_core_8", "build/coverage/bin/test_planner"), 3600),
            made("coverage-toggle", ("build-coverage",), ("build/rtl-coverage-toggle/bin/lockstep_motion_core_8",), 5400,
                 ("coverage", "--toggle"))]


def locksteps() -> List[Job]:
    jobs = [ctest("lockstep-directed", "lockstep", "release", "-L", "lockstep", "-E", f"{RANDOM}|{NO_LOCKSTEP}", inputs=LOCKSTEP)]
    for seed in SEEDS:
        changed = {"inputs": LOCKSTEP, "TRAMMEL_SEED": str(seed), "TRAMMEL_LONG": LENGTH}
        jobs += [ctest(f"lockstep-blocks-s{seed}", "lockstep", "release", "-R", RANDOM, "-E", f"{WHOLE_CARDS}|{NO_LOCKSTEP}",
                       **changed),
                 ctest(f"lockstep-cards-s{seed}", "lockstep", "release", "-R", f"({WHOLE_CARDS}).*Random",
                       seconds=450.0, **changed)]
    jobs += [ctest(f"lockstep-stops-{shard}-of-{STOP_SHARDS}", "lockstep", "release", "-L", "stops", "-I",
                   f"{shard},,{STOP_SHARDS}", inputs=LOCKSTEP, TRAMMEL_LONG="32") for shard in range(1, STOP_SHARDS + 1)]
    return jobs


def soak(name: str, seed: int, length: str) -> Job:
    return ctest(name, "soak", "release", "--timeout", "3600", "-R", "^model[.]Soak[.]", inputs=LOCKSTEP + ("tests/model",),
                 TRAMMEL_SEED=str(seed), TRAMMEL_LONG=length)


def soaks() -> List[Job]:
    return [soak(f"soak-s{seed}", seed, SOAK_LENGTH) for seed in SOAK_SEEDS]


def fuzzer(name: str, target: str, seed: int, seconds: int) -> Job:
    return Job(name, "fuzz", ("scripts/farm_tools/fuzz", target, str(seconds), str(seed), WORK), SOURCES, ("build-release",),
               tools=("clang-14",), seconds=seconds + 5, measured=True)


def fuzzers() -> List[Job]:
    return [fuzzer(f"fuzz-{target}-s{seed}", target, seed, FUZZ_SECONDS) for target in FUZZERS for seed in FUZZ_SEEDS]


def program(name: str, job: str = "", long_run: bool = True) -> Job:
    # Not through ctest: the time-outs of its tests for long runs are set when the tests are linked.
    return Job(job or f"program-{name}", "program",
               ("build/release/bin/test_programs", f"--gtest_filter={PROGRAMS[name]}"), SOURCES, ("build-release",),
               {"TRAMMEL_LONG": "1"} if long_run else {}, tools=COMPILERS, seconds=300)


def has_programs() -> bool:
    return (ROOT.parent / "shared" / "gcode").is_dir()


def programs() -> List[Job]:
    return [program(name) for name in PROGRAMS] if has_programs() else []


def coverage(name: str, result: str, *options: str, build="coverage", seconds=600.0) -> Job:
    return Job(name, "coverage", ("scripts/coverage", "--no-build", "-j", "1", "--out", WORK, *options), COVERED,
               (f"build-{build}",), result_file=result, tools=(*COMPILERS, "gcov"), seconds=seconds)


def coverage_sample() -> Job:
    return coverage("quick-coverage", "rtl/coverage.json", "--only", COVERAGE_SAMPLE, build="coverage-sample", seconds=20.0)


def coverages() -> List[Job]:
    return [coverage("coverage-rtl", "rtl/coverage.json"), coverage("coverage-cpp", "cpp/coverage.json", "--cpp"),
            coverage("coverage-toggle", "rtl-toggle/coverage.json", "--toggle", build="coverage-toggle")]


def sanitizer(name: str, shard: int) -> Job:
    # The preset leaves out what has false reports or cannot keep up.
    return ctest(name, "sanitizer", "dev", "--preset", "dev", "-I", f"{shard},,{SANITIZER_SHARDS}",
                 seconds=10_000.0 / SANITIZER_SHARDS)


def sanitizer_sample() -> Job:
    return Job("quick-sanitizer", "sanitizer", ("ctest", "--test-dir", WORK, "--no-tests=error", "-V", "-R", "^driver[.]", "-I", "1,,8"),
               SOURCES, ("build-dev-sample",), tests="dev", tools=COMPILERS, seconds=50.0)


def sanitizers() -> List[Job]:
    return [sanitizer(f"sanitizer-{shard}-of-{SANITIZER_SHARDS}", shard) for shard in range(1, SANITIZER_SHARDS + 1)]
