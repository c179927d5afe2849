"""A surface of PyVista, painted by a scalar field.

pip install phong pyvista matplotlib
python surface.py
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista

import phong

grid = pyvista.ImageData(dimensions=(48, 48, 48), spacing=(0.13, 0.13, 0.13))
x, y, z = grid.points.T
grid["field"] = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
grid["height"] = z
surface: Any = grid.contour([0.0], scalars="field")
scene = phong.from_pyvista(surface, scalars="height", cmap="magma")
phong.render(scene, size=(480, 360), samples=16).save("gyroid.png")
