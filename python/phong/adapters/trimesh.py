"""Scenes from trimesh: a mesh, a cloud of points, or a scene with its graph."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import phong

from ._colors import decode, opaque_bytes, warn
from ._need import need, wrong_type
from ._view import View

if TYPE_CHECKING:
    import trimesh

_CALLER = "from_trimesh"


def from_trimesh(
    mesh: trimesh.Trimesh | trimesh.Scene | trimesh.PointCloud,
    *,
    radius: float | None = None,
    material: phong.Material | None = None,
    view: View = "iso",
    up: str = "y",
) -> phong.Scene:
    """A framed Scene of a ``Trimesh``, a ``PointCloud`` or a ``trimesh.Scene``.

    A geometry that a trimesh scene places several times is kept once and placed by its transforms.
    Colours of vertices and faces are taken over (their bytes are sRGB), as is the one colour of a
    material; textures are left out with a warning. ``radius``: of points, in the scene's units;
    None is 0.5 % of the cloud's diagonal. ``material`` is for all; colours stay the objects' own.

    Raises ImportError without trimesh, TypeError for anything else, ValueError where there is
    nothing to draw.
    """
    package = need("trimesh", package="trimesh", caller=_CALLER)
    scene = phong.Scene()
    if isinstance(mesh, package.Scene):
        _add_graph(scene, mesh, radius, material)
    else:
        _add(scene, mesh, radius, material)
    scene.frame(view, up)
    return scene


def _add_graph(
    scene: phong.Scene, graph: Any, radius: float | None, material: phong.Material | None
) -> None:
    """Each geometry once; a second place of it is an instance."""
    places: dict[str, list[Any]] = {}
    for node in graph.graph.nodes_geometry:
        transform, name = graph.graph[node]
        places.setdefault(str(name), []).append(np.asarray(transform, dtype=np.float64))
    if not places:
        raise ValueError(f"{_CALLER}: the scene places no geometry")
    for name, transforms in places.items():
        geometry = graph.geometry[name]
        if len(transforms) == 1:
            moved = geometry.copy()
            moved.apply_transform(transforms[0])
            _add(scene, moved, radius, material)
        else:
            first = geometry.copy()
            first.apply_transform(transforms[0])
            part = _add(scene, first, radius, material)
            back = np.linalg.inv(transforms[0])
            scene.instance(part, np.stack([place @ back for place in transforms[1:]]))


def _add(
    scene: phong.Scene, geometry: Any, radius: float | None, material: phong.Material | None
) -> phong.Part:
    """One geometry, where it is."""
    package = need("trimesh", package="trimesh", caller=_CALLER)
    if isinstance(geometry, package.PointCloud):
        points = np.asarray(geometry.vertices)
        if len(points) == 0:
            raise ValueError(f"{_CALLER}: the point cloud has no point")
        colors = np.asarray(geometry.colors) if geometry.colors is not None else np.zeros((0, 4))
        size = 0.005 * float(np.linalg.norm(np.ptp(points, axis=0))) if radius is None else radius
        return scene.add_spheres(
            points,
            size if size > 0 else 1.0,
            colors=opaque_bytes(colors, caller=_CALLER) if len(colors) == len(points) else None,
            material=material,
        )
    if not isinstance(geometry, package.Trimesh):
        raise wrong_type(_CALLER, "mesh", "trimesh.Trimesh, PointCloud or Scene", geometry)
    if len(geometry.faces) == 0:
        raise ValueError(f"{_CALLER}: the mesh has no face")
    vertices, faces = np.asarray(geometry.vertices), np.asarray(geometry.faces)
    visual = geometry.visual
    painted: Any = None
    if visual.kind == "vertex":
        colors = opaque_bytes(visual.vertex_colors, caller=_CALLER)
        return scene.add_mesh(vertices, faces, colors=colors, material=material)
    if visual.kind == "face":
        # Colours belong to vertices: each face gets three of its own.
        colors = np.repeat(opaque_bytes(visual.face_colors, caller=_CALLER), 3, axis=0)
        own = np.arange(3 * len(faces)).reshape(-1, 3)
        return scene.add_mesh(vertices[faces].reshape(-1, 3), own, colors=colors, material=material)
    if visual.kind == "texture":
        if getattr(visual.material, "baseColorTexture", None) or getattr(
            visual.material, "image", None
        ):
            warn(_CALLER, "a texture is left out; the mesh has its material's one colour")
        main = np.asarray(visual.material.main_color, dtype=np.float64)[:3] / 255.0
        painted = np.broadcast_to(decode(main), (len(vertices), 3))
    return scene.add_mesh(vertices, faces, colors=painted, material=material)
