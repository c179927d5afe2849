#!/usr/bin/env python3
"""Holds this renderer against POV-Ray 3.7: the same scene written for both, the same linear values wanted.

    cargo build --release && python3 crates/phong/tests/witness/witness.py [NAME...]

Each NAME.toml beside this file has a NAME.pov. Both are drawn at 160 x 120 with one sample a pixel, POV-Ray into
16 linear bits (a step is 1.5e-5), phong into floats. Away from edges the two may differ by 2e-4. At edges (of
objects, of their sides, of shadows, and of what mirrors and glass show) a ray may pass on either side, so a pixel may
differ wholly: such pixels may be 0.2 % of the picture. The exit code is 0 if every scene holds, else 1.
"""

import argparse
import math
import shutil
import struct
import subprocess
import sys
import zlib
from array import array
from pathlib import Path

WIDTH, HEIGHT = 160, 120
TOLERANCE = 2e-4
EDGE_SHARE = 0.002
CREASE = math.cos(math.radians(20))  # between neighbours' normals: two sides of a box, not a curve
JUMP = 0.02  # between neighbours in what a mirror or glass brings

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[3]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="scenes (default: all beside this file)")
    parser.add_argument("--phong", help="the program (default: target/release/phong, else from PATH)")
    parser.add_argument("--keep", type=Path, default=ROOT / "target/witness", help="where pictures go")
    options = parser.parse_args()
    built = ROOT / "target/release/phong"
    phong = options.phong or (built if built.exists() else shutil.which("phong"))
    povray = shutil.which("povray")
    if not phong or not povray:
        sys.exit("needs POV-Ray 3.7 as `povray`, and `cargo build --release` first")
    names = options.names or sorted(path.stem for path in HERE.glob("*.pov"))
    options.keep.mkdir(parents=True, exist_ok=True)

    print(f"{'scene':16} {'off edges':>10} {'at':>9} {'edge pixels that differ':>24}  verdict")
    failed = [name for name in names if not hold(name, phong, povray, options.keep)]
    if failed:
        print(f"{len(failed)} of {len(names)} disagree with POV-Ray: {' '.join(failed)}")
        return 1
    print(f"all {len(names)} agree with POV-Ray")
    return 0


def hold(name, phong, povray, folder):
    """Draws one pair, prints its line, and says whether it holds."""
    out = folder / f"{name}.pfm"
    run(phong, "render", HERE / f"{name}.toml", "-o", out, "--terms", "--aov", "object,normal,shadow", "--quiet")
    pov = folder / f"{name}.pov.png"
    run(povray, f"+I{HERE / name}.pov", f"+O{pov}", f"+W{WIDTH}", f"+H{HEIGHT}", "-A", "-D", "+FN16", "File_Gamma=1.0")

    ours, theirs = read_pfm(out), read_png(pov)
    if "// mirrored in x" in (HERE / f"{name}.pov").read_text():
        theirs = [row[::-1] for row in theirs]
    layers = {
        layer: read_pfm(folder / f"{name}.{layer}.pfm")
        for layer in ("object", "normal", "shadow", "reflection", "transmission")
    }
    worst, worst_at, edges = 0.0, (0, 0), 0
    for y in range(HEIGHT):
        for x in range(WIDTH):
            a, b = ours[y][x], theirs[y][x]
            apart = max(abs(min(max(p, 0.0), 1.0) - q) for p, q in zip(a, b))
            if apart <= worst and apart <= TOLERANCE:
                continue
            if at_edge(layers, x, y):
                edges += apart > TOLERANCE
            elif apart > worst:
                worst, worst_at = apart, (x, y)
    share = edges / (WIDTH * HEIGHT)
    good = worst <= TOLERANCE and share <= EDGE_SHARE
    verdict = "agrees" if good else "DIFFERS"
    print(f"{name:16} {worst:10.1e} {f'{worst_at[0]},{worst_at[1]}':>9} {edges:15} ({share:6.2%})  {verdict}")
    return good


def at_edge(layers, x, y):
    """Whether a ray through the next pixel meets something else, or something seen otherwise."""
    for j in range(max(y - 1, 0), min(y + 2, HEIGHT)):
        for i in range(max(x - 1, 0), min(x + 2, WIDTH)):
            if layers["object"][j][i] != layers["object"][y][x]:
                return True
            if layers["shadow"][j][i] != layers["shadow"][y][x]:
                return True
            normals = layers["normal"][j][i], layers["normal"][y][x]
            if any(normals[0]) and sum(p * q for p, q in zip(*normals)) < CREASE:
                return True
            for bounce in ("reflection", "transmission"):
                if any(abs(p - q) > JUMP for p, q in zip(layers[bounce][j][i], layers[bounce][y][x])):
                    return True
    return False


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")


def read_pfm(path):
    """Rows from top to bottom of tuples, whatever the number of channels."""
    kind, size, scale, data = path.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    channels = {b"PF": 3, b"Pf": 1}[kind]
    values = array("f", data)
    if (float(scale) < 0) != (sys.byteorder == "little"):
        values.byteswap()
    pixels = [tuple(values[at : at + channels]) for at in range(0, len(values), channels)]
    return [pixels[y * width : (y + 1) * width] for y in reversed(range(height))]


def read_png(path):
    """Rows of (r, g, b) in [0, 1] of a 16-bit RGB picture that is not interlaced, as POV-Ray writes it."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            assert (depth, color, interlaced) == (16, 2, 0), f"{path}: not 16-bit RGB"
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    raw, step, stride = zlib.decompress(packed), 6, width * 6
    rows, above = [], bytearray(stride)
    for y in range(height):
        start = y * (stride + 1)
        row = unfilter(raw[start], bytearray(raw[start + 1 : start + 1 + stride]), above, step)
        values = struct.unpack(f">{width * 3}H", row)
        rows.append([tuple(v / 65535 for v in values[i : i + 3]) for i in range(0, width * 3, 3)])
        above = row
    return rows


def unfilter(kind, row, above, step):
    for i in range(len(row)):
        left = row[i - step] if i >= step else 0
        corner = above[i - step] if i >= step else 0
        up = above[i]
        if kind == 1:
            guess = left
        elif kind == 2:
            guess = up
        elif kind == 3:
            guess = (left + up) // 2
        elif kind == 4:
            p = left + up - corner
            guess = min((left, up, corner), key=lambda v: abs(p - v))
        else:
            guess = 0
        row[i] = (row[i] + guess) & 255
    return row


if __name__ == "__main__":
    sys.exit(main())
