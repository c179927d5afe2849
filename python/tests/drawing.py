"""What the tests of the adapters draw with."""

from __future__ import annotations

import os
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import phong

Pixels = npt.NDArray[np.float32]


def need(package: str) -> Any:
    """The package, or a skip that says so; where the gate runs, its absence is an error."""
    if find_spec(package) is None and os.environ.get("CI") == "true":
        pytest.fail(f"the package {package} is missing")
    return pytest.importorskip(package, reason=f"{package} is missing: its adapter was NOT tested")


def draw(scene: phong.Scene, name: str) -> Pixels:
    """The scene's picture; kept in the folder that PHONG_PICTURES names, to be looked at."""
    assert not [d for d in scene.check() if d.severity == "error"]
    image = phong.render(
        scene, size=(160, 120), samples=4, progress=False, background=[0.02, 0.02, 0.06]
    )
    if folder := os.environ.get("PHONG_PICTURES"):
        Path(folder).mkdir(parents=True, exist_ok=True)
        image.save(Path(folder) / f"{name}.png")
    return np.asarray(image)


def covered(pixels: Pixels) -> float:
    """Which share of the picture something is seen in."""
    return float((np.abs(pixels[..., :3] - pixels[0, 0, :3]) > 0.01).any(axis=-1).mean())


def dressed(folder: Path) -> phong.Scene:
    """A scene with a sky, a lamp that has a surface, an image, an outline and a cut, all said in
    Python; the image's file is in the folder."""
    pixels = phong.Scene(background="tomato")
    pixels.add(phong.Sphere(center=(0, 0, 0), radius=1))
    phong.render(pixels, size=(8, 8), samples=1).save(folder / "photo.png")
    lamp = phong.Light(
        kind="rectangle", position=(0, 4, 2), direction=(0, -1, 0), width=2, height=1, color=0.8
    )
    scene = phong.Scene(
        camera=phong.Camera(eye=(0, 2, 7), look_at=(0, 0, 0)),
        lights=[lamp],
        sky={"kind": "gradient", "horizon": "white", "zenith": "#88aaff", "samples": 2},
        outline={"width": 2, "color": "navy"},
    )
    photo = phong.Texture("photo", kind="image", file=str(folder / "photo.png"))
    skin = phong.Material("skin", color={"texture": photo})
    scene.add(phong.Sphere(name="ball", center=(0, 0, 0), radius=1.5, material=skin))
    scene.add_spheres([(2.5, 0, 0), (-2.5, 0, 0)], 0.7, colors=[(0.9, 0.2, 0.1), (0.1, 0.3, 0.8)])
    cut = {"point": (0, 0, 0.8), "normal": (0, 0, 1), "objects": ["ball"], "cap": "skin"}
    scene.set_settings(clip=[cut])
    return scene
