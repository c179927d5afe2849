"""Draws a benchmark scene with Mitsuba 3: `python3 mitsuba_peer.py SCENE.toml OUT.png`.

Reads the scene that bench/scenes.py writes for phong, with its PLY, and draws the same view, lights and shadows at one
sample a pixel. Mitsuba has no Phong material, so surfaces are diffuse, which is less work; the pictures differ in that.
"""

import sys
import tomllib
from pathlib import Path

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
from mitsuba import ScalarTransform4f as T  # noqa: E402 (there is none before the variant is set)

BLOCK = 1 << 16


def points(path):
    """Spheres from the binary PLY of `scenes.write_phong`."""
    data = path.read_bytes()
    head, body = data.split(b"end_header\n", 1)
    count = int(head.split(b"element vertex ")[1].split()[0])
    return np.frombuffer(body, [("at", "<f4", 3), ("radius", "<f4"), ("color", "u1", 3)], count)


def main():
    source, target = Path(sys.argv[1]), sys.argv[2]
    written = tomllib.loads(source.read_text())
    width, height = written["image"]["size"]
    camera = written["camera"]
    scene = {
        "type": "scene",
        "integrator": {"type": "direct", "emitter_samples": 2, "bsdf_samples": 0},
        "sensor": {
            "type": "perspective",
            "fov_axis": "y",
            "fov": camera["fov"],
            "to_world": T().look_at(camera["eye"], camera["look_at"], [0, 1, 0]),
            "film": {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"}},
            "sampler": {"type": "independent", "sample_count": 1},
        },
    }
    grey = lambda value: {"type": "diffuse", "reflectance": {"type": "rgb", "value": value}}
    for number, light in enumerate(written["light"]):
        if light["kind"] == "point":
            scene[f"light{number}"] = {"type": "point", "position": light["position"], "intensity": 40.0}
        else:
            scene[f"light{number}"] = {"type": "directional", "direction": light["direction"], "irradiance": 1.2}
    if "plane" in written:
        scene["floor"] = {
            "type": "rectangle",
            "to_world": T().rotate([1, 0, 0], -90).scale(200),
            "bsdf": grey(0.5),
        }
    for mesh in written.get("mesh", []):
        scene["mesh"] = {"type": "ply", "filename": str(source.parent / mesh["file"]), "bsdf": grey(0.5)}
    for cloud in written.get("points", []):
        for i, sphere in enumerate(points(source.parent / cloud["file"])):
            scene[f"s{i}"] = {
                "type": "sphere",
                "center": sphere["at"].tolist(),
                "radius": float(sphere["radius"]),
                "bsdf": grey(0.5),
            }
    picture = mi.render(mi.load_dict(scene), spp=1)
    mi.util.write_bitmap(target, picture)


if __name__ == "__main__":
    main()
