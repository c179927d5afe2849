"""Scenes from the Atomic Simulation Environment."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import phong

from ._atoms import AtomColors, Radii, add_bonds, add_cell, colors_of, per_atom, radii_of
from ._colors import decode
from ._need import need, wrong_type
from ._view import View

if TYPE_CHECKING:
    from ase import Atoms


def from_ase(
    atoms: Atoms,
    *,
    radii: Radii = "covalent",
    scale: float = 1.0,
    colors: AtomColors | None = None,
    bonds: float | None = None,
    cell: bool = True,
    material: phong.Material | None = None,
    view: View = "iso",
    up: str = "z",
) -> phong.Scene:
    """A framed Scene of an ``ase.Atoms``; lengths stay in its unit, ångström.

    ``radii``: "covalent" or "vdw" (the tables of ``ase.data``), one number, ``{"H": 0.3, …}``, or
    (N,) numbers; ``scale`` multiplies them. ``colors``: None is ASE's own (Jmol's), else one
    colour, ``{"H": "#ffffff", …}``, or (N, 3) linear ones. ``bonds``: radius of the sticks between
    atoms that are nearer than the sum of their covalent radii and 0.3 Å, across the cell's borders
    not; None is no bonds. ``cell``: its edges as thin sticks, where it has a volume.

    Raises ImportError without ASE, TypeError for anything but Atoms, ValueError without atoms and
    for an element that a table lacks.
    """
    caller = "from_ase"
    ase = need("ase", package="ase", caller=caller)
    if not isinstance(atoms, ase.Atoms):
        raise wrong_type(caller, "atoms", "ase.Atoms", atoms)
    if len(atoms) == 0:
        raise ValueError(f"{caller}: atoms has no atom")
    tables = need("ase.data", package="ase", caller=caller)
    number = tables.atomic_numbers
    symbols = atoms.get_chemical_symbols()
    size = radii_of(
        radii,
        symbols,
        {
            "covalent": lambda symbol: float(tables.covalent_radii[number[symbol]]),
            "vdw": lambda symbol: float(tables.vdw_radii[number[symbol]]),
        },
        caller=caller,
    )
    if colors is None:
        jmol = need("ase.data.colors", package="ase", caller=caller).jmol_colors
        painted = decode(jmol)[atoms.numbers]
    else:
        painted = colors_of(colors, symbols, caller=caller)
    scene = phong.Scene()
    scene.add_spheres(atoms.positions, np.multiply(size, scale), colors=painted, material=material)
    if bonds is not None:
        neighbors = need("ase.neighborlist", package="ase", caller=caller)
        cutoffs = tables.covalent_radii[atoms.numbers] + 0.15
        first, second, shift = neighbors.neighbor_list("ijS", atoms, cutoffs)
        once = (first < second) & (shift == 0).all(axis=1)
        first, second = first[once], second[once]
        each = per_atom(painted, len(atoms))
        add_bonds(
            scene,
            atoms.positions[first],
            atoms.positions[second],
            None if each is None else each[first],
            None if each is None else each[second],
            bonds,
            material,
        )
    if cell and atoms.cell.rank == 3:
        add_cell(scene, atoms.cell.array, np.zeros(3), None)
    scene.frame(view, up)
    return scene
