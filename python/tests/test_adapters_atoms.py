"""Scenes of ASE, MDAnalysis and OVITO."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest
from drawing import covered, draw, need

import phong


@pytest.fixture
def ethanol() -> Any:
    need("ase")
    from ase.build import molecule

    return molecule("CH3CH2OH")


def test_a_molecule_of_ase_has_its_colours_and_radii(ethanol: Any) -> None:
    scene = phong.from_ase(ethanol)
    pixels = draw(scene, "ase")
    assert 0.1 < covered(pixels) < 0.9
    red = (pixels[..., 0] > 0.1) & (pixels[..., 0] > 4 * pixels[..., 1])
    assert red.any(), "oxygen is red"
    hit = phong.explain(phong.from_ase(ethanol, radii=0.01), 0, 0)
    assert hit is not None


def test_radii_and_colours_of_atoms_can_be_said_in_every_way(ethanol: Any) -> None:
    small = covered(draw(phong.from_ase(ethanol, radii=0.2, bonds=0.1), "ase-sticks"))
    large = covered(draw(phong.from_ase(ethanol, radii="vdw"), "ase-vdw"))
    assert small < large
    table = {"C": 0.5, "H": 0.3, "O": 0.4}
    each = phong.from_ase(ethanol, radii=[table[s] for s in ethanol.get_chemical_symbols()])
    assert np.array_equal(draw(phong.from_ase(ethanol, radii=table), "a"), draw(each, "b"))
    green = draw(phong.from_ase(ethanol, colors="#00ff00"), "ase-green")
    assert (green[..., 1] > 0.3).any()
    assert green[..., 0].max() < green[..., 1].max()
    colors = {"C": "#ff0000", "H": "#0000ff", "O": "#00ff00"}
    draw(phong.from_ase(ethanol, colors=colors, bonds=0.1, radii=0.3), "ase-colors")


def test_what_a_table_of_elements_lacks_is_named(ethanol: Any) -> None:
    with pytest.raises(ValueError, match="lack the element O"):
        phong.from_ase(ethanol, radii={"C": 1.0, "H": 1.0})
    with pytest.raises(ValueError, match="colors has none for the element"):
        phong.from_ase(ethanol, colors={"C": "#ffffff"})
    with pytest.raises(ValueError, match="wanted is one of covalent, vdw"):
        phong.from_ase(ethanol, radii="ionic")
    with pytest.raises(TypeError, match=r"wanted is ase\.Atoms"):
        phong.from_ase("CH4")  # type: ignore[arg-type]


def test_the_cell_of_a_crystal_is_drawn(ethanol: Any) -> None:
    from ase.build import bulk

    copper = bulk("Cu", cubic=True) * (3, 3, 3)
    with_cell, without = phong.from_ase(copper), phong.from_ase(copper, cell=False)
    assert len(with_cell.parts) == len(without.parts) + 1
    assert covered(draw(with_cell, "ase-cell")) > 0.1
    assert len(phong.from_ase(ethanol).parts) == 1, "there is no cell"


def test_a_package_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ase", None)
    with pytest.raises(ImportError, match="pip install ase"):
        phong.from_ase(None)  # type: ignore[arg-type]


@pytest.fixture
def water() -> Any:
    """Two waters in three frames, with bonds."""
    mda = need("MDAnalysis")
    universe = mda.Universe.empty(6, n_residues=2, atom_resindex=[0] * 3 + [1] * 3, trajectory=True)
    universe.add_TopologyAttr("names", ["OW", "HW1", "HW2"] * 2)
    universe.add_TopologyAttr("bonds", [(0, 1), (0, 2), (3, 4), (3, 5)])
    one = np.array([[0, 0, 0], [0.96, 0, 0], [-0.24, 0.93, 0]])
    frames = [np.concatenate([one, one + np.array([shift, 0, 0])]) for shift in (3.0, 4.0, 5.0)]
    universe.load_new(np.array(frames), order="fac")
    return universe


def test_a_universe_is_drawn_with_elements_guessed_from_names(water: Any) -> None:
    pixels = draw(phong.from_mdanalysis(water, bonds=0.15, scale=0.3), "mdanalysis")
    assert covered(pixels) > 0.05
    assert ((pixels[..., 0] > 0.1) & (pixels[..., 0] > 4 * pixels[..., 1])).any(), "oxygen is red"


def test_a_frame_of_a_trajectory_is_drawn_and_the_trajectory_stays_where_it_was(water: Any) -> None:
    first = draw(phong.from_mdanalysis(water), "mdanalysis-0")
    last = draw(phong.from_mdanalysis(water, frame=-1), "mdanalysis-2")
    assert water.trajectory.frame == 0
    assert not np.array_equal(first, last)
    with pytest.raises(IndexError, match="frame is 3; the trajectory has 3"):
        phong.from_mdanalysis(water, 3)


def test_a_group_of_atoms_is_drawn_alone(water: Any) -> None:
    group = water.select_atoms("name OW")
    assert len(group) == 2
    scene = phong.from_mdanalysis(group, bonds=0.1)
    assert len(scene.parts) == 1, "no bond has both its ends in it"
    draw(scene, "mdanalysis-group")
    with pytest.raises(ValueError, match="atoms has no atom"):
        phong.from_mdanalysis(water.select_atoms("name XX"))


@pytest.fixture
def copper() -> Any:
    need("ovito")
    need("ase")
    from ase.build import bulk
    from ovito.io.ase import ase_to_ovito  # type: ignore[import-not-found, unused-ignore]

    return ase_to_ovito(bulk("Cu", cubic=True) * (3, 3, 3))


def test_particles_bonds_and_cell_of_ovito_are_drawn(copper: Any) -> None:
    from ovito.modifiers import CreateBondsModifier
    from ovito.pipeline import Pipeline, StaticSource

    pipeline = Pipeline(source=StaticSource(data=copper))
    pipeline.modifiers.append(CreateBondsModifier(cutoff=2.7))
    scene = phong.from_ovito(pipeline, scale=0.5)
    # Balls, bonds, bonds over the cell's borders, and the cell.
    assert len(scene.parts) == 4
    assert covered(draw(scene, "ovito")) > 0.1
    bare = phong.from_ovito(pipeline, bonds=False, cell=False)
    assert len(bare.parts) == 1


def test_particles_of_their_own_colour_and_radius_keep_them(copper: Any) -> None:
    count = copper.particles.count
    copper.particles_.create_property("Color", data=np.tile([0.0, 1.0, 0.0], (count, 1)))
    copper.particles_.create_property("Radius", data=np.full(count, 0.5))
    pixels = draw(phong.from_ovito(copper, cell=False), "ovito-own")
    assert (pixels[..., 1] > 0.2).any()
    plain = pixels[..., 1] > 0.2
    assert pixels[..., 0][plain].max() < pixels[..., 1][plain].max()
    with pytest.raises(ValueError, match="a DataCollection is of one frame"):
        phong.from_ovito(copper, 1)
    with pytest.raises(TypeError, match="DataCollection or Pipeline"):
        phong.from_ovito([])  # type: ignore[arg-type]
