"""Scenes from meshio: finite-element meshes of forty formats."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

import phong

from ._colors import warn
from ._need import need, wrong_type
from ._painted import no_array, painted, thickness
from ._view import View

if TYPE_CHECKING:
    import meshio

_CALLER = "from_meshio"

Ints = npt.NDArray[np.int64]

# The faces of the solid cells by the numbers of their corners, counter-clockwise from outside.
_SOLIDS: Final[dict[str, list[tuple[int, ...]]]] = {
    "tetra": [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)],
    "pyramid": [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
    "wedge": [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
    "hexahedron": [
        (0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7),
    ],
}  # fmt: skip
# How many corners the kinds have whose further nodes are left out.
_CORNERS: Final = {
    "triangle": 3,
    "quad": 4,
    **{k: 1 + max(map(max, f)) for k, f in _SOLIDS.items()},
}


def from_meshio(
    mesh: meshio.Mesh,
    *,
    scalars: str | None = None,
    cmap: str = "viridis",
    clim: tuple[float, float] | None = None,
    nan: str | None = "#808080",
    color: npt.ArrayLike | str | None = None,
    radius: float | None = None,
    material: phong.Material | None = None,
    view: View = "iso",
    up: str = "z",
) -> phong.Scene:
    """A framed Scene of a ``meshio.Mesh``: faces, the outside of solid cells, lines, vertices.

    ``scalars``: name of an array of ``point_data`` or ``cell_data`` (numbers, or vectors by their
    length) that the colour map ``cmap`` of Matplotlib paints between the values ``clim`` (None: its
    least and greatest); None paints nothing. ``nan`` is the colour of NaN. ``color``: one colour,
    as the renderer takes it. Lines become sticks and vertices balls of ``radius``, None: 0.3 % of
    the diagonal. Of curved cells the corners are drawn, with a warning.

    Raises ImportError without meshio, TypeError for anything else, KeyError for an array that is
    not there, ValueError where there is nothing to draw.
    """
    package = need("meshio", package="meshio", caller=_CALLER)
    if not isinstance(mesh, package.Mesh):
        raise wrong_type(_CALLER, "mesh", "meshio.Mesh", mesh)
    points = np.asarray(mesh.points, dtype=np.float64)
    if points.shape[1] == 2:
        points = np.concatenate([points, np.zeros((len(points), 1))], axis=1)
    faces, face_cells, lines, line_cells, dots, dot_cells = _sort(mesh)
    if not len(faces) and not len(lines) and not len(dots):
        raise ValueError(
            f"{_CALLER}: mesh has no face, no solid cell, no line and no vertex to draw"
        )
    at_points, colors = True, None
    if scalars is not None:
        values, at_points = _array(mesh, scalars)
        colors = painted(values, cmap, clim, nan)
    span = float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0
    size = thickness(radius, span)
    scene = phong.Scene()
    if len(faces):
        if colors is not None and not at_points:
            scene.add_mesh(
                points[faces].reshape(-1, 3),
                np.arange(3 * len(faces)).reshape(-1, 3),
                colors=np.repeat(colors[face_cells], 3, axis=0),
                material=material,
            )
        else:
            used, corners = np.unique(faces, return_inverse=True)
            scene.add_mesh(
                points[used],
                corners.reshape(-1, 3),
                colors=color if colors is None else colors[used],
                material=material,
            )
    if len(lines):
        own = color if colors is None else colors[lines[:, 0] if at_points else line_cells]
        scene.add_cylinders(
            points[lines[:, 0]], points[lines[:, 1]], size, colors=own, material=material
        )
    if len(dots):
        own = color if colors is None else colors[dots if at_points else dot_cells]
        scene.add_spheres(points[dots], size, colors=own, material=material)
    scene.frame(view, up)
    return scene


def _array(mesh: meshio.Mesh, name: str) -> tuple[npt.NDArray[np.float64], bool]:
    """The named numbers or vectors, and whether they are of points."""
    if name in mesh.point_data:
        values, at_points = np.asarray(mesh.point_data[name], dtype=np.float64), True
    elif name in mesh.cell_data:
        values, at_points = (
            np.concatenate([np.asarray(v, dtype=np.float64) for v in mesh.cell_data[name]]),
            False,
        )
    else:
        raise no_array(_CALLER, name, [*mesh.point_data, *mesh.cell_data])
    return values, at_points


def _sort(mesh: meshio.Mesh) -> tuple[Ints, Ints, Ints, Ints, Ints, Ints]:
    """Triangles, lines and vertices, each with the numbers of the cells that they are of."""
    flat: list[tuple[Ints, Ints]] = []
    solid: list[tuple[Ints, Ints]] = []
    lines: list[tuple[Ints, Ints]] = []
    dots: list[tuple[Ints, Ints]] = []
    curved, unknown = set[str](), set[str]()
    first = 0
    for block in mesh.cells:
        number = np.arange(first, first + len(block.data))
        first += len(block.data)
        kind = block.type.rstrip("0123456789")
        if kind != block.type:
            curved.add(block.type)
        if kind == "polygon":
            for cell, corners in zip(number, block.data, strict=True):
                ring = np.asarray(corners, dtype=np.int64)[None]
                flat.append((ring, np.array([cell])))
            continue
        data = np.asarray(block.data, dtype=np.int64).reshape(len(number), -1)
        if kind in ("triangle", "quad"):
            flat.append((data[:, : _CORNERS[kind]], number))
        elif kind in _SOLIDS:
            solid += [(data[:, corners], number) for corners in _SOLIDS[kind]]
        elif kind == "line":
            lines.append((data[:, :2], number))
        elif kind == "vertex":
            dots.append((data[:, :1], number))
        else:
            unknown.add(block.type)
    if curved:
        warn(_CALLER, f"of curved cells ({', '.join(sorted(curved))}) only the corners are drawn")
    if unknown:
        warn(_CALLER, f"cells of these kinds are left out: {', '.join(sorted(unknown))}")
    flat += _outside(solid)
    fans = [(_fan(corners), np.repeat(cells, corners.shape[1] - 2)) for corners, cells in flat]
    faces, face_cells = _join(fans, 3)
    ends, line_cells = _join(lines, 2)
    single, dot_cells = _join(dots, 1)
    return faces, face_cells, ends, line_cells, single[:, 0], dot_cells


def _outside(sides: list[tuple[Ints, Ints]]) -> list[tuple[Ints, Ints]]:
    """The sides of solid cells that no other cell shares."""
    kept: list[tuple[Ints, Ints]] = []
    for corners in (3, 4):
        some = [side for side in sides if side[0].shape[1] == corners]
        if some:
            faces, cells = _join(some, corners)
            _, place, count = np.unique(
                np.sort(faces, axis=1), axis=0, return_inverse=True, return_counts=True
            )
            alone = count[place.reshape(-1)] == 1
            kept.append((faces[alone], cells[alone]))
    return kept


def _fan(corners: Ints) -> Ints:
    """Triangles of convex polygons of as many corners each, polygon by polygon."""
    count = corners.shape[1]
    order = np.array([(0, i, i + 1) for i in range(1, count - 1)], dtype=np.int64).reshape(-1, 3)
    return corners[:, order].reshape(-1, 3)


def _join(blocks: list[tuple[Ints, Ints]], corners: int) -> tuple[Ints, Ints]:
    """Blocks one after another."""
    if not blocks:
        return np.zeros((0, corners), dtype=np.int64), np.zeros(0, dtype=np.int64)
    return np.concatenate([b[0] for b in blocks]), np.concatenate([b[1] for b in blocks])
