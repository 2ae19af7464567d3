#!/usr/bin/env python3
"""Symbols of the planner module: it exports all 30 functions of LinuxCNC's planner interface, and calls no function
that waits, allocates or takes a lock. `calls_test.py MODULE`."""

import subprocess
import sys

FUNCTIONS = """tcqFull tpAbort tpActiveDepth tpAddCircle tpAddLine tpAddRigidTap tpClear tpCreate tpGetExecId
tpGetExecTag tpGetMotionType tpGetPos tpIsDone tpMotData tpMotFunctions tpPause tpQueueDepth tpResume tpRunCycle
tpSetAmax tpSetAout
tpSetCycleTime tpSetDout tpSetId tpSetPos tpSetRunDir tpSetSpindleSync tpSetTermCond tpSetVlimit tpSetVmax""".split()
# Allowed calls while the module loads; then those in LinuxCNC's periods (the system call is FUTEX_WAKE; messages go to
# a ring).
AT_LOAD = "__errno_location fcntl fcntl64 fstat ftruncate getenv mmap open open64 snprintf strerror hal_exit hal_init "\
    "hal_malloc hal_pin_bit_newf hal_pin_u32_newf hal_ready __stack_chk_fail".split()
IN_PERIODS = "fmin rtapi_get_time rtapi_print_msg syscall memcpy memset __stack_chk_fail".split()


def names(kind):
    out = subprocess.run(["nm", "--dynamic", kind, sys.argv[1]], check=True, capture_output=True, text=True).stdout
    return {line.split()[-1].split("@")[0]: line.split()[-2] for line in out.splitlines()}


given = {name for name, kind in names("--defined-only").items() if kind == "T"}
missing = set(FUNCTIONS) - given
taken = {name for name, kind in names("--undefined-only").items() if kind == "U"} - set(AT_LOAD + IN_PERIODS)
if len(FUNCTIONS) != 30 or missing or taken:
    sys.exit(f"not exported: {sorted(missing)}; called, and not allowed: {sorted(taken)}")
print(f"{len(FUNCTIONS)} functions; calls {', '.join(IN_PERIODS[:4])}")
