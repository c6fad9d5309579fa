# SPDX-License-Identifier: Apache-2.0
"""Turbid as a subprocess, its fluence as a numpy array, and the arithmetic that both comparisons share.

Fluence is in W/mm^2 for the scene's powers in W; arrays are indexed [x, y, z].
"""
import json
import math
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
TURBID = os.environ.get("TURBID", str(ROOT / "build" / "turbid"))


def give_up(sentence):
    """One line and a status that no one takes for success."""
    print("peers: " + sentence, file=sys.stderr)
    sys.exit(2)


def turbid(command, scene, output, *options):
    """Runs `turbid render|solve`; returns its report (a dict)."""
    if not Path(TURBID).exists():
        give_up(f"no turbid at {TURBID}: run scripts/setup first, or set TURBID")
    done = subprocess.run([TURBID, command, str(scene), "-o", str(output), "--json", "-q", *options], capture_output=True,
                          text=True)
    if done.returncode != 0:
        give_up(f"turbid {command} {scene} ended with status {done.returncode}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def seconds(report):
    """All stages of a run but reading the scene's files and writing the result."""
    return sum(t for stage, t in report["seconds"].items() if stage not in ("total", "read", "write"))


def read_fluence(path, corner, voxel_size, shape):
    """The red channel of the grid `fluence` (the scenes here are grey) in a box of voxels whose least corner is given."""
    import pyopenvdb
    grid = pyopenvdb.read(str(path), "fluence")
    first = [round(i) for i in grid.transform.worldToIndex([c + voxel_size / 2 for c in corner])]
    values = np.zeros((*shape, 3), np.float32)
    grid.copyToArray(values, ijk=first)
    return values[..., 0].astype(float)


def relative_l2(a, b):
    """|a - b| / |b| over all values."""
    return math.sqrt(((a - b) ** 2).sum() / (b ** 2).sum())


@dataclass
class Run:
    """One setting of one program. `values`: one array, or two of independent seeds."""
    name: str
    seconds: float  # of one of them
    values: list
    photons: int = 0

    @property
    def mean(self):
        return sum(self.values) / len(self.values)

    @property
    def noise(self):
        """Standard error of one run, relative L2, from the difference of two seeds; 0 for what has no noise."""
        return relative_l2(*self.values) / math.sqrt(2) if len(self.values) == 2 else 0.0


def compare(runs, what):
    """Prints every run against the Monte Carlo run of least noise, and the time at equal error."""
    reference = min((run for run in runs if run.noise > 0), key=lambda run: run.noise)
    floor = reference.noise / math.sqrt(2)  # of the mean of its two seeds
    print(f"{what}: reference is {reference.name}, two runs together, standard error {floor:.2%}")
    print(f"  {'run':34} {'time [s]':>9} {'from reference':>15} {'std. error':>11} {'beyond noise':>13}")
    errors = {}
    for run in runs:
        if run is reference:
            print(f"  {run.name:34} {run.seconds:9.2f} {'-':>15} {run.noise:11.2%} {'-':>13}")
            continue
        away = np.mean([relative_l2(one, reference.mean) for one in run.values])
        beyond = math.sqrt(max(away ** 2 - run.noise ** 2 - floor ** 2, 0))
        errors[run.name] = away
        print(f"  {run.name:34} {run.seconds:9.2f} {away:15.2%} {run.noise:11.2%} {beyond:13.2%}")
    last = {run.name.split(":")[0]: run for run in runs if run.noise > 0}  # the largest of each program
    for run in runs:
        if run.noise > 0:
            continue
        error = errors[run.name]
        times = [f"{program} {other.seconds * (other.noise / error) ** 2:.3g} s" for program, other in last.items()]
        print(f"  at the error of {run.name}, {error:.2%} ({run.seconds:.2f} s), noise as 1/sqrt(time): {', '.join(times)}")
    a, b = (last[program] for program in sorted(last))
    away = relative_l2(a.mean, b.mean)
    expected = math.hypot(a.noise, b.noise) / math.sqrt(2)
    print(f"  {a.name} and {b.name} differ by {away:.2%}; their noise explains {expected:.2%};"
          f" sums differ by {a.mean.sum() / b.mean.sum() - 1:+.3%}")
    return away, expected
