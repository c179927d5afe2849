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
