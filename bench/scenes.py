"""The benchmark scenes, each written for phong, Tachyon and POV-Ray so that all three draw the same picture.

    slide        a plane and five spheres
    mesh         a mesh with smooth normals on a plane: a PLY file you name, else a knot of 860 thousand triangles
    spheres-N    a lattice of about N spheres (100k, 1m, 5m, 20m), each moved a little, in three sizes and four colours

All are 1920 x 1080 with one sample a pixel, one point and one distant light, hard shadows, and one Phong material:
ambient 0.1, diffuse 0.7, specular 0.3, exponent 40.
"""

import gzip
import math
import sys
from pathlib import Path

import numpy as np

SIZE = 1920, 1080
MATERIAL = {"k_a": 0.1, "k_d": 0.7, "k_s": 0.3, "shininess": 40}
BACKGROUND = (0.05, 0.06, 0.08)
# Bytes, for vertex colours are written so; everybody else gets what they decode to.
PALETTE = np.array([[222, 90, 78], [92, 150, 220], [236, 198, 92], [120, 186, 124]], np.uint8)
FLOOR = 0.6


def linear(byte):
    value = np.asarray(byte) / 255
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def slide():
    centers = np.array([[-3.0, 1.0, -0.6], [-1.3, 0.6, 1.2], [0.1, 1.3, -1.1], [1.6, 0.7, 1.0], [3.2, 0.9, -0.3]])
    return {
        "centers": centers,
        "radii": centers[:, 1].copy(),
        "colors": np.array([0, 1, 2, 3, 0]),
        "floor": True,
        "eye": (0.4, 2.4, 8.8),
        "look_at": (0, 0.8, 0),
        "fov": 39,
        "lamp": (-5, 7, 5),
        "sun": (-0.6, -1, -0.4),
    }


def spheres(nx, ny, nz):
    random = np.random.default_rng(2026)
    grid = np.stack(np.meshgrid(np.arange(nx), np.arange(ny), np.arange(nz), indexing="ij"), -1).reshape(-1, 3)
    centers = grid - (np.array([nx, ny, nz]) - 1) / 2 + random.uniform(-0.3, 0.3, grid.shape)
    reach = max(nx, ny, nz)
    return {
        "centers": centers.round(4),
        "radii": random.choice([0.35, 0.45, 0.55], len(grid)),
        "colors": random.integers(0, len(PALETTE), len(grid)),
        "floor": False,
        "eye": tuple(reach * np.array([1.05, 0.9, 1.7])),
        "look_at": (0, -0.06 * reach, 0),
        "fov": 40,
        "lamp": tuple(reach * np.array([-0.9, 1.7, 1.3])),
        "sun": (-1, -0.7, -0.4),
    }


def mesh(path=None):
    return dressed(*(read_ply(path) if path else knot(3600, 120)))


def dressed(points, faces):
    """The scene of a mesh, sized to 4, on a plane, with smooth normals."""
    low, high = points.min(0), points.max(0)
    points = (points - (low + high) / 2) * (4 / (high - low)[0])
    points[:, 1] -= points[:, 1].min()
    corners = points[faces]
    normals = np.zeros_like(points)
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    for corner in range(3):
        np.add.at(normals, faces[:, corner], across)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.where(length > 0, normals / np.maximum(length, 1e-300), [0, 1, 0])
    return {
        "points": points.astype(np.float32),
        "normals": normals.astype(np.float32),
        "faces": faces,
        "floor": True,
        "eye": (1.1, 2.5, 5.8),
        "look_at": (0, 1.2, 0),
        "fov": 38,
        "lamp": (-4, 6, 5),
        "sun": (-0.7, -1, -0.4),
    }


def knot(along, around):
    """A tube with grooves along a torus knot: 2 x `along` x `around` triangles."""
    t = np.linspace(0, 2 * math.pi, along, endpoint=False)
    line = np.stack([(2 + np.cos(3 * t)) * np.cos(2 * t), 0.9 * np.sin(3 * t), (2 + np.cos(3 * t)) * np.sin(2 * t)], 1)
    ahead = np.roll(line, -1, 0) - np.roll(line, 1, 0)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    side = np.cross(ahead, [0, 1, 0])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(side, ahead)
    a = np.linspace(0, 2 * math.pi, around, endpoint=False)
    radius = 0.42 + 0.03 * np.cos(9 * a[None, :] + 60 * t[:, None])
    ring = np.cos(a)[None, :, None] * side[:, None] + np.sin(a)[None, :, None] * up[:, None]
    points = (line[:, None] + radius[..., None] * ring).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(along), np.arange(around), indexing="ij")
    corner = lambda di, dj: ((i + di) % along * around + (j + dj) % around).ravel()
    first = np.stack([corner(0, 0), corner(0, 1), corner(1, 0)], 1)
    second = np.stack([corner(0, 1), corner(1, 1), corner(1, 0)], 1)
    return points, np.concatenate([first, second]).astype(np.int32)


def read_ply(path):
    """Positions and triangles of an ASCII or binary PLY whose vertices are floats and whose faces are triangles."""
    with (gzip.open if str(path).endswith(".gz") else open)(path, "rb") as file:
        header = []
        while not header or header[-1] != "end_header":
            header.append(file.readline().decode().strip())
        body = file.read()
    count = {line.split()[1]: int(line.split()[2]) for line in header if line.startswith("element")}
    layout = next(line.split()[1] for line in header if line.startswith("format"))
    columns = sum(line.startswith("property float") for line in header)
    if layout == "ascii":
        rows = body.split(b"\n")
        points = np.array([row.split()[:3] for row in rows[: count["vertex"]]], float)
        faces = [row.split()[1:4] for row in rows[count["vertex"] : count["vertex"] + count["face"]]]
        return points, np.array(faces, np.int32)
    order = "<" if "little" in layout else ">"
    points = np.frombuffer(body, order + "f4", count["vertex"] * columns).reshape(-1, columns)[:, :3]
    record = np.dtype([("n", "u1"), ("corner", order + "i4", 3)])
    faces = np.frombuffer(body[count["vertex"] * columns * 4 :], record, count["face"])
    return points.astype(float), faces["corner"].astype(np.int32)


SCENES = {
    "slide": slide,
    "mesh": mesh,
    "spheres-100k": lambda: spheres(50, 50, 40),
    "spheres-1m": lambda: spheres(100, 100, 100),
    "spheres-5m": lambda: spheres(200, 200, 125),
    "spheres-20m": lambda: spheres(320, 250, 250),
}

# Above this the other programs' texts and memory are beyond a small machine: only phong's scene is written.
MOST_FOR_OTHERS = 6_000_000


def numbers(values, between=" "):
    return between.join(f"{value:.7g}" for value in values)


def write_phong(scene, path):
    """A TOML scene, and beside it a binary PLY for what is many."""
    listed = lambda values: f"[{numbers(values, ', ')}]"
    material = "".join(f"{key} = {value}\n" for key, value in MATERIAL.items())
    text = f"# A benchmark scene.\nversion = 1\n\n[image]\nsize = {list(SIZE)}\nsamples = 1\n"
    text += f"background = {listed(BACKGROUND)}\n\n[camera]\neye = {listed(scene['eye'])}\n"
    text += f"look_at = {listed(scene['look_at'])}\nfov = {scene['fov']}\n\n"
    text += f'[[light]]\nkind = "point"\nposition = {listed(scene["lamp"])}\ncolor = 0.75\n\n'
    text += f'[[light]]\nkind = "distant"\ndirection = {listed(scene["sun"])}\ncolor = 0.4\n\n'
    text += f"[materials.floor]\ncolor = {FLOOR}\n{material}\n"
    text += f"[materials.body]\ncolor = {listed(linear(PALETTE[0]))}\n{material}\n"
    if scene["floor"]:
        text += '[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = "floor"\n\n'
    kind = "mesh" if "faces" in scene else "points"
    text += f'[[{kind}]]\nfile = "{path.stem}.ply"\nmaterial = "body"\n'
    path.write_text(text)
    if "faces" in scene:
        vertices = np.hstack([scene["points"], scene["normals"]]).astype("<f4")
        names, rows = "x y z nx ny nz".split(), np.empty(len(scene["faces"]), [("n", "u1"), ("corner", "<i4", 3)])
        rows["n"], rows["corner"] = 3, scene["faces"]
        properties = "".join(f"property float {name}\n" for name in names)
        properties += f"element face {len(rows)}\nproperty list uchar int vertex_indices\n"
        data = vertices.tobytes() + rows.tobytes()
    else:
        vertices = np.empty(len(scene["radii"]), [("at", "<f4", 3), ("radius", "<f4"), ("color", "u1", 3)])
        vertices["at"], vertices["radius"] = scene["centers"], scene["radii"]
        vertices["color"] = PALETTE[scene["colors"]]
        properties = "".join(f"property float {name}\n" for name in ("x", "y", "z", "radius"))
        properties += "".join(f"property uchar {name}\n" for name in ("red", "green", "blue"))
        data = vertices.tobytes()
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n{properties}end_header\n"
    path.with_suffix(".ply").write_bytes(head.encode() + data)


def write_tachyon(scene, path):
    """Its camera is left-handed, so everything is mirrored in x; its zoom is height over twice the distance."""
    mirror = lambda values: np.asarray(values, float) * [-1, 1, 1]
    look = mirror(scene["look_at"]) - mirror(scene["eye"])
    zoom = 0.5 / math.tan(math.radians(scene["fov"]) / 2)
    finish = (
        f"AMBIENT {MATERIAL['k_a']} DIFFUSE {MATERIAL['k_d']} SPECULAR 0 OPACITY 1 "
        f"PHONG PLASTIC {MATERIAL['k_s']} PHONG_SIZE {MATERIAL['shininess']}"
    )
    with path.open("w") as file:
        file.write(f"BEGIN_SCENE\nRESOLUTION {SIZE[0]} {SIZE[1]}\nCAMERA\nPROJECTION PERSPECTIVE\nZOOM {zoom:.9g}\n")
        file.write(f"ASPECTRATIO 1\nANTIALIASING 0\nRAYDEPTH 4\nCENTER {numbers(mirror(scene['eye']))}\n")
        file.write(f"VIEWDIR {numbers(look / np.linalg.norm(look))}\nUPDIR 0 1 0\nEND_CAMERA\n")
        file.write(f"BACKGROUND {numbers(BACKGROUND)}\n")
        file.write(f"LIGHT CENTER {numbers(mirror(scene['lamp']))} RAD 0.001 COLOR 0.75 0.75 0.75\n")
        sun = mirror(scene["sun"]) / np.linalg.norm(scene["sun"])
        file.write(f"DIRECTIONAL_LIGHT DIRECTION {numbers(sun)} COLOR 0.4 0.4 0.4\n")
        for index, color in enumerate(linear(PALETTE)):
            file.write(f"TEXDEF C{index} {finish} COLOR {numbers(color)} TEXFUNC 0\n")
        file.write(f"TEXDEF FLOOR {finish} COLOR {FLOOR} {FLOOR} {FLOOR} TEXFUNC 0\n")
        if scene["floor"]:
            file.write("PLANE CENTER 0 0 0 NORMAL 0 1 0 FLOOR\n")
        if "faces" in scene:
            file.write(f"VERTEXARRAY NUMVERTS {len(scene['points'])}\nCOORDS\n")
            np.savetxt(file, mirror(scene["points"]), "%.7g")
            file.write("NORMALS\n")
            np.savetxt(file, mirror(scene["normals"]), "%.6g")
            file.write(f"TEXTURE {finish} COLOR {numbers(linear(PALETTE[0]))} TEXFUNC 0\n")
            file.write(f"TRIMESH {len(scene['faces'])}\n")
            np.savetxt(file, scene["faces"][:, [0, 2, 1]], "%d")
            file.write("END_VERTEXARRAY\n")
        else:
            rows = zip(mirror(scene["centers"]).tolist(), scene["radii"].tolist(), scene["colors"].tolist())
            file.writelines(f"SPHERE CENTER {x:g} {y:g} {z:g} RAD {r:g} C{c}\n" for (x, y, z), r, c in rows)
        file.write("END_SCENE\n")


def write_povray(scene, path):
    vector = lambda values: f"<{numbers(values, ', ')}>"
    finish = (
        f"finish {{ ambient {MATERIAL['k_a']} diffuse {MATERIAL['k_d']} "
        f"phong {MATERIAL['k_s']} phong_size {MATERIAL['shininess']} }}"
    )
    with path.open("w") as file:
        file.write("#version 3.7;\nglobal_settings { assumed_gamma 1 }\n#default { " + finish + " }\n")
        file.write(f"background {{ rgb {vector(BACKGROUND)} }}\ncamera {{ location {vector(scene['eye'])} up y ")
        file.write(f"right -x*image_width/image_height direction z*0.5/tan(radians({scene['fov']})/2) ")
        file.write(f"look_at {vector(scene['look_at'])} }}\n")
        file.write(f"light_source {{ {vector(scene['lamp'])} rgb 0.75 }}\n")
        sun = -1e4 * np.asarray(scene["sun"])
        file.write(f"light_source {{ {vector(sun)} rgb 0.4 parallel point_at 0 }}\n")
        for index, color in enumerate(linear(PALETTE)):
            file.write(f"#declare C{index} = texture {{ pigment {{ rgb {vector(color)} }} }}\n")
        if scene["floor"]:
            file.write(f"plane {{ y, 0 pigment {{ rgb {FLOOR} }} }}\n")
        if "faces" in scene:
            for kind, rows, form in (
                ("vertex_vectors", scene["points"], "<%.7g,%.7g,%.7g>"),
                ("normal_vectors", scene["normals"], "<%.6g,%.6g,%.6g>"),
                ("face_indices", scene["faces"], "<%d,%d,%d>"),
            ):
                file.write(f"{'mesh2 { ' if kind == 'vertex_vectors' else ''}{kind} {{ {len(rows)},\n")
                np.savetxt(file, rows, form, newline=",\n")
                file.write("}\n")
            file.write("texture { C0 } }\n")
        else:
            rows = zip(scene["centers"].tolist(), scene["radii"].tolist(), scene["colors"].tolist())
            file.writelines(f"sphere{{<{x:g},{y:g},{z:g}>,{r:g} texture{{C{c}}}}}\n" for (x, y, z), r, c in rows)


def write(name, folder: Path, ply=None):
    """Writes a scene for every program; does nothing if it is there."""
    done = folder / f"{name}.pov"
    alone = folder / f"{name}.alone"
    if done.exists() or alone.exists():
        return
    scene = mesh(ply) if name == "mesh" else SCENES[name]()
    write_phong(scene, folder / f"{name}.toml")
    if len(scene.get("radii", ())) > MOST_FOR_OTHERS:
        alone.touch()
        return
    write_tachyon(scene, folder / f"{name}.dat")
    write_povray(scene, folder / f"{name}.pov.part")
    (folder / f"{name}.pov.part").rename(done)


if __name__ == "__main__":
    write(sys.argv[1], Path(sys.argv[2]), *sys.argv[3:])
