#!/usr/bin/env python3
"""Counts and bounds of other people's files, as this program reads them and as other libraries do.

    python3 bench/files.py target/release/phong FOLDER... [--all] [--only ENDING]

with trimesh, scipy, networkx, gemmi, ase and numpy installed. Every file below the folders that both sides have
a reader for is read: meshes by trimesh (OBJ, PLY, STL, OFF, glTF), structures by gemmi (PDB, CIF), and
frames of atoms by ASE (XYZ, GRO, LAMMPS). Compared are the number of triangles, points and atoms, and the
corners of the box around their places. Told is a line for each file that differs, with what the program
says of the file, and the sums; exit 1 if something differs without a known reason.

Some rules of this program are applied to what the other library reads: of atoms at several places the
alternative of the highest occupancy is drawn, of several models or frames the first, and of a mesh no triangle
that uses a vertex twice. A difference that comes from what the other library does not read, or reads as
another thing, is said to be explained, with the reason.
"""

import argparse
import gzip
import json
import math
import re
import subprocess
import sys
import tempfile
import warnings
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

MESHES = ("obj", "ply", "stl", "off", "glb", "gltf")
STRUCTURES = ("pdb", "ent", "cif")
FRAMES = ("xyz", "gro", "lammpstrj", "dump", "data", "data2", "lmp")
RADIUS = 0.001
TWICE = re.compile(r"use a vertex twice: (\d+)")


@dataclass
class Holding:
    """What a file holds: how many of what, and between which corners."""

    triangles: int = 0
    points: int = 0
    lines: int = 0
    low: np.ndarray = field(default_factory=lambda: np.full(3, math.inf))
    high: np.ndarray = field(default_factory=lambda: np.full(3, -math.inf))
    notes: list[str] = field(default_factory=list)
    given: int = 0
    """Triangles with those that use a vertex twice."""

    def add(self, places: np.ndarray) -> None:
        places = np.asarray(places, float).reshape(-1, 3)
        if len(places):
            self.low = np.minimum(self.low, places.min(axis=0))
            self.high = np.maximum(self.high, places.max(axis=0))

    def told(self) -> str:
        counts = {"triangles": self.triangles, "points": self.points, "lines": self.lines}
        told = ", ".join(f"{count} {name}" for name, count in counts.items() if count)
        corners = [" ".join(f"{x:.6g}" for x in corner) for corner in (self.low, self.high)]
        return f"{told or 'nothing'} in [{corners[0]}] to [{corners[1]}]"


class Refused(Exception):
    """Why a reader does not take a file."""


def ending(path: Path) -> str:
    name = path.name.lower().removesuffix(".gz")
    return name.rsplit(".", 1)[-1] if "." in name else ""


def asked(program: str, path: Path, *more: str) -> dict:
    command = [program, *more[:1], str(path), "--json", *more[1:]]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    try:
        return json.loads(done.stdout)
    except ValueError:
        raise Refused(f"exit {done.returncode}: {first_line(done.stderr)}") from None


def first_line(text: str) -> str:
    lines = [line for line in text.splitlines() if line.strip()]
    return lines[0] if lines else "nothing is said"


def ours(program: str, path: Path) -> Holding:
    atoms = []
    if ending(path) in STRUCTURES + FRAMES:
        for key in ("style=spacefill", "select=all", f"radius={RADIUS}"):
            atoms += ["--set", f"molecule.1.{key}"]
    checked = asked(program, path, "check")
    told = [f"{d['severity']}: {d['message']}" for d in checked["diagnostics"]]
    if not checked["ok"]:
        error = next((line for line in told if line.startswith("error")), "nothing is said")
        if "there is nothing to draw" in error:
            return Holding(notes=told)
        raise Refused(error)
    try:
        info = asked(program, path, "info", *atoms)
    except Refused:
        # A plain point cloud with the ending of a molecule.
        info = asked(program, path, "info")
    holding = Holding(info["triangles"], info["spheres"], info["cylinders"], notes=told)
    if info["bounds"]:
        holding.low, holding.high = (np.array(corner, float) for corner in info["bounds"])
    return holding


def unpacked(path: Path, folder: str) -> Path:
    """The file, or if it is packed what it holds; some are named so and are not."""
    if path.suffix != ".gz":
        return path
    content = path.read_bytes()
    to = Path(folder) / path.name.removesuffix(".gz")
    to.write_bytes(gzip.decompress(content) if content.startswith(b"\x1f\x8b") else content)
    return to


def of_trimesh(path: Path) -> Holding:
    import trimesh

    kind = ending(path)
    with tempfile.TemporaryDirectory() as folder:
        path = unpacked(path, folder)
        scene = trimesh.load_scene(str(path), file_type=kind, process=False, merge_primitives=False)
    holding = Holding()
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        geometry = scene.geometry[name]
        places = np.asarray(geometry.vertices, float)
        if isinstance(geometry, trimesh.Trimesh):
            faces = np.asarray(geometry.faces).reshape(-1, 3)
            if kind == "stl":
                # Corners are vertices of their own there.
                _, same = np.unique(places.astype(np.float32), axis=0, return_inverse=True)
                corners = same.reshape(-1)[faces]
            else:
                corners = faces
            twice = (corners == np.roll(corners, 1, axis=1)).any(axis=1)
            faces = faces[~twice]
            holding.triangles += len(faces)
            holding.given += len(twice)
            places = places[np.unique(faces)] if len(faces) else places[:0]
        elif isinstance(geometry, trimesh.PointCloud):
            holding.points += len(places)
        else:
            holding.lines += sum(len(entity.points) - 1 for entity in geometry.entities)
        if places.shape[1] == 2:
            places = np.column_stack([places, np.zeros(len(places))])
        holding.add(places @ transform[:3, :3].T + transform[:3, 3])
    return holding


def of_gemmi(path: Path) -> Holding:
    import gemmi

    holding = Holding()
    if ending(path) == "cif":
        block = gemmi.cif.read(str(path)).sole_block()
        if not block.find_values("_atom_site.Cartn_x"):
            small = gemmi.make_small_structure_from_block(block)
            places = [small.cell.orthogonalize(site.fract).tolist() for site in small.sites]
            holding.points = len(places)
            holding.add(places)
            return holding
    with tempfile.TemporaryDirectory() as folder:
        structure = gemmi.read_structure(str(unpacked(path, folder)), merge_chain_parts=False)
    for chain in structure[0] if len(structure) else []:
        # Residues of one number and several names are alternatives of each other.
        groups: dict[object, list] = {}
        for residue in chain:
            groups.setdefault((str(residue.seqid), residue.segment), []).extend(residue)
        for group in groups.values():
            best: tuple[str, float] | None = None
            for atom in group:
                if atom.has_altloc() and (best is None or atom.occ > best[1]):
                    best = (atom.altloc, atom.occ)
            kept = [a for a in group if not a.has_altloc() or best is None or a.altloc == best[0]]
            holding.points += len(kept)
            holding.add([a.pos.tolist() for a in kept])
    return holding


def of_ase(path: Path) -> Holding:
    from ase.io import read

    kind = ending(path)
    formats = {"xyz": "extxyz", "gro": "gromacs", "lammpstrj": "lammps-dump-text", "dump": "lammps-dump-text"}
    name = formats.get(kind, "lammps-data")
    options = {"atom_style": style_of(path), "read_image_flags": False} if name == "lammps-data" else {}
    atoms = read(str(path), index=0, format=name, **options)
    holding = Holding(points=len(atoms))
    # Both draw GRO files in ångström.
    holding.add(atoms.get_positions())
    return holding


def style_of(path: Path) -> str:
    with (gzip.open if path.suffix == ".gz" else open)(path, "rt", errors="replace") as text:
        for line in text:
            if line.startswith("Atoms"):
                found = re.search(r"#\s*(\w+)", line)
                return found[1] if found else "full"
    return "full"


def differing(ours: Holding, theirs: Holding) -> list[str]:
    """In what they differ."""
    found = []
    for what in ("triangles", "points", "lines"):
        a, b = getattr(ours, what), getattr(theirs, what)
        if a != b:
            found.append(f"{a} {what}, not {b}")
    if theirs.low[0] > theirs.high[0]:
        return found
    size = max(np.abs(theirs.low).max(), np.abs(theirs.high).max(), 1e-30)
    grown = np.concatenate([theirs.low - ours.low, ours.high - theirs.high])
    # Spheres and sticks have a radius; what has no thickness has none.
    radius = grown.max() if ours.points or ours.lines else 0.0
    if not (np.abs(grown - radius) <= 2e-6 * size + 2e-6 * max(radius, 0)).all() or radius < -2e-6 * size:
        found.append("bounds by " + " ".join(f"{x:.3g}" for x in grown))
    return found


def reason(path: Path, ours: Holding, theirs: Holding) -> str | None:
    """Why they differ, if it is no fault of this program's."""
    kind = ending(path)
    within = (ours.low <= theirs.low + 1e-6).all() and (ours.high >= theirs.high - 1e-6).all()
    left_out = sum(int(n[1]) for note in ours.notes if (n := TWICE.search(note)))
    if left_out and ours.triangles + left_out == theirs.given:
        return "polygons are cut by their shape, not from their first corner, so that other triangles have no area"
    if any("lines are not drawn" in note for note in ours.notes) and not ours.triangles:
        return "lines of OBJ files are not drawn"
    if any("NaN or infinite" in note for note in ours.notes) and not np.isfinite(theirs.low).all():
        return "what has no place is left out"
    if path.suffix == ".gz" and b"ustar" in path.read_bytes()[:512]:
        return "an archive under the name of a packed file"
    if kind == "obj" and ours.points and not theirs.lines and ours.triangles == theirs.triangles:
        return "each vertex of a `p` is drawn as a point, also twice; trimesh has them once or not at all"
    if kind in ("gltf", "glb"):
        document = json_of(path)
        meshes = document.get("meshes", [])
        modes = {p.get("mode", 4) for mesh in meshes for p in mesh.get("primitives", [])}
        if modes & {1, 2, 3, 5, 6}:
            return "trimesh reads no strips, fans and loops, and takes pairs of lines for one line"
        if document.get("skins") and ours.triangles == theirs.triangles:
            return "skinned meshes are drawn as their joints rest; trimesh reads no skins"
        uses = Counter(node["mesh"] for node in document.get("nodes", []) if "mesh" in node)
        if within and ours.triangles == theirs.triangles and max(uses.values(), default=0) > 1:
            return "what is placed several times has the box around its turned box"
    if kind in ("lammpstrj", "dump") and ours.points == theirs.points:
        grown = np.concatenate([theirs.low - ours.low, ours.high - theirs.high]) - RADIUS
        if " xs ys zs" in path.read_text(errors="replace") and (abs(grown[:3] + grown[3:]) < 1e-2).all():
            return "ASE leaves the origin of the box out of places in shares of its edges"
    return None


def json_of(path: Path) -> dict:
    content = path.read_bytes()
    if content.startswith(b"glTF"):
        content = content[20 : 20 + int.from_bytes(content[12:16], "little")]
    return json.loads(content)


NAMES = ("agreed", "explained", "differs", "we refuse", "they refuse", "both refuse")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="the built phong")
    parser.add_argument("folders", nargs="+", type=Path, help="where the files are, at any depth")
    parser.add_argument("--all", action="store_true", help="a line for each file that agrees, too")
    parser.add_argument("--only", metavar="ENDING", help="files of this ending alone")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    known = {MESHES: of_trimesh, STRUCTURES: of_gemmi, FRAMES: of_ase}
    readers = {kind: reader for kinds, reader in known.items() for kind in kinds}
    verdicts: Counter = Counter()
    for folder in arguments.folders:
        for path in sorted(p for p in folder.rglob("*") if p.is_file()):
            kind = ending(path)
            if kind not in readers or arguments.only not in (None, kind) or is_other(path, kind):
                continue
            verdict, told = compared(arguments.program, path, readers[kind])
            verdicts[kind, verdict] += 1
            if arguments.all or verdict != "agreed":
                print(f"{verdict:<12} {path.relative_to(folder)}")
                for line in told:
                    print(f"             {line}")
    print()
    print("".join(f"{name:>12}" for name in ["", *NAMES]))
    for kind in sorted({kind for kind, _ in verdicts}):
        print(f"{kind:>12}" + "".join(f"{verdicts[kind, name]:>12}" for name in NAMES))
    total = {name: sum(n for (_, v), n in verdicts.items() if v == name) for name in NAMES}
    print(f"{'all':>12}" + "".join(f"{n:>12}" for n in total.values()))
    sys.exit(total["differs"] > 0)


def is_other(path: Path, kind: str) -> bool:
    """Whether a name's ending means something else there: entities of XML, and tables of other programs."""
    with path.open("rb") as file:
        head = file.read(4096)
    return (kind == "ent" and b"<!" in head) or (kind == "data" and b"atoms" not in head)


def compared(program: str, path: Path, reader) -> tuple[str, list[str]]:
    refusals = []
    try:
        mine = ours(program, path)
    except Refused as refused:
        mine = None
        refusals.append(f"we:   {refused}")
    try:
        other = reader(path)
    except Exception as error:  # whatever the library raises is its refusal
        other = None
        refusals.append(f"they: {type(error).__name__}: {first_line(str(error))}"[:160])
    if mine is None or other is None:
        names = {(True, True): "both refuse", (True, False): "we refuse", (False, True): "they refuse"}
        return names[mine is None, other is None], refusals + (mine.notes if mine else [])
    found = differing(mine, other)
    if not found:
        return "agreed", []
    why = reason(path, mine, other)
    both = [f"ours: {mine.told()}", f"them: {other.told()}", *mine.notes]
    return ("explained", [*found, why, *both]) if why else ("differs", [*found, *both])


if __name__ == "__main__":
    main()
