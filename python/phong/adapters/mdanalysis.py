"""Scenes from MDAnalysis."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

import phong

from ._atoms import AtomColors, Radii, add_bonds, add_cell, colors_of, per_atom, radii_of
from ._colors import warn
from ._need import need, wrong_type
from ._view import View

if TYPE_CHECKING:
    from MDAnalysis import AtomGroup, Universe

#: Colours of elements by the usual convention of molecular models; MDAnalysis has none of its own.
COLORS: Final = {
    "H": "#f2f2f2", "C": "#808080", "N": "#3355ee", "O": "#e02020", "S": "#e8c830",
    "P": "#f08020", "F": "#60d060", "CL": "#30c030", "BR": "#a03020", "I": "#802090",
    "NA": "#9050e0", "K": "#8040c8", "MG": "#208020", "CA": "#60a080", "ZN": "#7878a8",
    "FE": "#d07030", "CU": "#c88040", "MN": "#9070c0", "SE": "#f0a020",
}  # fmt: skip
_OTHER: Final = "#e060c0"


def from_mdanalysis(
    atoms: Universe | AtomGroup,
    frame: int | None = None,
    *,
    radii: Radii = "vdw",
    scale: float = 1.0,
    colors: AtomColors | None = None,
    bonds: float | None = None,
    cell: bool = False,
    material: phong.Material | None = None,
    view: View = "iso",
    up: str = "z",
) -> phong.Scene:
    """A framed Scene of a ``Universe`` or an ``AtomGroup``; lengths stay in ångström.

    ``frame``: of the trajectory, negative from its end; None is the current one. The trajectory
    stands where it stood afterwards. ``radii``: "vdw" (the table of MDAnalysis), one number,
    ``{"H": 0.3, …}``, or (N,) numbers; ``scale`` multiplies them. ``colors``: None is the usual
    ones of molecular models, else one colour, ``{"H": "#ffffff", …}``, or (N, 3) linear ones.
    ``bonds``: radius of the sticks for the bonds that the topology has; None is no bonds. ``cell``:
    the edges of the box as thin sticks. Elements that the topology lacks are guessed from the
    atoms' names, by MDAnalysis.

    Raises ImportError without MDAnalysis, TypeError for anything else, IndexError for a frame that
    the trajectory lacks, ValueError without atoms, without positions, for bonds that the topology
    lacks, and for an element that a table lacks.
    """
    caller = "from_mdanalysis"
    package = need("MDAnalysis", package="MDAnalysis", caller=caller)
    if not isinstance(atoms, package.Universe | package.AtomGroup):
        raise wrong_type(caller, "atoms", "MDAnalysis.Universe or AtomGroup", atoms)
    group: Any = atoms.atoms
    if len(group) == 0:
        raise ValueError(f"{caller}: atoms has no atom")
    trajectory = getattr(group.universe, "trajectory", None)
    if trajectory is None:
        raise ValueError(f"{caller}: atoms has no positions: its universe has no coordinates")
    positions, box = group.positions, trajectory.ts.triclinic_dimensions
    if frame is not None:
        if not -trajectory.n_frames <= frame < trajectory.n_frames:
            raise IndexError(
                f"{caller}: frame is {frame}; the trajectory has {trajectory.n_frames}"
            )
        stood = trajectory.frame
        step = trajectory[frame]
        positions, box = group.positions, step.triclinic_dimensions
        if stood != trajectory.frame:
            trajectory[stood]
    symbols = _elements(group)
    table = need("MDAnalysis.guesser.tables", package="MDAnalysis", caller=caller).vdwradii
    size = radii_of(
        radii, symbols, {"vdw": lambda s: float(table.get(s.upper(), np.nan))}, caller=caller
    )
    if colors is None:
        colors = {symbol: COLORS.get(symbol.upper(), _OTHER) for symbol in set(symbols)}
    painted = colors_of(colors, symbols, caller=caller)
    scene = phong.Scene()
    scene.add_spheres(positions, np.multiply(size, scale), colors=painted, material=material)
    if bonds is not None:
        if not hasattr(group, "bonds"):
            raise ValueError(
                f"{caller}: the topology has no bonds; atoms.guess_bonds() makes some, "
                "and bonds=None draws none"
            )
        pairs = group.intra_bonds.indices if len(group.intra_bonds) else np.zeros((0, 2), dtype=int)
        place = np.full(len(group.universe.atoms), -1)
        place[group.indices] = np.arange(len(group))
        first, second = place[pairs[:, 0]], place[pairs[:, 1]]
        each = per_atom(painted, len(group))
        add_bonds(
            scene,
            positions[first],
            positions[second],
            None if each is None else each[first],
            None if each is None else each[second],
            bonds,
            material,
        )
    if cell:
        if box is None or not np.any(box):
            warn(caller, "there is no box to draw")
        else:
            add_cell(scene, box, np.zeros(3), None)
    scene.frame(view, up)
    return scene


def _elements(group: Any) -> Sequence[str]:
    """Symbols of the elements, guessed where the topology has none."""
    symbols = [str(e) for e in group.elements] if hasattr(group, "elements") else [""] * len(group)
    if all(symbols):
        return symbols
    if not hasattr(group, "names"):
        types = [str(t) for t in group.types] if hasattr(group, "types") else [""] * len(group)
        return [symbol or kind for symbol, kind in zip(symbols, types, strict=True)]
    guesser = need("MDAnalysis.guesser", package="MDAnalysis", caller="from_mdanalysis")
    guess = guesser.DefaultGuesser(None).guess_atom_element
    known = {str(name): str(guess(str(name))) for name in set(group.names)}
    return [symbol or known[str(name)] for symbol, name in zip(symbols, group.names, strict=True)]
