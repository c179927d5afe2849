"""Scenes from PyVista, and so from anything that VTK reads."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

import phong

from ._colors import opaque_bytes, warn
from ._need import need, wrong_type
from ._painted import lengths, no_array, painted, thickness
from ._view import View

if TYPE_CHECKING:
    import pyvista

_CALLER = "from_pyvista"


def from_pyvista(
    dataset: pyvista.DataSet | pyvista.MultiBlock,
    *,
    scalars: str | None = None,
    cmap: str = "viridis",
    clim: tuple[float, float] | None = None,
    nan: str | None = "#808080",
    color: npt.ArrayLike | str | None = None,
    radius: float | None = None,
    smooth: bool = True,
    material: phong.Material | None = None,
    view: View = "iso",
    up: str = "z",
) -> phong.Scene:
    """A framed Scene of a ``PolyData``, of the surface of any other data set, or of all blocks.

    ``scalars``: name of a point or cell array that the colour map ``cmap`` of Matplotlib paints,
    between the values ``clim`` (None: its least and greatest); None is the active one, where there
    is one. Arrays of three or four bytes are colours (sRGB). ``nan`` is the colour of NaN.
    ``color``: one colour instead, as the renderer takes it. Lines become round sticks and single
    points balls of ``radius``, None: 0.3 % of the diagonal. ``smooth``: the point normals that the
    data set has are used; False draws flat faces.

    Raises ImportError without PyVista (or Matplotlib, where a colour map is needed), TypeError for
    anything else, KeyError for an array that is not there, ValueError where there is nothing to
    draw.
    """
    package = need("pyvista", package="pyvista", caller=_CALLER)
    if not isinstance(dataset, package.DataSet | package.MultiBlock):
        raise wrong_type(_CALLER, "dataset", "pyvista.DataSet or MultiBlock", dataset)
    if isinstance(dataset, package.MultiBlock):
        blocks = list(dataset.recursive_iterator(skip_none=True))
    else:
        blocks = [dataset]
    blocks = [block for block in blocks if block.n_points > 0]
    if not blocks:
        raise ValueError(f"{_CALLER}: dataset has no point")
    if scalars is not None and not any(
        scalars in block.point_data or scalars in block.cell_data for block in blocks
    ):
        there = sorted(
            {name for b in blocks for name in [*b.point_data.keys(), *b.cell_data.keys()]}
        )
        raise no_array(_CALLER, scalars, there)
    corners = np.array(dataset.bounds, dtype=np.float64).reshape(3, 2)
    size = thickness(radius, float(np.linalg.norm(corners[:, 1] - corners[:, 0])))
    if clim is None:
        clim = _span(blocks, scalars)
    scene = phong.Scene()
    count = 0
    for block in blocks:
        surface = block if isinstance(block, package.PolyData) else _surface(block)

        def paint(
            values: npt.NDArray[Any] | None,
        ) -> npt.ArrayLike | str | None:
            if values is None:
                return None
            if values.ndim == 2 and values.shape[1] in (3, 4) and values.dtype == np.uint8:
                return opaque_bytes(values, caller=_CALLER)
            return painted(np.asarray(values), cmap, clim, nan)

        count += _add(scene, surface, scalars, color, paint, size, smooth, material)
    if count == 0:
        raise ValueError(f"{_CALLER}: dataset has no face, no line and no vertex to draw")
    scene.frame(view, up)
    return scene


def _surface(block: Any) -> Any:
    """The surface of a data set of any kind."""
    import warnings

    with warnings.catch_warnings():
        # The name of the default algorithm is about to change; either is right here.
        warnings.simplefilter("ignore")
        return block.extract_surface(pass_pointid=False, pass_cellid=False)


def _span(blocks: list[Any], scalars: str | None) -> tuple[float, float] | None:
    """The least and the greatest finite value in all blocks, so that they share one scale."""
    low, high = np.inf, -np.inf
    for block in blocks:
        values, _ = _array(block, scalars)
        if values is None or (values.ndim == 2 and values.dtype == np.uint8):
            continue
        sizes = lengths(values)
        finite = np.asarray(sizes, dtype=np.float64)[np.isfinite(sizes)]
        if finite.size:
            low, high = min(low, float(finite.min())), max(high, float(finite.max()))
    return (low, high) if low <= high else None


def _array(block: Any, scalars: str | None) -> tuple[npt.NDArray[Any] | None, bool]:
    """The array that is painted, and whether it is one of points."""
    name = block.active_scalars_name if scalars is None else scalars
    if name is None:
        return None, True
    if name in block.point_data:
        return np.asarray(block.point_data[name]), True
    if name in block.cell_data:
        return np.asarray(block.cell_data[name]), False
    return None, True


def _add(
    scene: phong.Scene,
    surface: Any,
    scalars: str | None,
    color: npt.ArrayLike | str | None,
    paint: Any,
    radius: float,
    smooth: bool,
    material: phong.Material | None,
) -> int:
    """The faces, lines and vertices of a PolyData; how many there were."""
    values, at_points = (None, True) if color is not None else _array(surface, scalars)
    colors = color if color is not None else paint(values)
    each = values is not None
    points = np.asarray(surface.points, dtype=np.float64)
    triangles = surface.triangulate()
    faces = np.asarray(triangles.regular_faces)
    # A PolyData numbers its cells in this order: vertices, lines, faces.
    lines, verts = _segments(surface.lines), _segments(surface.verts, single=True)
    if len(faces):
        own = triangles.point_data.get("Normals") if smooth else None
        normals = None if own is None else np.asarray(own)
        if each and not at_points:
            cells, _ = _array(triangles, scalars)
            own_colors = paint(None if cells is None else cells[-len(faces) :])
            scene.add_mesh(
                points[faces].reshape(-1, 3),
                np.arange(3 * len(faces)).reshape(-1, 3),
                normals=None if normals is None else normals[faces].reshape(-1, 3),
                colors=np.repeat(own_colors, 3, axis=0),
                material=material,
                smooth=smooth,
            )
        elif smooth:
            scene.add_mesh(points, faces, normals=normals, colors=colors, material=material)
        else:
            scene.add_mesh(
                points[faces].reshape(-1, 3),
                np.arange(3 * len(faces)).reshape(-1, 3),
                colors=np.asarray(colors)[faces].reshape(-1, 3) if each else colors,
                material=material,
                smooth=False,
            )
    if len(lines):
        pairs, cell = lines[:, :2], lines[:, 2] + surface.n_verts
        own_colors = colors
        if each and at_points:
            own_colors = np.asarray(colors)[pairs[:, 0]]
        elif each:
            own_colors = np.asarray(colors)[cell]
        scene.add_cylinders(
            points[pairs[:, 0]], points[pairs[:, 1]], radius, colors=own_colors, material=material
        )
    if len(verts):
        own_colors = (
            np.asarray(colors)[verts[:, 0] if at_points else verts[:, 2]] if each else colors
        )
        scene.add_spheres(points[verts[:, 0]], radius, colors=own_colors, material=material)
    if len(triangles.point_data) and "Texture Coordinates" in surface.point_data and values is None:
        warn(_CALLER, "textures are not taken over; colours come of scalars or of color=")
    return len(faces) + len(lines) + len(verts)


def _segments(cells: npt.ArrayLike, single: bool = False) -> npt.NDArray[np.int64]:
    """Rows of (from, to, cell) of VTK's lines, each a count and then that many points.

    ``single``: of vertices, where from and to are the same.
    """
    flat = np.asarray(cells, dtype=np.int64)
    rows: list[npt.NDArray[np.int64]] = []
    at = cell = 0
    while at < len(flat):
        count = int(flat[at])
        points = flat[at + 1 : at + 1 + count]
        start, end = (points, points) if single else (points[:-1], points[1:])
        rows.append(np.stack([start, end, np.full(len(start), cell)], axis=1))
        at, cell = at + 1 + count, cell + 1
    return np.concatenate(rows) if rows else np.zeros((0, 3), dtype=np.int64)
