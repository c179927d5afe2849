"""Scenes from the objects of other packages: one module a package, none of them needed.

Each function is offered as ``phong.from_...`` and imported when it is first asked for, so that
``import phong`` costs nothing for packages that are not used. Where the other package is missing,
the function raises an ImportError that names what to install.
"""

from __future__ import annotations

from typing import Final

#: In which module of this folder each function is.
ADAPTERS: Final = {
    "from_ase": "ase",
    "from_matplotlib_colormap": "matplotlib",
    "from_mdanalysis": "mdanalysis",
    "from_meshio": "meshio",
    "from_ovito": "ovito",
    "from_pyvista": "pyvista",
    "from_trimesh": "trimesh",
}
