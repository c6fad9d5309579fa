# SPDX-License-Identifier: Apache-2.0
"""Turbid beside MCX-CL (Fang and Boas 2009; PyPI pmcxcl) on the same OpenCL device: fluence per voxel, error against time.

MCX's fluence is per unit of energy sent out [1/mm^2], which for a steady lamp of 1 W is W/mm^2: what Turbid writes. Both
mirror by Fresnel at sharp surfaces (isreflect), and MCX's voxels coincide with Turbid's. Voxels nearer than 3 to a point
source are left out: there the fluence is singular and its mean over a voxel a matter of the sampling. A head volume has
labels 0..6 as in MCX's colin27 example, one byte each, x fastest; scattering is taken as reduced (g = 0). There the media differ a little: MCX's coefficients are
constant in a voxel, Turbid's are interpolated between voxel centres.

Examples:
  scripts/peers/run mcx_fluence.py
  scripts/peers/run mcx_fluence.py head --head colin27_v3_181x217x181_u8_xfast.raw --size 181 217 181 --photons 1e6
"""
import argparse
import contextlib
import ctypes
import os
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from turbid_side import Run, compare, give_up, read_fluence, seconds, turbid


@dataclass
class Case:
    name: str
    scene: str  # TOML; {folder} is where its files lie
    corner: tuple  # where the least corner of MCX's volume lies in it [mm]
    mcx: dict
    power: float = 1.0  # that MCX's photons carry [W]
    source: tuple = None  # of a point source [voxels of MCX's volume]
    grids: dict = field(default_factory=dict)  # VDB files that the scene needs
    voxel_size: float = 1.0


LIMITS = dict(tstart=0.0, issrcfrom0=1, outputtype="fluence", issavedet=0, autopilot=1)


def cube(n=40):
    """A cube of index 1.37 in air, an isotropic point source in it."""
    inside, half = (n // 2 + 0.5,) * 3, n / 2
    place = [c - half for c in inside]
    scene = f"""unit = "mm"
[domain]
voxel_size = 1
min = [{-half - 2}, {-half - 2}, {-half - 2}]
max = [{half + 2}, {half + 2}, {half + 2}]
[material.tissue]
eta = 1.37
sigma_s = 1.0
sigma_a = 0.005
[[object]]
shape = "box"
size = [{n}, {n}, {n}]
origin = "centre"
material = "tissue"
[[light]]
type = "point"
position = {place}
power = 1
"""
    mcx = dict(vol=np.ones((n, n, n), np.uint8), prop=[[0, 0, 1, 1], [0.005, 1.0, 0, 1.37]], srctype="isotropic",
               srcpos=list(inside), srcdir=[0, 0, 1], isreflect=1, tend=2e-8, tstep=2e-8, **LIMITS)
    return Case("index-mismatched cube", scene, (-half,) * 3, mcx, source=inside)


def slab():
    """Three layers of unequal index under an even beam, repeated sideways without end: only depth matters."""
    layers = [(4, 1.5, 2.0, 0.02), (6, 1.33, 0.5, 0.005), (10, 1.4, 1.0, 0.01)]  # voxels, eta, sigma_s, sigma_a
    n, depth = 16, sum(layer[0] for layer in layers)
    text, labels, prop, z = "", np.zeros((n, n, depth), np.uint8), [[0, 0, 1, 1]], 0
    for i, (thick, eta, sigma_s, sigma_a) in enumerate(layers):
        text += f"""[material.layer{i}]
eta = {eta}
sigma_s = {sigma_s}
sigma_a = {sigma_a}
[[object]]
shape = "box"
size = [{n + 8}, {n + 8}, {thick}]
origin = "centre"
translate = [0, 0, {z + thick / 2}]
material = "layer{i}"
"""
        labels[:, :, z:z + thick] = i + 1
        prop.append([sigma_a, sigma_s, 0, eta])
        z += thick
    scene = f"""unit = "mm"
[domain]
voxel_size = 1
min = [{-n / 2}, {-n / 2}, -2]
max = [{n / 2}, {n / 2}, {depth + 2}]
boundary = {{ x = "periodic", y = "periodic" }}
{text}[[light]]
type = "directional"
direction = [0, 0, 1]
irradiance = 1
"""
    # The beam starts just below the surface, without what that reflects: (0.5 / 2.5)^2. bc: cyclic at -x, -y,
    # +x, +y (its mirrors at +x and +y lose light, as a plane-parallel Monte Carlo shows).
    mcx = dict(vol=labels, prop=prop, srctype="planar", srcpos=[0, 0, 1e-4], srcdir=[0, 0, 1],
               srcparam1=[n, 0, 0, 0], srcparam2=[0, n, 0, 0], isreflect=1, bc="cc_cc_", tend=2e-8,
               tstep=2e-8, **LIMITS)
    return Case("layered slab", scene, (-n / 2, -n / 2, 0), mcx, power=0.96 * n * n)


# sigma_a, sigma_s (1 - g) [1/mm] of the labels, from MCX's example (Fang and Boas 2009), index 1 throughout.
HEAD = [(0, 0), (0.019, 0.858), (0.02, 0.99), (0.004, 0.00099), (0.02, 0.99), (0.08, 6.544), (1e-6, 1e-6)]


def head(path, size, coarsen):
    """A labelled head, a point source three voxels below the top of it."""
    try:
        labels = np.fromfile(path, np.uint8)
    except OSError as error:
        give_up(f"{path}: cannot be read: {error.strerror}")
    if labels.size != np.prod(size) or labels.max() >= len(HEAD):
        give_up(f"{path}: expected {np.prod(size)} labels from 0 to {len(HEAD) - 1}, found {labels.size} bytes"
                f" up to {labels.max() if labels.size else 0}")
    labels = labels.reshape(size, order="F")[::coarsen, ::coarsen, ::coarsen]
    # Turbid widens a domain to whole blocks of 8 voxels, evenly at both ends: only such a one keeps its voxels in place.
    labels = np.pad(labels, [(0, -n % 8) for n in labels.shape])
    nx, ny, nz = labels.shape
    column = np.flatnonzero(labels[nx // 2, ny // 2])
    if column.size == 0:
        give_up(f"{path}: there is no head in the middle of it")
    source = (nx // 2 + 0.5, ny // 2 + 0.5, column[-1] - 2.5)
    h = float(coarsen)
    grids = {name: np.array([pair[i] for pair in HEAD], np.float32)[labels] for i, name in enumerate(("sigma_a", "sigma_s"))}
    scene = f"""unit = "mm"
[domain]
voxel_size = {h}
min = [0, 0, 0]
max = [{nx * h}, {ny * h}, {nz * h}]
material = "head"
[material.head]
sigma_a = {{ vdb = "head.vdb", grid = "sigma_a" }}
sigma_s = {{ vdb = "head.vdb", grid = "sigma_s" }}
[[light]]
type = "point"
position = {[c * h for c in source]}
power = 1
"""
    # MCX ends photons in label 0; the air around and between gets a label of its own, so that they may come back.
    prop = [[0, 0, 1, 1]] + [[a, s, 0, 1] for a, s in HEAD[1:]] + [[0, 0, 1, 1]]
    mcx = dict(vol=np.where(labels == 0, len(HEAD), labels).astype(np.uint8), prop=prop, unitinmm=h, srctype="isotropic",
               srcpos=list(source), srcdir=[0, 0, 1], isreflect=0, tend=2e-8, tstep=2e-8, **LIMITS)
    return Case("labelled head", scene, (0, 0, 0), mcx, source=source, grids=grids, voxel_size=h)


def write_grids(case, path):
    import pyopenvdb
    grids = []
    for name, values in case.grids.items():
        grid = pyopenvdb.FloatGrid()
        grid.copyFromArray(values)
        grid.name = name
        grid.transform = pyopenvdb.createLinearTransform(voxelSize=case.voxel_size)
        grid.transform.translate([case.voxel_size / 2] * 3)  # an index is a voxel's centre
        grids.append(grid)
    if grids:
        pyopenvdb.write(str(path), grids=grids)


def load_mcx():
    try:
        # The wheel brings a C++ library of its own, which breaks the OpenCL driver's unless the system's is there first.
        ctypes.CDLL("libstdc++.so.6", mode=ctypes.RTLD_GLOBAL)
        with silence():
            import pmcxcl
            devices = pmcxcl.gpuinfo()
    except (ImportError, OSError, RuntimeError) as error:
        give_up(f"MCX-CL cannot be used here: {error}; try `pip install pmcxcl` in scripts/peers/.venv")
    if not devices:
        give_up("MCX-CL finds no OpenCL device")
    print(f"MCX-CL {pmcxcl.version()} on {devices[0]['name']}, {devices[0]['sm']} compute units")
    return pmcxcl


@contextlib.contextmanager
def silence():
    """MCX writes its progress to the file descriptor of standard output."""
    saved, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    try:
        yield
    finally:
        ctypes.CDLL(None).fflush(None)  # of C's own buffer, while it still goes nowhere
        os.dup2(saved, 1)
        os.close(saved)
        os.close(nowhere)


def run_mcx(pmcxcl, case, photons, seed):
    begin = time.perf_counter()
    try:
        with silence():
            result = pmcxcl.run({**case.mcx, "nphoton": photons, "seed": seed})
    except RuntimeError as error:
        give_up(f"MCX-CL failed on the {case.name}: {error}")
    took = time.perf_counter() - begin
    return case.power * np.squeeze(result["flux"], axis=3).astype(float), took


def run_turbid(case, scene, *options):
    output = scene.parent / "fluence.vdb"
    report = turbid("solve", scene, output, *options)
    fluence = read_fluence(output, case.corner, case.voxel_size, case.mcx["vol"].shape)
    return fluence, seconds(report)


def compare_case(pmcxcl, case, photons, solvers):
    with tempfile.TemporaryDirectory(prefix="turbid-mcx-") as folder:
        scene = Path(folder) / "scene.toml"
        scene.write_text(case.scene)
        write_grids(case, Path(folder) / "head.vdb")
        run_mcx(pmcxcl, case, 1000, 1)  # compiles
        run_turbid(case, scene, "--solver", "photon", "--photons", "1000")
        counted = np.ones(case.mcx["vol"].shape, bool)
        if case.source:
            places = np.indices(counted.shape) + 0.5
            counted = sum((p - s) ** 2 for p, s in zip(places, case.source)) >= 9
        counted &= scattering_voxels(case)

        def run(name, function, seeds, count=0):
            values, times = zip(*(function(seed) for seed in seeds))
            return Run(name, min(times), [value[counted] for value in values], count)

        runs = []
        for solver in solvers:
            run_turbid(case, scene, "--solver", solver)  # compiles
            runs.append(run(f"turbid {solver}", lambda _: run_turbid(case, scene, "--solver", solver), [0]))
        for n in (photons // 10, photons):
            runs.append(run(f"turbid photon: {n:.0e}", lambda seed: run_turbid(
                case, scene, "--solver", "photon", "--photons", str(n), "--seed", str(seed)), [1, 2], n))
            runs.append(run(f"MCX-CL: {n:.0e}", lambda seed: run_mcx(pmcxcl, case, n, seed), [11, 12], n))
    compare(runs, case.name)


def scattering_voxels(case):
    """Voxels that scatter: Turbid solves for light in those alone."""
    scatters = np.array([row[1] > 0 for row in case.mcx["prop"]])
    return scatters[case.mcx["vol"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="CASE", help="cube, slab, head (default: cube slab)")
    parser.add_argument("--photons", type=float, default=1e6, help="of the longest runs (default: 1e6)")
    parser.add_argument("--solvers", nargs="*", default=["steady", "lattice"], help="others of Turbid's (default: both)")
    parser.add_argument("--head", help="file of labels")
    parser.add_argument("--size", type=int, nargs=3, default=[181, 217, 181], help="of it [voxels of 1 mm]")
    parser.add_argument("--coarsen", type=int, default=2, help="take every n-th voxel of the head (default: 2)")
    options = parser.parse_args()
    makers = {"cube": cube, "slab": slab, "head": lambda: head(options.head, options.size, options.coarsen)}
    for name in options.cases:
        if name not in makers:
            give_up(f"no case \"{name}\": expected {', '.join(makers)}")
    if "head" in options.cases and not options.head:
        give_up("the case \"head\" needs --head FILE, a volume of labels")
    pmcxcl = load_mcx()
    for name in options.cases or ["cube", "slab"]:
        compare_case(pmcxcl, makers[name](), int(options.photons), options.solvers)


if __name__ == "__main__":
    main()
