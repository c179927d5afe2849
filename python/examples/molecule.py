"""A molecule of ASE as balls and sticks, in colours by a number of each atom.

pip install phong ase matplotlib
python molecule.py
"""

from __future__ import annotations

from ase.build import molecule

import phong

atoms = molecule("C6H6")
image = phong.render(phong.from_ase(atoms, scale=0.6, bonds=0.12), size=(480, 360), samples=16)
image.save("benzene.png")

# The same atoms, coloured by how far they are from the middle.
distance = ((atoms.positions - atoms.positions.mean(axis=0)) ** 2).sum(axis=1) ** 0.5
colors = phong.from_matplotlib_colormap("viridis", distance)
scene = phong.from_ase(atoms, scale=0.6, bonds=0.12, colors=colors)
phong.render(scene, size=(480, 360), samples=16).save("benzene-distance.png")
