#!/usr/bin/env python3
"""The whole road, from a scene's text to a picture on disk, against Tachyon, POV-Ray, Mitsuba 3 and OSPRay.

    cargo build --release && python3 bench/road.py [--scenes slide,mesh,...] [--ply dragon.ply.gz] [--runs 5]
                                                 [--ovito PYTHON] [--before PHONG]

Writes the scenes (bench/scenes.py, needs numpy), runs every program that is installed on the very same scene, one after
the other in rounds so that a busy machine disturbs all alike, and prints medians as a Markdown table. Ratios are to
phong: above 1, phong took less. Before measuring it holds the pictures against each other, for a program that draws
something else is not compared. (Mitsuba has no Phong material: it draws the same view, lights and shadows, diffuse.
OSPRay draws the same view by its own materials and one of the two lights; see the head of each one's file.)
"""

import argparse
import importlib.util
import json
import os
import shutil
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SCENES = "slide slide-16 mesh spheres-100k spheres-1m spheres-5m spheres-20m".split()
SIZE = 1920, 1080


def commands(phong, before, ovito, name, folder, threads):
    """What each program is called with, and where it leaves its picture. All write linear 8-bit PNG.

    `slide-16` is the slide with 16 samples a pixel; a scene too large for a program has no file for it.
    """
    many = name.endswith("-16")
    name = name.removesuffix("-16")
    at = lambda kind: str(folder / f"{name}.{kind}")
    picture = lambda program: str(folder / f"{name}{'-16' if many else ''}.{program}.png")
    of_phong = lambda path, program: [path, "render", at("toml"), "-o", picture(program), "--linear", "--quiet",
                                      f"--threads={threads}", f"--samples={16 if many else 1}"]
    all_of_them = {
        "phong": of_phong(phong, "phong"),
        "before": of_phong(before, "before"),
        "tachyon": ["tachyon", at("dat"), "-numthreads", str(threads), "-shade_phong", "-format", "PNG",
                    "-aasamples", "15" if many else "0", "-o", picture("tachyon")],
        "povray": ["povray", f"+I{at('pov')}", f"+O{picture('povray')}", f"+W{SIZE[0]}", f"+H{SIZE[1]}",
                   *(["+A0.0", "+AM1", "+R4"] if many else ["-A"]), "-D", f"+WT{threads}", "File_Gamma=1.0"],
        # Its spheres are objects one by one: for a mesh, and for few of them.
        "mitsuba": [sys.executable, str(ROOT / "bench/mitsuba_peer.py"), at("toml"), picture("mitsuba")],
        "ospray": [ovito, str(ROOT / "bench/ospray_peer.py"), at("toml"), picture("ospray")],
    }  # fmt: skip
    if many or name.startswith("spheres") or importlib.util.find_spec("mitsuba") is None:
        del all_of_them["mitsuba"]
    if many or ovito is None:
        del all_of_them["ospray"]
    if before is None:
        del all_of_them["before"]
    inputs = {"phong": at("toml"), "before": at("toml"), "tachyon": at("dat"), "povray": at("pov"), "mitsuba": at("toml"), "ospray": at("toml")}
    runs = lambda program: shutil.which(all_of_them[program][0]) and os.path.exists(inputs[program])
    return {program: line for program, line in all_of_them.items() if runs(program)}, picture


def measure(command):
    """Wall seconds, user and system seconds, peak megabytes."""
    began = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    said = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - began
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit(f"{' '.join(command)}\n{said.decode(errors='replace')}")
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", default=",".join(SCENES), help="default: %(default)s")
    parser.add_argument("--ply", type=Path, help="the mesh to draw (default: a knot made on the spot)")
    parser.add_argument("--runs", type=int, default=5, help="default: %(default)s")
    parser.add_argument("--threads", type=int, default=os.cpu_count(), help="default: all")
    parser.add_argument("--phong", default=str(ROOT / "target/release/phong"), help="the program")
    parser.add_argument("--before", help="another build of it, measured in the same rounds")
    here = sys.executable if importlib.util.find_spec("ovito") else None
    parser.add_argument("--ovito", default=here, help="a Python that has OVITO, for OSPRay (default: this one if it has)")
    parser.add_argument("--folder", type=Path, default=ROOT / "target/road", help="where scenes and pictures go")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)

    print(f"{options.threads} threads, medians of {options.runs} runs\n")
    print("| scene | program | wall s | CPU s | peak MB | wall ratio | CPU ratio | memory ratio | mean difference |")
    print("|---|---|---|---|---|---|---|---|---|")
    for name in options.scenes.split(","):
        # In a process of its own: a child's peak memory begins with its parent's.
        write = [sys.executable, ROOT / "bench/scenes.py", name.removesuffix("-16"), options.folder, *([options.ply] if options.ply else [])]
        subprocess.run(write, check=True)
        lines, picture = commands(options.phong, options.before, options.ovito, name, options.folder, options.threads)
        apart = {}
        for program, line in lines.items():  # unmeasured: files into the cache, pictures for the comparison
            measure(line)
            compared = subprocess.run(
                [options.phong, "compare", picture("phong"), picture(program), "--json"], capture_output=True, text=True
            )
            apart[program] = json.loads(compared.stdout)["mean"]
        taken = {program: [] for program in lines}
        order = list(lines.items())
        for _ in range(options.runs):
            for program, line in order:
                taken[program].append(measure(line))
            # Who comes after a program that took much memory waits for it to be cleared.
            order = order[1:] + order[:1]
        medians = {program: [statistics.median(column) for column in zip(*runs)] for program, runs in taken.items()}
        for program, (wall, cpu, peak) in medians.items():
            ratios = " | ".join(f"{own / ours:.2f}" for own, ours in zip((wall, cpu, peak), medians["phong"]))
            print(f"| {name} | {program} | {wall:.2f} | {cpu:.2f} | {peak:.0f} | {ratios} | {apart[program]:.5f} |", flush=True)


if __name__ == "__main__":
    main()
