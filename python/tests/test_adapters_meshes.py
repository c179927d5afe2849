"""Scenes of trimesh, PyVista and meshio, and the colour maps of Matplotlib."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawing import covered, draw, need

import phong


def test_a_mesh_of_trimesh_keeps_the_colours_of_vertices_and_of_faces() -> None:
    trimesh = need("trimesh")
    ball = trimesh.creation.icosphere(subdivisions=3)
    plain = draw(phong.from_trimesh(ball), "trimesh")
    assert 0.1 < covered(plain) < 0.9
    ball.visual.vertex_colors = np.tile([255, 0, 0, 255], (len(ball.vertices), 1))
    red = draw(phong.from_trimesh(ball), "trimesh-red")
    assert red[..., 0].max() > 2 * plain[60, 80, 1] * 0.1
    assert red[60, 80, 0] > 4 * red[60, 80, 1]
    box = trimesh.creation.box()
    box.visual.face_colors = (
        [[255, 0, 0, 255]] * 4 + [[0, 255, 0, 255]] * 4 + [[0, 0, 255, 255]] * 4
    )
    faces = draw(phong.from_trimesh(box), "trimesh-faces")
    for channel in (1, 2):  # the red faces are behind
        others = [c for c in range(3) if c != channel]
        assert (faces[..., channel] > 5 * faces[..., others].max(axis=-1)).any()


def test_a_scene_of_trimesh_places_one_geometry_at_many_places() -> None:
    trimesh = need("trimesh")
    graph = trimesh.Scene()
    ball = trimesh.creation.icosphere()
    move = trimesh.transformations.translation_matrix
    graph.add_geometry(ball, node_name="a", geom_name="ball")
    for index in range(1, 4):
        graph.graph.update(frame_to=f"b{index}", matrix=move([3 * index, 0, 0]), geometry="ball")
    graph.add_geometry(trimesh.creation.box(), transform=move([0, 3, 0]))
    scene = phong.from_trimesh(graph)
    assert len(scene.parts) == 5
    draw(scene, "trimesh-scene")
    alone = phong.from_trimesh(trimesh.PointCloud(np.random.default_rng(1).normal(size=(200, 3))))
    assert covered(draw(alone, "trimesh-points")) > 0.001


def test_what_is_no_mesh_or_has_nothing_to_draw_is_said() -> None:
    trimesh = need("trimesh")
    with pytest.raises(TypeError, match=r"trimesh\.Trimesh, PointCloud or Scene"):
        phong.from_trimesh(3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="the scene places no geometry"):
        phong.from_trimesh(trimesh.Scene())
    with pytest.raises(ValueError, match="no face"):
        phong.from_trimesh(trimesh.Trimesh())


def test_the_surface_of_any_data_set_of_pyvista_is_painted_by_its_scalars() -> None:
    pyvista = need("pyvista")
    grid = pyvista.ImageData(dimensions=(12, 12, 12))
    grid["height"] = grid.points[:, 2]
    pixels = draw(phong.from_pyvista(grid, scalars="height"), "pyvista-grid")
    assert covered(pixels) > 0.1
    # Viridis is violet below and yellow above.
    assert (pixels[..., 0] > 3 * pixels[..., 2]).any()
    assert (pixels[..., 2] > 2 * pixels[..., 1]).any()
    cells = pyvista.ImageData(dimensions=(5, 5, 5))
    cells.cell_data["v"] = np.arange(64.0)
    draw(phong.from_pyvista(cells, scalars="v", cmap="plasma"), "pyvista-cells")
    with pytest.raises(KeyError, match="there is no array 'w'; there are v"):
        phong.from_pyvista(cells, scalars="w")


def test_lines_points_blocks_and_smooth_surfaces_of_pyvista_are_drawn() -> None:
    pyvista = need("pyvista")
    ball = pyvista.Sphere()
    assert 0.1 < covered(draw(phong.from_pyvista(ball, color="#c8402f"), "pyvista-sphere")) < 0.9
    spiral = pyvista.Spline(
        np.stack([np.cos(t := np.linspace(0, 20, 200)), np.sin(t), t / 5], axis=1)
    )
    assert covered(draw(phong.from_pyvista(spiral, radius=0.1), "pyvista-line")) > 0.02
    cloud = pyvista.PolyData(np.random.default_rng(1).normal(size=(100, 3)))
    cloud["v"] = np.arange(100.0)
    assert (
        covered(draw(phong.from_pyvista(cloud, scalars="v", radius=0.1), "pyvista-points")) > 0.02
    )
    blocks = pyvista.MultiBlock([ball, pyvista.Cube(center=(2, 0, 0))])
    assert len(phong.from_pyvista(blocks).parts) == 2
    flat = draw(phong.from_pyvista(ball, smooth=False), "pyvista-flat")
    assert not np.array_equal(flat, draw(phong.from_pyvista(ball), "pyvista-smooth"))
    with pytest.raises(ValueError, match="no point"):
        phong.from_pyvista(pyvista.PolyData())


def cube() -> Any:
    meshio = need("meshio")
    points = [[x, y, z] for z in (0.0, 1.0, 2.0) for y in (0.0, 1.0) for x in (0.0, 1.0)]
    low = [0, 1, 3, 2]
    cells = [
        ("hexahedron", [low + [4 + i for i in low], [4 + i for i in low] + [8 + i for i in low]])
    ]
    return meshio.Mesh(
        points, cells, point_data={"z": [p[2] for p in points]}, cell_data={"c": [[0.0, 1.0]]}
    )


def test_the_outside_of_solid_cells_of_meshio_is_drawn() -> None:
    mesh = cube()
    scene = phong.from_meshio(mesh)
    assert 0.1 < covered(draw(scene, "meshio")) < 0.9
    # Ten squares are outside, the one between the two cells is not.
    from phong.adapters import meshio as adapter

    faces, *_ = adapter._sort(mesh)
    assert len(faces) == 20
    points = np.asarray(mesh.points)
    a, b, c = (points[faces[:, i]] for i in range(3))
    outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), (a + b + c) / 3 - points.mean(axis=0))
    assert (outward > 0).all()
    draw(phong.from_meshio(mesh, scalars="z"), "meshio-points")
    by_cell = draw(phong.from_meshio(mesh, scalars="c"), "meshio-cells")
    assert (by_cell[..., 0] > 3 * by_cell[..., 2]).any()


def test_faces_lines_vertices_and_unknown_cells_of_meshio_are_drawn_or_told() -> None:
    meshio = need("meshio")
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1.0]]
    cells = [
        ("triangle", [[0, 1, 4]]), ("quad", [[0, 1, 2, 3]]), ("line", [[2, 4]]), ("vertex", [[4]]),
        ("tetra", [[0, 1, 3, 4]]), ("pyramid", [[0, 1, 2, 3, 4]]),
    ]  # fmt: skip
    scene = phong.from_meshio(meshio.Mesh(points, cells), radius=0.05, color="#88aaff")
    assert len(scene.parts) == 3
    draw(scene, "meshio-mixed")
    curved = meshio.Mesh([*points, [0.5, 0, 0.1]], [("line3", [[0, 1, 5]])])
    with pytest.warns(UserWarning, match="line3"):
        phong.from_meshio(curved)
    with pytest.raises(ValueError, match="no face, no solid cell"):
        phong.from_meshio(meshio.Mesh(points, []))
    with pytest.raises(KeyError, match="there is no array 'q'"):
        phong.from_meshio(cube(), scalars="q")


def test_a_colour_map_gives_linear_colours_of_the_values_shape() -> None:
    matplotlib = need("matplotlib")
    values = np.array([[0.0, 0.5], [1.0, np.nan]])
    colors = phong.from_matplotlib_colormap("viridis", values)
    assert colors.shape == (2, 2, 3)
    assert colors.dtype == np.float32
    # By hand: encoded values of the map's middle, decoded by the sRGB curve.
    encoded = np.array(matplotlib.colormaps["viridis"](0.5)[:3])
    wanted = ((encoded + 0.055) / 1.055) ** 2.4
    assert np.allclose(colors[0, 1], wanted, atol=1e-6)
    assert np.allclose(colors[1, 1], ((128 / 255 + 0.055) / 1.055) ** 2.4, atol=1e-6)
    same = phong.from_matplotlib_colormap(matplotlib.colormaps["viridis"], [5.0, 5.0])
    assert np.array_equal(same[0], same[1])
    beyond = phong.from_matplotlib_colormap("gray", [-1.0, 0.0, 1.0, 9.0], vmin=0.0, vmax=1.0)
    assert np.array_equal(beyond[0], beyond[1])
    assert np.array_equal(beyond[2], beyond[3])


def test_what_a_colour_map_cannot_do_is_said() -> None:
    need("matplotlib")
    paint = phong.from_matplotlib_colormap
    with pytest.raises(ValueError, match="did you mean 'viridis'"):
        paint("viridiss", [1.0])
    with pytest.raises(ValueError, match=r"values\[1\] is NaN"):
        paint("viridis", [1.0, np.nan], nan=None)
    with pytest.raises(ValueError, match=r"vmin is 2\.0, above vmax"):
        paint("viridis", [1.0], vmin=2, vmax=1)
    with pytest.raises(ValueError, match="vmax is inf"):
        paint("viridis", [1.0], vmax=np.inf)
    with pytest.raises(ValueError, match="no value is finite"):
        paint("viridis", [np.nan])
