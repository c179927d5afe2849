"""A ray tracer for the Phong reflection model that can explain every pixel.

    import phong

    scene = phong.Scene(camera=phong.Camera(eye=(0, 2, 8), look_at=(0, 1, 0)))
    scene.add_spheres([(0, 1, 0)], radii=1, colors="tomato")
    image = phong.render(scene, size=(640, 360))
    image.save("ball.png")
    print(phong.explain(scene, 320, 180))

Arrays are read when they are given, and nothing of them is kept or changed. The interpreter is
free for other threads while a picture is rendered, and Ctrl-C stops it.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from phong._errors import Cancelled, Diagnostic, SceneError
from phong._explain import Explanation, explain
from phong._keys import (
    Box,
    Camera,
    Cone,
    Cylinder,
    Disc,
    Light,
    Material,
    Plane,
    Sphere,
    Texture,
    Torus,
    Triangle,
)
from phong._lab import (
    Comparison,
    Conversion,
    Figure,
    Fit,
    Grade,
    check,
    compare,
    convert,
    evaluate,
    figure,
    figures,
    fit,
    grade,
)
from phong._phong import Cancel, Image, Part, __version__, merge
from phong._render import render, render_part
from phong._scene import Scene
from phong.adapters import ADAPTERS

if TYPE_CHECKING:
    from phong import dask as dask
    from phong._widget import widget as widget
    from phong.adapters.ase import from_ase as from_ase
    from phong.adapters.matplotlib import from_matplotlib_colormap as from_matplotlib_colormap
    from phong.adapters.mdanalysis import from_mdanalysis as from_mdanalysis
    from phong.adapters.meshio import from_meshio as from_meshio
    from phong.adapters.ovito import from_ovito as from_ovito
    from phong.adapters.pyvista import from_pyvista as from_pyvista
    from phong.adapters.trimesh import from_trimesh as from_trimesh

__all__ = [
    "Box",
    "Camera",
    "Cancel",
    "Cancelled",
    "Comparison",
    "Cone",
    "Conversion",
    "Cylinder",
    "Diagnostic",
    "Disc",
    "Explanation",
    "Figure",
    "Fit",
    "Grade",
    "Image",
    "Light",
    "Material",
    "Part",
    "Plane",
    "Scene",
    "SceneError",
    "Sphere",
    "Texture",
    "Torus",
    "Triangle",
    "__version__",
    "check",
    "compare",
    "convert",
    "evaluate",
    "explain",
    "figure",
    "figures",
    "fit",
    "grade",
    "merge",
    "render",
    "render_part",
]

#: What is imported when it is first asked for, and where it is.
_LATER = {"widget": "phong._widget", **{n: f"phong.adapters.{m}" for n, m in ADAPTERS.items()}}


def __getattr__(name: str) -> Any:
    if name == "dask":
        return importlib.import_module("phong.dask")
    if name in _LATER:
        return getattr(importlib.import_module(_LATER[name]), name)
    raise AttributeError(f"module 'phong' has no attribute {name!r}", name=name)


def __dir__() -> list[str]:
    return sorted({*globals(), *_LATER, "dask"})
