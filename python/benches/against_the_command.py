"""Time of the map of `paper` from Python beside the command, and of one run beside its computation alone.

    python python/benches/against_the_command.py target/release/interwell

Both sides take turns in one process, so that whatever else the machine does meets both; printed are medians and the
median of the ratios of neighbours. The map has 41 x 101 cells. Python makes the scene and the grid; the command is the
whole process, which makes the scene too and writes the rows to a file. Of one run, the computation is the time that
the run itself took within the library (`cpu_s` of its summary); the rest is sampling, tables and arrays.
"""

import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import interwell
import numpy as np

ROUNDS = 9
RUNS = 300


def seconds(work):
    """Return the wall time of a call."""
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def maps(command):
    """Print the time of the map from Python and by the command."""
    limits, amplitudes = np.linspace(0.5, 7, 41), np.linspace(0, 2, 101)
    over = {"stops.travel_limit_mm": limits, "excitation.amplitude_g": amplitudes}
    listed = [f"--over={field}=" + ",".join(map(str, values)) for field, values in over.items()]
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "map.csv"
        call = [command, "--headless", "sweep", "paper", "--quiet", "--out", str(out), *listed]
        pairs = []
        for _ in range(ROUNDS + 1):
            python = seconds(lambda: interwell.Scene.preset("paper").sweep(over))
            pairs.append((python, seconds(lambda: subprocess.run(call, check=True))))
        inside = json.loads(Path(f"{out}.json").read_text())["wall_s"]
    pairs = pairs[1:]
    python, process = (statistics.median(side) for side in zip(*pairs))
    ratio = statistics.median(one / other for one, other in pairs)
    print(f"map of 41 x 101 cells: Python {python:.3f} s, command {process:.3f} s (its rows alone {inside:.3f} s), "
          f"ratio {ratio:.3f}")


def runs():
    """Print the time of one run from Python and of its computation alone."""
    scene = interwell.Scene.preset("paper")
    pairs = []
    for _ in range(RUNS + 10):
        begin = time.perf_counter()
        run = scene.run()
        wall = time.perf_counter() - begin
        pairs.append((wall, run.summary["cpu_s"]))
    wall, inside = (statistics.median(side) for side in zip(*pairs[10:]))
    rest = statistics.median(one - other for one, other in pairs[10:])
    wall, inside, rest = (1e6 * time_s for time_s in (wall, inside, rest))
    print(f"one run: Python {wall:.0f} us, its computation {inside:.0f} us, difference {rest:.0f} us, "
          f"ratio {wall / inside:.3f}")


if __name__ == "__main__":
    maps(sys.argv[1])
    runs()
