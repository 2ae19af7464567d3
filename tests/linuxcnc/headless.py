#!/usr/bin/env python3
"""The examples of docs/user/linuxcnc.md in headless LinuxCNC: homes, jogs, runs a program, probes, holds, aborts,
stops. The card's steps equal what was commanded."""

import argparse
import json
import pathlib
import shutil
import subprocess

from lcnc_bench import Bench, Farthest

LEAD = 100  # periods: this host is no realtime one


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("trammel")
    parser.add_argument("module")
    parser.add_argument("--drop", type=int, default=0, help="periods of a thousand that are lost")
    options = parser.parse_args()
    bench = Bench(options.trammel, options.module, "test-headless")
    try:
        shutil.copy(pathlib.Path(__file__).with_name("headless_ui.py"), bench.folder)
        ini = (bench.folder / "trammel.ini").read_text()
        ini = ini.replace("DISPLAY = axis", "DISPLAY = ./headless_ui.py").replace("NAME = 0", f"NAME = {bench.name}")
        ini = ini.replace("LEAD_PERIODS = 4", f"LEAD_PERIODS = {LEAD}")
        ini = ini.replace("FERROR = 2.0", "FERROR = 20").replace("MIN_FERROR = 0.5", "MIN_FERROR = 20")
        (bench.folder / "trammel.ini").write_text(ini)
        with open(bench.folder / "trammel.hal", "a") as hal:
            hal.write(f"setp trammel.0.test-drop {options.drop}\nsetp trammel.0.link-periods 1000\n")
        bench.start_owner()
        subprocess.run(["chown", "-R", "nobody", bench.folder], check=True)
        with open(bench.folder / "hal.txt", "w") as log:
            subprocess.run(bench.isolated(["linuxcnc", "-r", "trammel.ini"]), cwd=bench.folder, env=bench.environment(),
                           stdout=log, stderr=subprocess.STDOUT, timeout=150, check=False)
        result = json.loads((bench.folder / "result.json").read_text())
        print(json.dumps(result))
        found = Farthest(bench.end_owner(), LEAD)
        print(bench.notes.read_text())
        print(f"{found.lines} lines, {found.steps} steps, farthest from a target {found.pulses:.4f} pulses")
        assert result.get("passed"), result.get("failed")
        assert max(abs(a - b) for a, b in zip(result["end"], (0, 0, 5))) < 1e-6, result["end"]
        # The card's capture is the motor's position, off by what homing has set (the switch's way back, 0.1 mm), and
        # LinuxCNC saw the edge some periods later.
        assert abs(result["captured"] - result["probed"]) < 0.4, (result["captured"], result["probed"])
        assert 0 < result["aborted"] < 60, result["aborted"]
        assert all(result["homed_behind_stop"])
        if result["late"] == 0:
            assert found.pulses <= 0.5
        print("passed")
    except Exception:
        for file in ("hal.txt", "owner-1.txt"):
            if (bench.folder / file).exists():
                print(f"--- {file}\n" + (bench.folder / file).read_text()[-3000:])
        raise
    finally:
        bench.close()


if __name__ == "__main__":
    main()
