"""What atoms, bonds and cells become: spheres and cylinders."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Literal

import numpy as np
import numpy.typing as npt

import phong

from ._colors import decode

Floats = npt.NDArray[np.float64]

#: Radii of atoms: a table of elements, one number, a number an element, or one an atom.
Radii = Literal["covalent", "vdw"] | float | Mapping[str, float] | npt.ArrayLike
#: Colours of atoms: one colour, a colour an element (text or linear numbers), or one an atom.
AtomColors = str | Mapping[str, str] | npt.ArrayLike

# The corners of a cell that each of its twelve edges joins, in units of its vectors.
_EDGES = [
    (tuple(start), tuple(start[i] + (1 if i == axis else 0) for i in range(3)))
    for axis in range(3)
    for start in np.ndindex(2, 2, 2)
    if start[axis] == 0
]


def radii_of(
    radii: Radii,
    symbols: Sequence[str],
    tables: Mapping[str, Callable[[str], float]],
    *,
    caller: str,
) -> Floats | float:
    """One radius an atom, or one for all. A table answers NaN for an element that it lacks."""
    if isinstance(radii, str):
        if radii not in tables:
            raise ValueError(
                f"{caller}: radii is {radii!r}; wanted is one of {', '.join(tables)}, or numbers"
            )
        return _by_element(tables[radii], symbols, f"the {radii} radii", caller)
    if isinstance(radii, Mapping):
        return _by_element(lambda s: radii.get(s, np.nan), symbols, "radii", caller)
    array = np.asarray(radii, dtype=np.float64)
    return float(array) if array.ndim == 0 else array


def colors_of(colors: AtomColors, symbols: Sequence[str], *, caller: str) -> npt.ArrayLike:
    """What ``colors=`` of the renderer takes."""
    if not isinstance(colors, Mapping):
        return colors
    elements, place = np.unique(np.asarray(symbols, dtype=str), return_inverse=True)
    for element in elements:
        if str(element) not in colors:
            raise ValueError(f"{caller}: colors has none for the element {element}")
    return (
        np.stack([_hex(colors[str(e)], caller) for e in elements])[place]
        if len(elements)
        else np.zeros((0, 3))
    )


def add_bonds(
    scene: phong.Scene,
    starts: npt.ArrayLike,
    ends: npt.ArrayLike,
    start_colors: npt.NDArray[np.float32] | None,
    end_colors: npt.NDArray[np.float32] | None,
    radius: float,
    material: phong.Material | None,
) -> None:
    """Each bond as two half sticks, each in the colour of its atom; of None, one whole stick."""
    starts, ends = np.asarray(starts, dtype=np.float64), np.asarray(ends, dtype=np.float64)
    if len(starts) == 0:
        return
    if start_colors is None or end_colors is None:
        scene.add_cylinders(starts, ends, radius, material=material)
        return
    middles = (starts + ends) / 2
    scene.add_cylinders(
        np.concatenate([starts, ends]),
        np.concatenate([middles, middles]),
        radius,
        colors=np.concatenate([start_colors, end_colors]),
        material=material,
    )


def add_cell(
    scene: phong.Scene,
    vectors: npt.ArrayLike,
    origin: npt.ArrayLike,
    radius: float | None,
) -> None:
    """The edges of a cell, whose vectors are the rows; radius None: 0.2 % of its size."""
    rows, start = np.asarray(vectors, dtype=np.float64), np.asarray(origin, dtype=np.float64)
    corners = np.asarray(_EDGES, dtype=np.float64)
    points = corners @ rows + start
    thickness = 0.002 * float(np.linalg.norm(rows, axis=1).sum()) if radius is None else radius
    scene.add_cylinders(points[:, 0], points[:, 1], thickness, colors=np.full(3, 0.1))


def per_atom(colors: npt.ArrayLike | str, count: int) -> npt.NDArray[np.float32] | None:
    """Linear colours, one an atom, or None where there is one for all that is told by its name."""
    if isinstance(colors, str):
        return None
    array = np.asarray(colors)
    if array.dtype == np.uint8:
        array = decode(array / 255.0)
    return np.broadcast_to(array.astype(np.float32), (count, 3)) if array.ndim > 0 else None


def _by_element(
    radius: Callable[[str], float], symbols: Sequence[str], what: str, caller: str
) -> Floats:
    elements, place = np.unique(np.asarray(symbols, dtype=str), return_inverse=True)
    table = np.array([radius(str(element)) for element in elements], dtype=np.float64)
    for element, value in zip(elements, table, strict=True):
        if not np.isfinite(value):
            raise ValueError(
                f"{caller}: {what} lack the element {str(element) or '(none)'}; "
                "give radii as numbers"
            )
    return table[place]


def _hex(color: str, caller: str) -> npt.NDArray[np.float32]:
    text = color.removeprefix("#")
    try:
        if len(text) != 6:
            raise ValueError
        encoded = [int(text[i : i + 2], 16) / 255 for i in (0, 2, 4)]
    except ValueError:
        raise ValueError(f'{caller}: colors has {color!r}; wanted is "#rrggbb"') from None
    return decode(encoded)
