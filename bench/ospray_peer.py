"""Draws a benchmark scene with OVITO's OSPRay: `python3 ospray_peer.py SCENE.toml OUT.png [SAMPLES]`.

Reads the scene that bench/scenes.py writes for phong, with its PLY, and draws the same view at one sample a pixel, or
as many as are asked for, in one pass, not denoised. What differs is less work for OSPRay: OVITO has no point light, so
of the two lights it draws the distant one, with hard shadows; materials are its own. Paths end at what the camera sees,
and what is ambient in phong is a dim light all around, met by chance: dark where it is hidden, grainy where it is not.
"""

import math
import sys
import tomllib
from pathlib import Path

import numpy as np
from ovito.data import DataCollection, Particles, TriangleMesh
from ovito.pipeline import Pipeline, StaticSource
from ovito.vis import OSPRayRenderer, TriangleMeshVis, Viewport

from scenes import FLOOR, linear

# With these a lit sphere is about as bright as phong's.
SUN, AMBIENT = 3.0, 0.1


def unit(vector):
    return np.asarray(vector, float) / np.linalg.norm(vector)


def body(path, element):
    """What follows the header of the binary PLY of `scenes.write_phong`, and how many of its first element."""
    head, body = path.read_bytes().split(b"end_header\n", 1)
    return body, int(head.split(b"element %s " % element)[1].split()[0])


def spheres(path):
    rest, count = body(path, b"vertex")
    rows = np.frombuffer(rest, [("at", "<f4", 3), ("radius", "<f4"), ("color", "u1", 3)], count)
    particles = Particles(count=count)
    particles.create_property("Position", data=rows["at"])
    particles.create_property("Radius", data=rows["radius"])
    particles.create_property("Color", data=linear(np.arange(256))[rows["color"]])
    return particles


def triangles(points, faces, color, normals=None):
    mesh = TriangleMesh()
    mesh.set_vertices(points)
    mesh.set_faces(np.array(faces))  # a copy: it wants them writeable
    if normals is not None:
        mesh.set_normals(normals[faces.ravel()])
    mesh.vis = TriangleMeshVis(color=color)
    return mesh


def smooth(path, color):
    rest, count = body(path, b"vertex")
    vertices = np.frombuffer(rest, "<f4", 6 * count).reshape(-1, 6)
    faces = np.frombuffer(rest[vertices.nbytes :], [("n", "u1"), ("corner", "<i4", 3)])["corner"]
    return triangles(vertices[:, :3], faces, color, vertices[:, 3:])


def main():
    source, target = Path(sys.argv[1]), sys.argv[2]
    samples = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    written = tomllib.loads(source.read_text())
    data = DataCollection()
    for cloud in written.get("points", []):
        data.objects.append(spheres(source.parent / cloud["file"]))
    for mesh in written.get("mesh", []):
        data.objects.append(smooth(source.parent / mesh["file"], written["materials"]["body"]["color"]))
    if "plane" in written:
        square = 200 * np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]])
        data.objects.append(triangles(square, [[0, 1, 2], [0, 2, 3]], (FLOOR, FLOOR, FLOOR)))
    Pipeline(source=StaticSource(data=data)).add_to_scene()

    camera = written["camera"]
    ahead = unit(np.subtract(camera["look_at"], camera["eye"]))
    right = unit(np.cross(ahead, [0, 1, 0]))
    view = Viewport(type=Viewport.Type.Perspective, camera_pos=camera["eye"], camera_dir=ahead, camera_up=(0, 1, 0))
    view.fov = math.radians(camera["fov"])
    sun = -unit(next(light["direction"] for light in written["light"] if light["kind"] == "distant"))
    renderer = OSPRayRenderer(
        samples_per_pixel=samples,
        refinement_iterations=1,
        denoising_enabled=False,
        pixel_filter=0,
        max_ray_recursion=1,
        direct_light_angular_diameter=0,
        direct_light_intensity=SUN,
        ambient_brightness=AMBIENT,
    )
    view.render_image(
        size=written["image"]["size"],
        filename=target,
        background=written["image"]["background"],
        renderer=renderer,
        light_latitude=math.asin(sun @ np.cross(right, ahead)),
        light_longitude=math.atan2(sun @ right, -(sun @ ahead)),
    )


if __name__ == "__main__":
    main()
