#!/usr/bin/env python3
"""A million spheres from arrays to a picture, against the program reading them from a binary PLY.

    python3 bench/arrays.py target/release/phong [--count N] [--rounds N]

with the package installed. Both do the same, in turn, each in a process of its own: read the spheres
(from arrays that are there already, or from the file), build, trace, and write a PNG of 1920 × 1080.
Told are the least times, their ratio, peak memory (of which the package may take what a bare interpreter
with numpy takes, and the arrays, and 1.1 times the program's), and what a second picture takes, after
the camera, a light, a material, a colour, and all centres have changed.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

SCENE = """version = 1
[image]
size = [1920, 1080]
samples = 1
[camera]
eye = [0, 0, 120]
look_at = [0, 0, 0]
[[light]]
kind = "distant"
direction = [-1, -2, -1]
[[points]]
file = "spheres.ply"
"""

CHILD = """
import json, sys, time
import numpy as np
def memory(what):
    # Not ru_maxrss, which a process inherits from the one that starts it.
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith(what))
bare = memory("VmHWM")
centers, radii = np.load(sys.argv[1]), np.load(sys.argv[2])
import phong
began, cpu = time.perf_counter(), time.process_time()
scene = phong.Scene(
    camera=phong.Camera(eye=(0, 0, 120), look_at=(0, 0, 0)),
    lights=[phong.Light(kind="distant", direction=(-1, -2, -1))],
)
part = scene.add_spheres(centers, radii)
added = time.perf_counter()
image = phong.render(scene, size=(1920, 1080), samples=1)
image.save(sys.argv[3])
told = {
    "wall": time.perf_counter() - began,
    "cpu": time.process_time() - cpu,
    "add": added - began,
    "peak": memory("VmHWM"),
    "bare": bare,
    **image.seconds,
}
del image
again = {}
def measure(name, change):
    before = time.perf_counter()
    change()
    seconds = phong.render(scene, size=(1920, 1080), samples=1).seconds
    again[name] = {"wall": time.perf_counter() - before, **seconds}
measure("camera", lambda: setattr(scene, "camera", phong.Camera(eye=(30, 0, 110), look_at=(0, 0, 0))))
measure("light", lambda: setattr(scene, "lights", [phong.Light(kind="distant", direction=(1, -2, -1))]))
measure("material", lambda: scene.set_material(part, phong.Material(k_s=0.5)))
measure("colour", lambda: scene.update_spheres(part, colors="tomato"))
measure("centers", lambda: scene.update_spheres(part, centers + 0.01))
small = phong.Scene()
small.add_spheres([(0, 0, 0)], 1)
calls = []
for _ in range(200):
    before = time.perf_counter()
    phong.render(small, size=(1, 1), samples=1)
    calls.append(time.perf_counter() - before)
print(json.dumps({**told, "again": again, "call": sorted(calls)[100]}))
"""


def write_ply(path: Path, centers: np.ndarray, radii: np.ndarray) -> None:
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(centers)}\n"
        + "".join(f"property float {name}\n" for name in ("x", "y", "z", "radius"))
        + "end_header\n"
    )
    rows = np.column_stack([centers, radii]).astype("<f4")
    path.write_bytes(head.encode() + rows.tobytes())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--count", type=int, default=1_000_000)
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    rng = np.random.default_rng(1)
    centers = rng.normal(0, 20, (arguments.count, 3)).astype(np.float32)
    radii = rng.uniform(0.05, 0.3, arguments.count).astype(np.float32)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        write_ply(folder / "spheres.ply", centers, radii)
        (folder / "scene.toml").write_text(SCENE)
        for name, array in (("centers", centers), ("radii", radii)):
            np.save(folder / f"{name}.npy", array)
        program, package = [], []
        for _ in range(arguments.rounds):
            command = [arguments.program, "render", folder / "scene.toml", "--json"]
            command += ["-o", folder / "a.png"]
            timed = [sys.executable, "-c", TIMED, *map(str, command)]
            done = subprocess.run(timed, capture_output=True, text=True, check=True)
            program.append(json.loads(done.stdout))
            child = [sys.executable, "-c", CHILD]
            child += [folder / name for name in ("centers.npy", "radii.npy", "b.png")]
            done = subprocess.run(child, capture_output=True, text=True, check=True)
            package.append(json.loads(done.stdout))
        same = (folder / "a.png").read_bytes() == (folder / "b.png").read_bytes()

    def least(runs: list[dict[str, float]], key: str) -> float:
        return min(run[key] for run in runs)

    print(f"{arguments.count} spheres, {arguments.rounds} rounds, the least of each; same bytes: {same}")
    for key, words in (("wall", "seconds"), ("cpu", "CPU seconds")):
        ours, theirs = least(package, key), least(program, key)
        print(f"{words:<12} package {ours:7.3f}  program {theirs:7.3f}  ratio {ours / theirs:.3f}")
    arrays = (centers.nbytes + radii.nbytes) / 2**20
    ours, theirs = least(package, "peak") / 2**10, least(program, "peak") / 2**10
    bare = least(package, "bare") / 2**10
    rest = ours - bare - arrays
    print(
        f"peak MiB     package {ours:7.1f}  program {theirs:7.1f}\n"
        f"             a bare interpreter with numpy {bare:.1f}, arrays {arrays:.1f}, beyond both {rest:.1f}: "
        f"ratio {rest / theirs:.3f}, at most 1.1 ({bare + arrays + 1.1 * theirs:.1f}) is the aim"
    )
    for name in package[0]["again"]:
        runs = [run["again"][name] for run in package]
        print(
            f"again, {name:<9} wall {least(runs, 'wall'):6.3f}  build {least(runs, 'build'):6.3f}"
            f"  trace {least(runs, 'trace'):6.3f}"
        )
    print(f"a call of one pixel: {1e3 * least(package, 'call'):.3f} ms")


TIMED = """
import json, resource, subprocess, sys, time
began = time.perf_counter()
done = subprocess.run(sys.argv[1:], capture_output=True, text=True, check=True)
wall = time.perf_counter() - began
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(json.dumps({"wall": wall, "cpu": used.ru_utime + used.ru_stime, "peak": used.ru_maxrss}))
"""

if __name__ == "__main__":
    main()
