"""What is asked of pictures, scenes and formulas: the program's commands, by the same words."""

from __future__ import annotations

import json
import os
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from phong import _phong
from phong._errors import Diagnostic
from phong._render import scene_of
from phong._scene import Scene
from phong._told import Told

Path: TypeAlias = "str | os.PathLike[str]"
Picture: TypeAlias = "_phong.Image | Path | ArrayLike"


class Comparison(Told):
    """How different two pictures are: the keys of ``phong compare --json``."""

    max: float
    """The largest absolute difference."""
    mean: float
    """The mean absolute difference."""
    rms: float
    """The root of the mean squared difference."""
    over_1_255: float
    """Share of the values that differ by more than 1/255."""
    psnr: float | None
    """Peak signal to noise, decibels; ``None``: nothing differs."""
    worst: tuple[int, int]
    """The pixel (x, y) of the largest difference."""
    within_tolerance: bool
    """Whether no value differs by more than the tolerance."""
    map: NDArray[np.float32]
    """The largest difference of each pixel: shape (H, W)."""

    def __init__(self, told: dict[str, Any], map: NDArray[np.float32]) -> None:
        super().__init__(told)
        self.map = map

    def __reduce__(self) -> tuple[Any, ...]:
        return Comparison, (self._told, self.map)


class Grade(Told):
    """Somebody else's picture of a scene held against ours: the keys of ``phong grade --json``."""

    verdict: str
    """``"pass"`` or ``"fail"``."""
    cause: str | None
    """The mistake that explains it; ``None``: it passes, or none does."""
    tied: list[str]
    """Others that explain it as well."""
    confidence: float
    """From 0 to 1."""


class Fit(Told):
    """One model matched to another: the keys of ``phong fit --json``."""


class Conversion(Told):
    """What became of a scene in another format: the keys of ``phong convert --json``."""

    files: list[str]
    """The files that were written."""


class Figure(Told):
    """A figure of the lecture."""

    name: str
    title: str
    caption: str
    svg: str
    """The figure as an SVG file."""
    png: bytes
    """The figure as a PNG file."""

    def __init__(self, told: dict[str, Any], svg: str, png: bytes) -> None:
        super().__init__(told)
        self.svg = svg
        self.png = png

    def save(self, path: Path) -> None:
        """Writes it as SVG or PNG, as the name ends."""
        ending = os.path.splitext(os.fspath(path))[1].lower()
        if ending == ".svg":
            content = self.svg.encode()
        elif ending == ".png":
            content = self.png
        else:
            raise ValueError(f"path: {os.fspath(path)!r} must end in .svg or .png")
        with open(path, "wb") as file:
            file.write(content)

    def _repr_svg_(self) -> str:
        return self.svg

    def __reduce__(self) -> tuple[Any, ...]:
        return Figure, (self._told, self.svg, self.png)


def compare(a: Picture, b: Picture, *, tolerance: float = 0.0) -> Comparison:
    """How different two pictures are, in numbers and to the eye.

    A picture is a :class:`phong.Image`, the path of a PNG, EXR, PFM, PPM or JPEG, or an array of
    shape (H, W, 3) or (H, W, 4): ``uint8`` is sRGB with straight alpha, floats are linear. Two that
    are encoded are compared as they are; of an encoded and a linear one the latter is encoded.
    Raises ``ValueError`` where the sizes differ.
    """
    told, map = _phong._compare(a, b, tolerance)
    return Comparison(json.loads(told), map)


def grade(scene: Scene | Path, image: Picture) -> Grade:
    """Holds somebody else's rendering of a scene against ours, term by term.

    The scene is drawn at the size of the picture. ``grade.cause`` names what is wrong with it, if
    a known mistake explains it.
    """
    return Grade(json.loads(_phong._grade(scene_of(scene), image)))


def fit(a: str, b: str) -> Fit:
    """The exponent or roughness with which model ``b`` best matches model ``a``.

    ``fit("phong:32", "blinn-phong").to.exponent``; with a number behind ``b`` the two are held
    against each other as they are.
    """
    return Fit(json.loads(_phong._fit(a, b)))


def convert(
    scene: Scene | Path,
    path: Path,
    *,
    to: str | None = None,
    ascii: bool = False,
    tessellate: float | None = None,
) -> Conversion:
    """Writes a scene in the format that ``path`` ends in (or ``to`` says): TOML, OBJ, PLY,
    STL, glTF, Tachyon.

    Arrays of a TOML lie beside it in PLY files (``ascii``: as text). What was mapped by which
    formula, and what was dropped, is told. ``tessellate``: triangles in place of spheres,
    cylinders, cones, tori, discs and boxes, nowhere farther than this from the surface, in scene
    units, above 0.
    """
    return Conversion(json.loads(_phong._convert(scene_of(scene), path, to, ascii, tessellate)))


def check(scene: Scene | Path, *, format: str | None = None) -> list[Diagnostic]:
    """Everything there is to say about a scene or a file: errors and warnings, none raised."""
    if isinstance(scene, Scene):
        return scene.check()
    return _phong._check(scene, format)


def figure(
    name: str,
    *,
    theta: float | None = None,
    alpha: float | None = None,
    color: Any = None,
    dark: bool = False,
) -> Figure:
    """A figure of the lecture, its numbers computed by the functions that render.

    ``theta``: the angle of incidence, degrees from 5 to 80. ``alpha``: the shininess, from 1 to
    1000. ``color``: of the ball. ``dark``: on dark paper. :func:`figures` lists them all.
    """
    keys = {"theta": theta, "alpha": alpha, "color": color, "dark": dark}
    told, svg, png = _phong._figure(name, keys)
    return Figure(json.loads(told), svg, png)


def figures() -> dict[str, str]:
    """Every figure's name, and what it shows."""
    return dict(_phong._figures())


#: Parameters that are colours: their last axis is red, green and blue.
_COLORS = {"Ca", "Cd", "Cs", "F0", "eta", "k"}


def evaluate(
    model: str,
    n: ArrayLike | None = None,
    l: ArrayLike | None = None,  # noqa: E741
    e: ArrayLike | None = None,
    **params: Any,
) -> NDArray[np.float32] | np.float32:
    """The renderer's own formulas at vectors of your choosing: what ``phong eval`` answers.

    ``n``, ``l``, ``e``: the normal, to the light, to the eye; shape (..., 3), unit to 1e-3.
    ``params``: those of the model (``phong eval --help`` lists them); numbers or arrays, or words.
    A parameter called ``n`` there is ``n_`` here, where ``n`` is the normal. Leading axes are
    broadcast. The values are ``float32``: of shape (...), or (..., 3) where they are vectors or
    colours. Raises ``ValueError`` with the index of what has no value.
    """
    arrays: dict[str, NDArray[np.float64]] = {}
    for name, given in (("N", n), ("L", l), ("E", e)):
        if given is None:
            continue
        array = _numbers(name.lower(), given)
        if array.shape[-1:] != (3,):
            raise ValueError(f"{name.lower()} must be of shape (..., 3); it is {array.shape}")
        arrays[name] = array
    constant: dict[str, Any] = {}
    for keyword, value in params.items():
        name = keyword.removesuffix("_")
        if isinstance(value, (str, bool, dict, type(None))) or _is_mixed(value):
            constant[name] = _plain(name, value)
            continue
        array = _numbers(name, value)
        is_color = name in _COLORS and array.shape[-1:] == (3,)
        if name == "X" and array.shape[-1:] != (3,):
            raise ValueError(f"X must be of shape (..., 3); it is {array.shape}")
        arrays[name] = array if is_color or name == "X" else array[..., None]
    try:
        shape = np.broadcast_shapes(*(array.shape[:-1] for array in arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape[:-1]}" for name, array in arrays.items())
        raise ValueError(f"leading axes do not fit together: {shapes}") from None

    def rows(array: NDArray[np.float64]) -> NDArray[np.float64]:
        width = array.shape[-1]
        # One row stands for all.
        wide = array if array.size == width else np.broadcast_to(array, (*shape, width))
        return np.ascontiguousarray(wide.reshape(-1, width))

    count = int(np.prod(shape, dtype=np.int64))
    values, width = _phong._evaluate(
        model,
        count,
        json.dumps(constant),
        [(name, rows(array)) for name, array in arrays.items()],
    )
    shaped = values.reshape(shape if width == 1 else (*shape, width))
    return shaped[()] if shaped.ndim == 0 else shaped


def _numbers(name: str, value: Any) -> NDArray[np.float64]:
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise TypeError(f"{name} cannot be read as an array: {error}") from error
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} must be numbers; its dtype is {array.dtype}")
    return array.astype(np.float64)


def _is_mixed(value: Any) -> bool:
    """Lists with words or dictionaries in them: ``["schlick", 0.04]``, ``[{"L": ...}]``."""
    return isinstance(value, (list, tuple)) and any(isinstance(v, (str, dict)) for v in value)


def _plain(name: str, value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(name, item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(name, item) for item in value]
    if hasattr(value, "tolist"):
        return value.tolist()
    if value is None or isinstance(value, (str, bool, int, float)):
        return value
    raise TypeError(f"{name} cannot be a {type(value).__name__}")
