"""Why a pixel has its colour: everything the renderer computed for it, with numbers."""

from __future__ import annotations

import html
import json
import os
from typing import Any

import numpy as np

from phong import _phong
from phong._render import scene_of
from phong._scene import Scene


class Told:
    """A part of an explanation: its keys are attributes, and its vectors are arrays.

    Vectors and colours are ``float32`` arrays of shape (3,), or ``float64`` where they are places
    in the world (``p``, ``eye``, ``origin``).
    """

    def __init__(self, told: dict[str, Any]) -> None:
        self._told = told
        for key, value in told.items():
            setattr(self, key, _value(key, value))

    def __getattr__(self, key: str) -> Any:
        raise AttributeError(f"nothing is told of {key!r}", name=key, obj=self)

    def to_dict(self) -> dict[str, Any]:
        """As plain data: what ``phong explain --json`` says."""
        told: dict[str, Any] = json.loads(json.dumps(self._told))
        return told

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {', '.join(self._told)}>"

    def __getstate__(self) -> dict[str, Any]:
        return self._told

    def __setstate__(self, told: dict[str, Any]) -> None:
        Told.__init__(self, told)


#: Places in the world, which are computed in f64.
_PLACES = {"p", "eye", "origin", "position", "lifted"}
#: Whole numbers.
_WHOLE = {"pixel", "size", "srgb8"}


def _value(key: str, value: Any) -> Any:
    if isinstance(value, dict):
        return Told(value)
    if isinstance(value, list):
        if value and all(isinstance(item, (int, float)) for item in value):
            if key in _WHOLE:
                return tuple(value)
            array = np.array(value, np.float64 if key in _PLACES else np.float32)
            array.flags.writeable = False
            return array
        return [_value(key, item) for item in value]
    return value


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
