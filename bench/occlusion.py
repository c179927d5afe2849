#!/usr/bin/env python3
"""Ambient occlusion beside Tachyon's: one file, a heap of spheres as dense as a protein, drawn by both.

    cargo build --release && python3 bench/occlusion.py [SHEET.png] [--rays 64]     (needs numpy, Pillow)

The file is Tachyon's own, with four samples a pixel, 64 rays of ambient occlusion for each and no other light, so what is
seen is openness times colour. Each program draws it twice, the second time turned about the axis of view by a right angle,
which gives it other rays and other places on its pixels: how far the two pictures of one program are apart is its grain
and its edges. The sheet, if it is asked for, has Tachyon's picture at the left and ours at the right.
"""

import argparse
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
SIZE = 384
ATOMS = 4000
# Radii in Å and colours of carbon, nitrogen, oxygen and sulphur, and how often each is there.
RADII = np.array([1.7, 1.55, 1.52, 1.8])
COLORS = np.array([[0.75, 0.75, 0.75], [0.35, 0.45, 0.95], [0.95, 0.3, 0.3], [0.9, 0.8, 0.3]])
SHARES = [0.63, 0.17, 0.19, 0.01]


def heap():
    """A chain whose every atom is 1.5 Å from the one before it and not too near to any other, drawn together to a ball."""
    random = np.random.default_rng(13)
    places = [np.zeros(3)]
    while len(places) < ATOMS:
        # Of some ways on the one nearest the middle that has room: a chain that folds to a ball.
        ways = random.normal(size=(24, 3))
        ways = places[-1] + 1.5 * ways / np.linalg.norm(ways, axis=1)[:, None]
        near = np.array(places)
        gap = np.linalg.norm(ways[:, None] - near[None, :], axis=2).min(axis=1)
        far = np.linalg.norm(ways, axis=1)
        score = far + 40 * np.maximum(0, 1.3 - gap)
        places.append(ways[np.argmin(score)])
    return np.array(places), random.choice(4, size=ATOMS, p=SHARES)


def scene(places, kinds, rays, up):
    far = 1.12 * (np.linalg.norm(places, axis=1).max() + RADII.max())
    lines = ["BEGIN_SCENE", f"RESOLUTION {SIZE} {SIZE}", "SHADER_MODE FULL"]
    lines += [f"AMBIENT_OCCLUSION AMBIENT_COLOR 1 1 1 RESCALE_DIRECT 0 SAMPLES {rays}", "END_SHADER_MODE"]
    lines += ["CAMERA PROJECTION ORTHOGRAPHIC", f"ZOOM {0.5 / far:.6g}", "ASPECTRATIO 1", "ANTIALIASING 3", "RAYDEPTH 2"]
    lines += [f"CENTER 0 0 {-4 * far:.6g}", "VIEWDIR 0 0 1", f"UPDIR {up}", "END_CAMERA", "BACKGROUND 1 1 1"]
    for i, color in enumerate(COLORS):
        red, green, blue = color
        finish = "AMBIENT 0 DIFFUSE 0.9 SPECULAR 0 OPACITY 1 PHONG PLASTIC 0 PHONG_SIZE 30"
        lines.append(f"TEXDEF C{i} {finish} COLOR {red} {green} {blue} TEXFUNC 0")
    for (x, y, z), kind in zip(places, kinds):
        lines.append(f"SPHERE CENTER {x:.6f} {y:.6f} {z:.6f} RAD {RADII[kind]} C{kind}")
    return "\n".join([*lines, "END_SCENE", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sheet", nargs="?", type=Path, help="where both pictures go, side by side")
    parser.add_argument("--rays", type=int, default=64, help="of each of the four samples of a pixel; default: %(default)s")
    parser.add_argument("--phong", default=str(ROOT / "target/release/phong"), help="the program")
    parser.add_argument("--tachyon", default=shutil.which("tachyon"), help="Tachyon")
    options = parser.parse_args()
    if options.tachyon is None:
        parser.error("no tachyon: apt-get install tachyon")
    places, kinds = heap()
    pictures = {"Tachyon": [], "phong": []}
    with tempfile.TemporaryDirectory() as folder:
        for turn, up in enumerate(("0 1 0", "1 0 0")):
            file, drawn = Path(folder) / f"heap-{turn}.dat", Path(folder) / "drawn.png"
            file.write_text(scene(places, kinds, options.rays, up))
            for name, line in {
                "Tachyon": [options.tachyon, file, "-fullshade", "-format", "PNG", "-o", drawn],
                "phong": [options.phong, "render", file, "-o", drawn, "--linear", "--quiet"],
            }.items():
                subprocess.run(line, check=True, stdout=subprocess.DEVNULL)
                picture = np.asarray(Image.open(drawn).convert("RGB"), float) / 255
                # Turned back: `up` of the second picture is right in the first.
                pictures[name].append(np.rot90(picture, -turn))
    rms = lambda a, b: np.sqrt(np.mean((a - b) ** 2))
    for name, (first, second) in pictures.items():
        print(f"{name}: mean {first.mean():.4f}, its own two pictures {rms(first, second):.4f} apart (root of the mean square)")
    (theirs, again), (ours, ours_again) = pictures.values()
    print(f"both: {rms(theirs, ours):.4f} apart, means of two {rms(theirs + again, ours + ours_again) / 2:.4f}")
    # Tachyon samples a pixel at its corner: the same place is half a pixel off, which edges show.
    inside = np.s_[SIZE // 4 : -SIZE // 4, SIZE // 4 : -SIZE // 4]
    print(f"the middle: Tachyon {theirs[inside].mean():.4f}, phong {ours[inside].mean():.4f}")
    if options.sheet:
        both = np.concatenate([theirs, ours], axis=1)
        encoded = np.where(both <= 0.0031308, 12.92 * both, 1.055 * np.maximum(both, 0) ** (1 / 2.4) - 0.055)
        Image.fromarray((255 * encoded + 0.5).astype(np.uint8)).save(options.sheet, optimize=True)


if __name__ == "__main__":
    main()
