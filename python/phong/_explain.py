"""Why a pixel has its colour: everything the renderer computed for it, with numbers."""

from __future__ import annotations

import html
import json
import os
from typing import Any

from phong import _phong
from phong._render import scene_of
from phong._scene import Scene
from phong._told import Told


class Explanation(Told):
    """A pixel, explained.

    ``pixel``, ``size``, ``samples`` (a list: what each ray met, and for every light its vectors,
    dot products, visibility and terms), ``terms``, ``linear``, ``alpha``, ``srgb8``: the keys of
    ``phong explain --json``. ``linear`` has the bits of the picture's pixel.
    """

    text: str
    """All of it as plain text: what ``phong explain`` prints."""
    latex: str
    """The same as LaTeX."""

    def __init__(self, told: dict[str, Any], text: str, latex: str) -> None:
        super().__init__(told)
        self.text = text
        self.latex = latex

    def __str__(self) -> str:
        return self.text

    def _repr_latex_(self) -> str:
        return self.latex

    def _repr_html_(self) -> str:
        r, g, b = self.srgb8
        swatch = f"background:rgb({r},{g},{b});display:inline-block;width:3em;height:1em"
        return f'<span style="{swatch}"></span><pre>{html.escape(self.text)}</pre>'

    def __reduce__(self) -> tuple[Any, ...]:
        return Explanation, (self._told, self.text, self.latex)


def explain(scene: Scene | str | os.PathLike[str], x: int, y: int, **options: Any) -> Explanation:
    """Why the pixel in column ``x`` and row ``y`` has its colour.

    ``options`` are those of :func:`phong.render`: the pixel is that of the picture with the same
    ``size``, ``samples``, ``seed`` and so on. Raises ``ValueError`` for a pixel outside.
    """
    told, text, latex = _phong._explain(scene_of(scene), x, y, options)
    return Explanation(json.loads(told), text, latex)
