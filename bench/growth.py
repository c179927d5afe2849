#!/usr/bin/env python3
"""How cost grows: with spheres, triangles, lights, samples and threads.

    cargo build --release && python3 bench/growth.py [spheres,triangles,lights,samples,threads] [--most 20000000]

Draws the benchmark scenes (bench/scenes.py, needs numpy) at 1920 x 1080 and prints Markdown tables. Times are ratios to the
table's first row, but for what a primitive costs to build: that is in units of what it costs among a million.
"""

import argparse
import json
import math
import multiprocessing
import os
import statistics
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import scenes
from road import ROOT, measure


def bench(phong, path):
    return json.loads(subprocess.run([phong, "bench", str(path), "--json"], capture_output=True, text=True, check=True).stdout)


def cpu(phong, path, *options, runs=3):
    line = [phong, "render", str(path), "-o", str(path.with_suffix(".png")), "--quiet", *options]
    measure(line)
    taken = [measure(line) for _ in range(runs)]
    return [statistics.median(column) for column in zip(*taken)]


def cloud(count):
    edge = round(count ** (1 / 3))
    return scenes.spheres(edge, edge, max(1, round(count / edge**2)))


def surface(count):
    around = max(4, round(math.sqrt(count / 60)))
    return scenes.dressed(*scenes.knot(max(8, round(count / (2 * around))), around))


def primitives(phong, folder, title, counts, make):
    rows = []
    for count in counts:
        path = folder / f"{title}-{count}.toml"
        if not path.exists():
            # In a process of its own: a child's peak memory begins with its parent's.
            writer = multiprocessing.get_context("fork").Process(target=lambda: scenes.write_phong(make(count), path))
            writer.start()
            writer.join()
        built = min((bench(phong, path) for _ in range(3)), key=lambda b: b["seconds"]["build"])
        wall, spent, peak = cpu(phong, path)
        each = built["seconds"]["build"] / built["primitives"]
        rows.append((built["primitives"], each, built["bytes_per_primitive"], spent, peak))
        if count >= 5_000_000:
            path.with_suffix(".ply").unlink()
            path.unlink()
    unit = next((row[1] for row in rows if row[0] > 900_000), rows[-1][1])
    print(f"\n| {title} | build, each | bytes each | whole program, CPU | peak MB |\n|---|---|---|---|---|")
    for number, each, size, spent, peak in rows:
        print(f"| {number:,} | {each / unit:.2f} | {size:.1f} | {spent / rows[0][3]:.2f} | {peak:.0f} |", flush=True)


def lights(phong, folder):
    rows = []
    for count in (1, 4, 16, 64):
        path = folder / f"lights-{count}.toml"
        scenes.write_phong(scenes.slide(), path)
        text = path.read_text()
        head, rest = text.split("[[light]]", 1)
        tail = rest[rest.index("[materials.floor]") :]
        lamp = lambda i: f'[[light]]\nkind = "point"\nposition = [{4 * math.cos(i)}, 6, {4 * math.sin(i)}]\ncolor = {1 / count}\n\n'
        path.write_text(head + "".join(lamp(i) for i in range(count)) + tail)
        rows.append((count, cpu(phong, path)[1]))
    print("\n| lights | CPU | CPU a light |\n|---|---|---|")
    for count, spent in rows:
        print(f"| {count} | {spent / rows[0][1]:.2f} | {spent / rows[0][1] / count:.2f} |", flush=True)


def samples(phong, folder):
    path = folder / "samples.toml"
    scenes.write_phong(scenes.slide(), path)
    rows = [(count, cpu(phong, path, f"--samples={count}", runs=1)[1]) for count in (1, 4, 16, 64, 256)]
    print("\n| samples | CPU | CPU a sample |\n|---|---|---|")
    for count, spent in rows:
        print(f"| {count} | {spent / rows[0][1]:.2f} | {spent / rows[0][1] / count:.2f} |", flush=True)


def threads(phong, folder):
    path = folder / "threads.toml"
    scenes.write_phong(cloud(1_000_000), path)
    rows = []
    for count in range(1, os.cpu_count() + 1):
        options = (f"--threads={count}", "--samples=4")
        rows.append((count, *cpu(phong, path, *options)[:2]))
    print("\n| threads | wall | CPU |\n|---|---|---|")
    for count, wall, spent in rows:
        print(f"| {count} | {wall / rows[0][1]:.2f} | {spent / rows[0][2]:.2f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    every = "spheres,triangles,lights,samples,threads"
    parser.add_argument("what", nargs="?", default=every, help="default: %(default)s")
    parser.add_argument("--most", type=int, default=20_000_000, help="the most primitives (default: %(default)s)")
    parser.add_argument("--phong", default=str(ROOT / "target/release/phong"), help="the program")
    parser.add_argument("--folder", type=Path, default=ROOT / "target/growth", help="where scenes and pictures go")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    upto = lambda most: [n for n in (1_000, 10_000, 100_000, 1_000_000, 5_000_000, 10_000_000, 20_000_000) if n <= most]
    for what in options.what.split(","):
        if what == "spheres":
            primitives(options.phong, options.folder, what, upto(options.most), cloud)
        elif what == "triangles":
            primitives(options.phong, options.folder, what, upto(min(options.most, 10_000_000)), surface)
        else:
            {"lights": lights, "samples": samples, "threads": threads}[what](options.phong, options.folder)


if __name__ == "__main__":
    main()
