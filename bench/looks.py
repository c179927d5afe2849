#!/usr/bin/env python3
"""What a look costs: CPU time of a picture with it over that of the same picture without.

    cargo build --release && python3 bench/looks.py [textures,area,many,occlusion,cut,outline,bonds] [--ply dragon.ply.gz]
                                                    [--runs 5] [--phong PHONG] [--tachyon TACHYON] [--ovito PYTHON]

    textures    a mesh with an image as colour and another as normals; goal 1.4 at most
    area        a rectangle, disc or sphere as light; goal 1.3 of a point light at most; a box that glows, of twelve triangles
    many        64 lights that end (`range`, a spot's edge) over one of them, and over 64 that do not; goal: far less than 64
    occlusion   64 rays of ambient occlusion; with Tachyon, how many times as long that takes: goal 5 at least; with a Python
                that has OVITO, how long OSPRay takes for 16 samples, each of which meets the light around once: goal 2 at least
    cut         a `[[clip]]` through the mesh or the spheres
    outline     an `[outline]`
    bonds       a million bonds over as many balls that hide as much; goal 1.25 at most

Draws the benchmark scenes (bench/scenes.py, needs numpy) at 1920 x 1080. Pictures are drawn in turns, so that a busy machine
disturbs all alike; the least CPU time (user and system, of the whole program) of each counts.
"""

import argparse
import os
import re
import shutil
import struct
import sys
import zlib
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
import scenes
from road import ROOT, measure

CASES = "textures area many occlusion cut outline bonds".split()
LIGHT = re.compile(r"\[\[light\]\]\n(?:\w+ = .*\n)+\n")


def png(path, pixels):
    """An 8-bit RGB picture, written without another package."""
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    head = struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b""))


def images(folder):
    """Stripes and spots, and the normals of dimples, of 1024 x 1024 pixels."""
    y, x = np.mgrid[0:1024, 0:1024] * (2 * np.pi / 64)
    stripes = 0.5 + 0.5 * np.stack([np.sin(x), np.cos(2 * y), np.sin(x + y)], -1)
    png(folder / "color.png", (60 + 180 * stripes).astype(np.uint8))
    slope = np.stack([0.3 * np.cos(x) * np.sin(y), 0.3 * np.sin(x) * np.cos(y), np.ones_like(x)], -1)
    slope /= np.linalg.norm(slope, axis=-1, keepdims=True)
    png(folder / "normal.png", (127.5 + 127.5 * slope).round().astype(np.uint8))


def base(name, folder, ply=None):
    """The text of a benchmark scene; what is many lies beside it."""
    scene = scenes.mesh(ply) if name == "mesh" else scenes.SCENES[name]()
    scenes.write_phong(scene, folder / f"{name}.toml")
    return scene, (folder / f"{name}.toml").read_text()


def with_coordinates(scene, path):
    """The mesh once more, with texture coordinates: around it, and upwards."""
    points, normals = scene["points"], scene["normals"]
    uv = np.stack([np.arctan2(points[:, 0], points[:, 2]) * (4 / np.pi), 2 * points[:, 1]], -1)
    vertices = np.hstack([points, normals, uv]).astype("<f4")
    rows = np.empty(len(scene["faces"]), [("n", "u1"), ("corner", "<i4", 3)])
    rows["n"], rows["corner"] = 3, scene["faces"]
    properties = "".join(f"property float {name}\n" for name in "x y z nx ny nz s t".split())
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n{properties}"
    head += f"element face {len(rows)}\nproperty list uchar int vertex_indices\nend_header\n"
    path.write_bytes(head.encode() + vertices.tobytes() + rows.tobytes())


def textures(folder, ply):
    scene, plain = base("mesh", folder, ply)
    images(folder)
    with_coordinates(scene, folder / "textured.ply")
    plain = plain.replace("mesh.ply", "textured.ply").replace("samples = 1", "samples = 4")
    given = "".join(f'[textures.{name}]\nkind = "image"\nfile = "{name}.png"\n\n' for name in ("color", "normal"))
    body = plain.index("[materials.body]")
    colored = plain[:body] + re.sub(r"color = .*", 'color = { texture = "color" }', plain[body:], count=1) + given
    both = colored.replace('{ texture = "color" }\n', '{ texture = "color" }\nnormal = { texture = "normal" }\n')
    return {"plain": plain, "color": colored, "color, normal": both}


def area(folder, ply):
    kinds = {"point": "", "rectangle": "width = 2\nheight = 1\n", "disc": "radius = 0.8\n", "sphere": "radius = 0.8\n"}
    corners = "".join(f"{x} {y} {z}\n" for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5))
    sides = "4 0 1 3 2\n4 4 6 7 5\n4 0 4 5 1\n4 2 3 7 6\n4 0 2 6 4\n4 1 5 7 3\n"
    (folder / "lamp.off").write_text(f"OFF\n8 6 12\n{corners}{sides}")
    texts = {}
    for name, samples in (("slide", 16), ("mesh", 4)):
        text = LIGHT.sub("", base(name, folder, ply)[1]).replace("samples = 1", f"samples = {samples}")
        for kind, keys in kinds.items():
            toward = "direction = [5, -6, -5]\n" if kind in ("rectangle", "disc") else ""
            light = f'\n[[light]]\nkind = "{kind}"\nposition = [-5, 7, 5]\n{toward}{keys}'
            texts[f"{name}, {kind}"] = text + light
        lamp = '\n[[mesh]]\nfile = "lamp.off"\nname = "lamp"\ntranslate = [-5, 7, 5]\n'
        texts[f"{name}, mesh"] = text + lamp + '\n[[light]]\nkind = "mesh"\nobject = "lamp"\n'
    return texts


def many(folder, _):
    text = LIGHT.sub("", base("slide", folder)[1])
    places = [(i - 3.5, j - 3.5) for j in range(8) for i in range(8)]
    point = lambda x, z, more: f'\n[[light]]\nkind = "point"\nposition = [{1.5 * x}, 1.6, {1.5 * z}]\ncolor = 0.5\n{more}'
    spot = lambda x, z: (
        f'\n[[light]]\nkind = "spot"\nposition = [{1.5 * x}, 4, {1.5 * z}]\ntarget = [{1.5 * x}, 0, {1.5 * z}]\n'
        "color = 0.5\ncone = 12\nedge = 18\n"
    )
    return {
        "one light": text + point(0.5, 0.5, ""),
        "64": text + "".join(point(x, z, "") for x, z in places),
        "64, range 2.5": text + "".join(point(x, z, "range = 2.5\n") for x, z in places),
        "64 spots": text + "".join(spot(x, z) for x, z in places),
    }


def occlusion(folder, ply):
    texts = {}
    for name in ("spheres-100k", "mesh"):
        scene, text = base(name, folder, ply)
        scenes.write_tachyon(scene, folder / f"{name}.dat")
        texts[f"{name}, plain"] = text
        texts[f"{name}, occlusion"] = text + "\n[ambient_occlusion]\nsamples = 64\n"
    return texts


def cut(folder, ply):
    texts = {}
    for name, point in (("mesh", [0, 1.2, 0]), ("spheres-1m", [0, 0, 0])):
        text = base(name, folder, ply)[1]
        texts[f"{name}, plain"] = text
        texts[f"{name}, cut"] = f"{text}\n[[clip]]\npoint = {point}\nnormal = [0.2, 0.1, 1]\n"
    return texts


def outline(folder, ply):
    texts = {}
    for name in ("slide", "mesh"):
        text = base(name, folder, ply)[1]
        texts[f"{name}, plain"], texts[f"{name}, outline"] = text, text + "\n[outline]\n"
    return texts


def bonds(folder, _):
    """Bonds all over a cube and about eight radii long, and balls; both hide about as much."""
    random, count = np.random.default_rng(1), 1_000_000
    middle = (random.random((count, 3)) * 2 - 1).astype("<f4")
    along = random.normal(size=(count, 3))
    along *= 0.008 / np.linalg.norm(along, axis=1)[:, None]
    ends = np.stack([middle - along, middle + along], 1).astype("<f4")
    edges = np.zeros(count, [("ends", "<i4", 2), ("radius", "<f4")])
    edges["ends"] = np.arange(2 * count).reshape(-1, 2)
    edges["radius"] = 0.002 * (0.5 + random.random(count))
    balls = np.hstack([middle, 0.004 * (0.5 + random.random((count, 1)))]).astype("<f4")
    head = "ply\nformat binary_little_endian 1.0\nelement vertex {}\n" + "".join(f"property float {c}\n" for c in "xyz")
    edge = f"element edge {count}\nproperty int vertex1\nproperty int vertex2\nproperty float radius\nend_header\n"
    (folder / "bonds.ply").write_bytes((head.format(2 * count) + edge).encode() + ends.tobytes() + edges.tobytes())
    (folder / "balls.ply").write_bytes((head.format(count) + "property float radius\nend_header\n").encode() + balls.tobytes())
    text = "version = 1\n[image]\nsize = [1920, 1080]\nsamples = 4\n[camera]\neye = [2.2, 1.5, 3]\nlook_at = [0, 0, 0]\n"
    text += '[[light]]\nkind = "point"\nposition = [4, 5, 6]\n'
    texts = {}
    for occluded in ("", "[ambient_occlusion]\nsamples = 4\n"):
        for name, kind in (("balls", "points"), ("bonds", "cylinders")):
            words = f"{name}{', occlusion' if occluded else ''}"
            texts[words] = f'{text}{occluded}[[{kind}]]\nfile = "{name}.ply"\nradius = 0.003\n'
    return texts


def base_of(name, names):
    """The picture that another one is held against: the same scene without the look."""
    scene, _, look = name.partition(", ")
    for plain in ("plain", "point"):
        if f"{scene}, {plain}" in names:
            return f"{scene}, {plain}"
    if scene == "bonds":
        return name.replace("bonds", "balls")
    return names[0] if scene != "balls" else name


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cases", nargs="?", default=",".join(CASES), help="default: %(default)s")
    parser.add_argument("--ply", type=Path, help="the mesh to draw (default: a knot made on the spot)")
    parser.add_argument("--runs", type=int, default=5, help="default: %(default)s")
    parser.add_argument("--threads", type=int, default=os.cpu_count(), help="default: all")
    parser.add_argument("--phong", default=str(ROOT / "target/release/phong"), help="the program")
    parser.add_argument("--tachyon", default=shutil.which("tachyon"), help="Tachyon, for ambient occlusion")
    parser.add_argument("--ovito", help="a Python that has OVITO, for OSPRay's ambient occlusion")
    parser.add_argument("--folder", type=Path, default=ROOT / "target/looks", help="where scenes and pictures go")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    print("| case | picture | CPU s | ratio |\n|---|---|---|---|")
    for case in options.cases.split(","):
        if case not in CASES:
            parser.error(f"no {case}: cases are {', '.join(CASES)}")
        texts = globals()[case](options.folder, options.ply)
        lines = {}
        for number, (name, text) in enumerate(texts.items()):
            path = options.folder / f"{case}-{number}.toml"
            path.write_text(text)
            lines[name] = [options.phong, "render", str(path), "-o", str(path.with_suffix(".png")), "--quiet", f"--threads={options.threads}"]
        if case == "occlusion" and options.tachyon:
            for name in ("spheres-100k", "mesh"):
                picture = options.folder / f"{name}.tachyon.png"
                lines[f"{name}, Tachyon"] = [
                    *(options.tachyon, str(options.folder / f"{name}.dat"), "-numthreads", str(options.threads), "-shade_phong"),
                    *("-format", "PNG", "-aasamples", "0", "-add_skylight", "0.5", "-skylight_samples", "64", "-o", str(picture)),
                ]
        if case == "occlusion" and options.ovito:
            for name in ("spheres-100k", "mesh"):
                peer, picture = ROOT / "bench/ospray_peer.py", options.folder / f"{name}.ospray.png"
                lines[f"{name}, OSPRay"] = [options.ovito, str(peer), str(options.folder / f"{name}.toml"), str(picture), "16"]
        least = dict.fromkeys(lines, float("inf"))
        for _ in range(options.runs):
            for name, line in lines.items():
                least[name] = min(least[name], measure(line)[1])
        for name, seconds in least.items():
            is_peer = name not in texts
            other = f"{name.partition(', ')[0]}, occlusion" if is_peer else base_of(name, list(texts))
            print(f"| {case} | {name} | {seconds:.2f} | {seconds / least[other]:.2f} of {other} |", flush=True)


if __name__ == "__main__":
    main()
