"""The extension module: Rust behind the package."""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, Literal, Self, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray
from typing_extensions import disjoint_base

from phong._errors import Diagnostic
from phong._keys import Camera, Light, Material, Shape

__version__: str

__all__ = [
    "Cancel",
    "Image",
    "Part",
    "Scene",
    "_Join",
    "__version__",
    "_check",
    "_compare",
    "_compile",
    "_convert",
    "_evaluate",
    "_explain",
    "_figure",
    "_figures",
    "_fit",
    "_grade",
    "_image_of_part",
    "_render",
    "_render_part",
    "_tiles",
    "arithmetic",
    "check_keys",
    "main",
    "merge",
    "schema",
]

_Path: TypeAlias = str | PathLike[str]
_Side: TypeAlias = Literal["front", "back", "left", "right", "top", "bottom", "iso"]
_Colors: TypeAlias = ArrayLike | Sequence[str]

@final
class Cancel:
    """A way to stop work from another thread."""

    def __new__(cls) -> Self: ...
    def cancel(self) -> None: ...
    @property
    def is_cancelled(self) -> bool: ...

@final
class Part:
    """A part of a scene: what an ``add_...`` has added."""

    def __new__(cls, number: int, name: str) -> Self: ...
    @property
    def name(self) -> str: ...
    def __hash__(self) -> int: ...
    def __eq__(self, other: object, /) -> bool: ...

@disjoint_base
class Scene:
    def __new__(
        cls,
        camera: Camera | None = None,
        lights: Sequence[Light] | None = None,
        ambient: ArrayLike | str | None = None,
        background: ArrayLike | str | dict[str, Any] | None = None,
        **settings: Any,
    ) -> Self: ...
    @classmethod
    def read(
        cls, path: _Path, format: str | None = None, lenient: bool = False, *, frame: int = 0
    ) -> Self: ...
    @classmethod
    def parse(cls, text: str, folder: _Path | None = None, *, frame: int = 0) -> Self: ...
    def add_spheres(
        self,
        centers: ArrayLike,
        radii: ArrayLike,
        colors: _Colors | None = None,
        material: Material | str | None = None,
        name: str | None = None,
        *,
        fields: dict[str, ArrayLike] | None = None,
    ) -> Part: ...
    def update_spheres(
        self,
        part: Part,
        centers: ArrayLike | None = None,
        radii: ArrayLike | None = None,
        colors: _Colors | None = None,
        *,
        fields: dict[str, ArrayLike] | None = None,
    ) -> None: ...
    def add_mesh(
        self,
        vertices: ArrayLike,
        faces: ArrayLike,
        normals: ArrayLike | None = None,
        uv: ArrayLike | None = None,
        colors: _Colors | None = None,
        material: Material | str | None = None,
        *,
        smooth: bool | float | None = None,
        name: str | None = None,
        fields: dict[str, ArrayLike] | None = None,
    ) -> Part: ...
    def add_cylinders(
        self,
        starts: ArrayLike,
        ends: ArrayLike,
        radii: ArrayLike,
        colors: _Colors | None = None,
        material: Material | str | None = None,
        *,
        caps: Literal["round", "flat", "none"] = "round",
        name: str | None = None,
        fields: dict[str, ArrayLike] | None = None,
    ) -> Part: ...
    def add(self, shape: Shape, transform: ArrayLike | None = None) -> Part: ...
    def instance(self, part: Part, transforms: ArrayLike, *, keep: bool = True) -> list[Part]: ...
    def remove(self, part: Part) -> None: ...
    @property
    def parts(self) -> list[Part]: ...
    def frame(
        self, view: _Side = "iso", up: str | ArrayLike | None = None, *, fov: float | None = None
    ) -> None: ...
    def check(self) -> list[Diagnostic]: ...
    def to_toml(self) -> str: ...
    def look(self, name: str) -> None: ...
    def set_camera(self, camera: Camera) -> None: ...
    def set_lights(self, lights: Sequence[Light]) -> None: ...
    def set_ambient(self, ambient: ArrayLike | str) -> None: ...
    def set_settings(self, **settings: Any) -> None: ...
    def set_image(self, keys: dict[str, Any]) -> None: ...
    def set_material(self, which: Part | str, material: Material | str) -> None: ...
    def _tables(self) -> str: ...
    def _content(self) -> tuple[str, list[bytes]]: ...
    @classmethod
    def _unpack(cls, text: str, arrays: list[bytes]) -> Self: ...
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, _memo: object) -> Self: ...

@final
class Image:
    """A picture that was rendered. ``numpy.asarray`` makes an array of it: (H, W, 4) ``float32``,
    linear, premultiplied by alpha, rows from top to bottom; it cannot be changed."""

    def __array__(
        self, dtype: DTypeLike | None = None, copy: bool | None = None
    ) -> NDArray[Any]: ...
    @property
    def size(self) -> tuple[int, int]: ...
    @property
    def shape(self) -> tuple[int, int, int]: ...
    @property
    def samples(self) -> int: ...
    @property
    def layers(self) -> dict[str, NDArray[np.float32]]: ...
    @property
    def warnings(self) -> list[Diagnostic]: ...
    @property
    def seconds(self) -> dict[str, float]: ...
    @property
    def scene_fingerprint(self) -> int | None: ...
    def save(
        self,
        path: _Path,
        bits: int = 8,
        exposure: float | Literal["auto"] | None = None,
        *,
        linear: bool = False,
    ) -> None: ...
    def to_srgb8(self, exposure: float | Literal["auto"] | None = None) -> NDArray[np.uint8]: ...
    def _repr_png_(self) -> bytes: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

def merge(parts: Sequence[bytes | _Path]) -> Image: ...
def check_keys(kind: str, keys: dict[str, Any]) -> None: ...
def main(args: Sequence[str]) -> int: ...
def schema() -> str: ...
def arithmetic() -> int: ...

@final
class _Join:
    """Shares of a picture, put together as they come."""

    def __new__(cls) -> Self: ...
    def add(self, name: str, part: bytes) -> None:
        """Adds the bytes of a part file; ``name`` is what errors call it."""
    def finish(self) -> Image:
        """The picture, and nothing is left here. Raises ValueError where shares are missing."""

def _compile(scene: Scene, keys: dict[str, Any]) -> None: ...
def _tiles(scene: Scene, keys: dict[str, Any]) -> int: ...
def _image_of_part(bytes: bytes, seconds: list[tuple[str, float]]) -> Image: ...
def _render(
    scene: Scene,
    keys: dict[str, Any],
    cancel: Cancel | None = None,
    listen: Callable[[int, int], None] | None = None,
) -> Image: ...
def _render_part(
    scene: Scene,
    index: int,
    count: int,
    keys: dict[str, Any],
    cancel: Cancel | None = None,
    listen: Callable[[int, int], None] | None = None,
) -> bytes: ...
def _explain(scene: Scene, x: int, y: int, keys: dict[str, Any]) -> tuple[str, str, str]: ...
def _compare(a: object, b: object, tolerance: float) -> tuple[str, NDArray[np.float32]]: ...
def _grade(scene: Scene, image: object) -> str: ...
def _fit(a: str, b: str) -> str: ...
def _evaluate(
    model: str,
    count: int,
    constant: str,
    arrays: Sequence[tuple[str, NDArray[np.float64]]],
) -> tuple[NDArray[np.float32], int]: ...
def _convert(
    scene: Scene, path: _Path, to: str | None, ascii: bool, tessellate: float | None
) -> str: ...
def _check(path: _Path, format: str | None) -> list[Diagnostic]: ...
def _figure(name: str, keys: dict[str, Any]) -> tuple[str, str, bytes]: ...
def _figures() -> list[tuple[str, str]]: ...
