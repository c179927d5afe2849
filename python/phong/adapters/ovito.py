"""Scenes from OVITO."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

import phong

from ._atoms import add_bonds, add_cell
from ._colors import decode, warn
from ._need import need, wrong_type
from ._view import View

if TYPE_CHECKING:
    from ovito.data import DataCollection
    from ovito.pipeline import Pipeline

_CALLER = "from_ovito"

Floats = npt.NDArray[np.float64]


def from_ovito(
    source: DataCollection | Pipeline,
    frame: int | None = None,
    *,
    scale: float = 1.0,
    bonds: bool = True,
    cell: bool = True,
    material: phong.Material | None = None,
    view: View = "iso",
    up: str = "z",
) -> phong.Scene:
    """A framed Scene of an OVITO ``DataCollection``, or of what a ``Pipeline`` computes at a frame.

    Radii and colours are OVITO's: a particle's own, else its type's, else the default of its visual
    element; ``scale`` multiplies the radii. Bonds are sticks of OVITO's width, each half in the
    colour of its atom, or in the bond's own. The cell is drawn as sticks. Every particle is drawn
    as a ball; surfaces, lines, vectors and dislocations are left out with a warning that names
    them.

    Raises ImportError without OVITO, TypeError for anything else, ValueError without particles, or
    for a frame of a DataCollection, which is of one frame.
    """
    package = need("ovito.data", package="ovito", caller=_CALLER)
    pipelines = need("ovito.pipeline", package="ovito", caller=_CALLER)
    given: Any = source
    collection: Any
    if isinstance(given, pipelines.Pipeline):
        collection = given.compute() if frame is None else given.compute(frame)
    elif not isinstance(given, package.DataCollection):
        raise wrong_type(_CALLER, "source", "ovito DataCollection or Pipeline", source)
    elif frame is not None:
        raise ValueError(f"{_CALLER}: frame is {frame}, but a DataCollection is of one frame")
    else:
        collection = given
    particles = collection.particles
    if particles is None or particles.count == 0:
        raise ValueError(f"{_CALLER}: there are no particles")
    undrawn = {
        type(thing).__name__
        for thing in collection.objects
        if isinstance(
            thing,
            package.SurfaceMesh
            | package.TriangleMesh
            | package.Lines
            | package.Vectors
            | package.VoxelGrid
            | package.DislocationNetwork,
        )
    }
    if undrawn:
        warn(_CALLER, f"left out: {', '.join(sorted(undrawn))}")
    positions = np.array(particles.positions, dtype=np.float64)
    colors = _colors(particles)
    scene = phong.Scene()
    scene.add_spheres(positions, _radii(particles) * scale, colors=colors, material=material)
    if bonds and particles.bonds is not None and particles.bonds.count:
        _add_bonds(scene, collection, positions, colors, material)
    if cell and collection.cell is not None:
        matrix = np.array(collection.cell[...], dtype=np.float64)
        vectors = matrix[:, :3].T
        if collection.cell.is2D:
            vectors[2] = (0.0, 0.0, 1e-3 * np.linalg.norm(vectors[:2]))
        width = float(collection.cell.vis.line_width)
        add_cell(scene, vectors, matrix[:, 3], width / 2 if width > 0 else None)
    scene.frame(view, up)
    return scene


def _types(container: Any, name: str) -> tuple[npt.NDArray[np.int64], dict[int, Any]]:
    """The number of each particle's type, and the types."""
    if name not in container:
        return np.zeros(container.count, dtype=np.int64), {}
    kinds = container[name]
    return np.array(kinds[...], dtype=np.int64), {kind.id: kind for kind in kinds.types}


def _radii(particles: Any) -> Floats:
    """As OVITO draws them: a radius of 0 is the next general one."""
    numbers, types = _types(particles, "Particle Type")
    default, scaling = float(particles.vis.radius), float(particles.vis.scaling)
    radii = np.full(particles.count, default)
    for number, kind in types.items():
        if kind.radius > 0:
            radii[numbers == number] = kind.radius
    if "Radius" in particles:
        own = np.array(particles["Radius"][...], dtype=np.float64)
        radii = np.where(own > 0, own, radii)
    return radii * scaling


def _colors(particles: Any) -> npt.NDArray[np.float32]:
    """As OVITO draws them; its colours are those of the screen."""
    if "Color" in particles:
        return decode(np.clip(particles["Color"][...], 0.0, 1.0))
    numbers, types = _types(particles, "Particle Type")
    colors = np.tile(np.array(particles.vis.default_color, dtype=np.float64), (particles.count, 1))
    for number, kind in types.items():
        colors[numbers == number] = kind.color
    return decode(colors)


def _add_bonds(
    scene: phong.Scene,
    collection: Any,
    positions: Floats,
    colors: npt.NDArray[np.float32],
    material: phong.Material | None,
) -> None:
    """Bonds; one over a border of the cell is two stubs, one at each of its atoms."""
    bonds = collection.particles.bonds
    pairs = np.array(bonds.topology[...], dtype=np.int64)
    first, second = pairs[:, 0], pairs[:, 1]
    shift = np.zeros((len(pairs), 3))
    if bonds.pbc_vectors is not None and collection.cell is not None:
        matrix = np.array(collection.cell[...], dtype=np.float64)[:, :3]
        shift = np.array(bonds.pbc_vectors[...], dtype=np.float64) @ matrix.T
    radius = float(bonds.vis.width) / 2
    starts, ends = positions[first], positions[second]
    one, other = colors[first], colors[second]
    if "Color" in bonds:
        one = other = decode(np.clip(bonds["Color"][...], 0.0, 1.0))
    within = (shift == 0).all(axis=1)
    add_bonds(scene, starts[within], ends[within], one[within], other[within], radius, material)
    over = ~within
    if over.any():
        half = (ends[over] + shift[over] - starts[over]) / 2
        scene.add_cylinders(
            np.concatenate([starts[over], ends[over]]),
            np.concatenate([starts[over] + half, ends[over] - half]),
            radius,
            colors=np.concatenate([one[over], other[over]]),
            material=material,
        )
