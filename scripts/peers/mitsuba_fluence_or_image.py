# SPDX-License-Identifier: Apache-2.0
"""Turbid beside Mitsuba 3 (PyPI mitsuba): the picture of a cloud of uneven density in sunlight, error against time.

The cloud has no index of its own, because Mitsuba cannot connect a distant lamp through a smooth dielectric. Both programs
read the same grid of densities, interpolate it between voxel centres, and give linear radiance [W/(mm^2 sr)] for the same
irradiance, with one camera and box-filtered pixels. Mitsuba's integrator is volpath, without limit of depth.

Example:
  scripts/peers/run mitsuba_fluence_or_image.py --spp 256 --photons 3e6
"""
import argparse
import tempfile
import time
from pathlib import Path

import numpy as np
from turbid_side import Run, compare, give_up, seconds, turbid

VOXELS, HALF = 48, 24.0  # one millimetre each
ALBEDO, DENSEST = 0.99, 0.6  # scattering over extinction; largest extinction [1/mm]
CAMERA, FOV, PIXELS = (10.0, 20.0, 110.0), 35.0, 128
SUN, IRRADIANCE = (-0.6, -0.7, -0.25), 1.0


def cloud(seed=4):
    """Extinction [1/mm] at voxel centres, indexed [x, y, z]: soft blobs, nothing at the faces."""
    random = np.random.default_rng(seed)
    places = np.stack(np.meshgrid(*[np.arange(VOXELS) + 0.5 - HALF] * 3, indexing="ij"))
    density = np.zeros((VOXELS,) * 3)
    for _ in range(24):
        centre, radius = random.uniform(-12, 12, 3), random.uniform(3, 7)
        density += np.exp(-((places - centre[:, None, None, None]) ** 2).sum(0) / radius ** 2)
    edge = np.clip((HALF - 1 - np.abs(places).max(0)) / 5, 0, 1)
    density *= edge * edge * (3 - 2 * edge)
    return (DENSEST * density / density.max()).astype(np.float32)


def turbid_scene(folder, density):
    import pyopenvdb
    grid = pyopenvdb.FloatGrid()
    grid.copyFromArray(density)
    grid.name = "density"
    grid.transform = pyopenvdb.createLinearTransform(voxelSize=1)
    grid.transform.translate([0.5 - HALF] * 3)  # an index is a voxel's centre
    pyopenvdb.write(str(folder / "cloud.vdb"), grids=[grid])
    scene = folder / "cloud.toml"
    scene.write_text(f"""unit = "mm"
[domain]
voxel_size = 1
min = [{-HALF}, {-HALF}, {-HALF}]
max = [{HALF}, {HALF}, {HALF}]
material = "cloud"
[material.cloud]
sigma_s = {{ vdb = "cloud.vdb", grid = "density", scale = {ALBEDO} }}
sigma_a = {{ vdb = "cloud.vdb", grid = "density", scale = {1 - ALBEDO} }}
[[light]]
type = "directional"
direction = {list(SUN)}
irradiance = {IRRADIANCE}
[camera]
position = {list(CAMERA)}
target = [0, 0, 0]
fov = {FOV}
width = {PIXELS}
height = {PIXELS}
samples = 16
""")
    return scene


def load_mitsuba(variant):
    try:
        import mitsuba
        if variant not in mitsuba.variants():
            give_up(f"Mitsuba has no variant \"{variant}\": expected one of {', '.join(mitsuba.variants())}")
        mitsuba.set_variant(variant)
        mitsuba.load_dict({"type": "sphere"})  # llvm variants find out here that there is no LLVM
    except (ImportError, OSError, RuntimeError) as error:
        give_up(f"Mitsuba cannot be used here ({variant}): {error}; try `pip install mitsuba` in scripts/peers/.venv,"
                " or --variant scalar_rgb")
    print(f"Mitsuba {mitsuba.__version__}, {variant}")
    return mitsuba


def mitsuba_scene(mi, density):
    world = mi.ScalarTransform4f().translate([-HALF] * 3).scale(2 * HALF)  # of the unit cube
    grid = {"type": "gridvolume", "grid": mi.VolumeGrid(np.ascontiguousarray(density.transpose(2, 1, 0))[..., None]),
            "filter_type": "trilinear", "to_world": world}
    return mi.load_dict({
        "type": "scene",
        "integrator": {"type": "volpath", "max_depth": -1, "rr_depth": 64},
        "sensor": {
            "type": "perspective", "fov": FOV, "fov_axis": "y",
            "to_world": mi.ScalarTransform4f().look_at(list(CAMERA), [0, 0, 0], [0, 1, 0]),
            "film": {"type": "hdrfilm", "width": PIXELS, "height": PIXELS, "pixel_format": "rgb", "rfilter": {"type": "box"}},
            "sampler": {"type": "independent"}},
        "sun": {"type": "directional", "direction": list(SUN), "irradiance": {"type": "rgb", "value": IRRADIANCE}},
        "cube": {
            "type": "cube", "to_world": mi.ScalarTransform4f().scale(HALF), "bsdf": {"type": "null"},
            "interior": {"type": "heterogeneous", "sigma_t": grid, "albedo": ALBEDO, "phase": {"type": "isotropic"}}}})


def run_mitsuba(mi, scene, spp, seed):
    begin = time.perf_counter()
    picture = np.array(mi.render(scene, spp=spp, seed=seed))  # the array waits for the render
    return picture[..., 0].astype(float), time.perf_counter() - begin


def run_turbid(mi, scene, *options):
    output = scene.parent / "cloud.exr"
    report = turbid("render", scene, output, *options)
    channels = dict(mi.Bitmap(str(output)).split())
    return np.array(channels["<root>"]).astype(float)[..., 0], seconds(report)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--variant", default="scalar_rgb",
                        help="of Mitsuba (default: scalar_rgb; llvm_ad_rgb aborts where LLVM is as old as Debian 12's)")
    parser.add_argument("--spp", type=int, default=256, help="samples per pixel of the longest run (default: 256)")
    parser.add_argument("--photons", type=float, default=1e6, help="of Turbid's longest run (default: 1e6)")
    parser.add_argument("--solvers", nargs="*", default=["steady", "lattice"], help="others of Turbid's (default: both)")
    parser.add_argument("--keep", help="folder for the scene, the pictures and the cloud")
    options = parser.parse_args()
    mi = load_mitsuba(options.variant)
    density = cloud()
    with tempfile.TemporaryDirectory(prefix="turbid-mitsuba-") as temporary:
        folder = Path(options.keep or temporary)
        folder.mkdir(parents=True, exist_ok=True)
        scene, peer = turbid_scene(folder, density), mitsuba_scene(mi, density)
        run_mitsuba(mi, peer, 1, 0)  # compiles
        run_turbid(mi, scene, "--solver", "photon", "--photons", "1000")

        def run(name, function, seeds):
            values, times = zip(*(function(seed) for seed in seeds))
            if options.keep:
                mi.Bitmap(values[0].astype(np.float32)[..., None]).write(str(folder / (name.replace(": ", "_") + ".exr")))
            return Run(name, min(times), list(values))

        runs = []
        for solver in options.solvers:
            run_turbid(mi, scene, "--solver", solver)  # compiles
            runs.append(run(f"turbid {solver}", lambda _: run_turbid(mi, scene, "--solver", solver), [0]))
        for part in (16, 1):
            photons = int(options.photons) // part
            runs.append(run(f"turbid photon: {photons}", lambda seed: run_turbid(
                mi, scene, "--solver", "photon", "--photons", str(photons), "--seed", str(seed)), [1, 2]))
            spp = max(options.spp // part, 1)
            runs.append(run(f"Mitsuba: {spp} spp", lambda seed: run_mitsuba(mi, peer, spp, seed), [1, 2]))
        compare(runs, "picture of an index-matched cloud")


if __name__ == "__main__":
    main()
