"""Cameras, lights, materials, textures and shapes: their keys are those of the scene text."""

from __future__ import annotations

import os
from typing import Any, ClassVar, NoReturn, Self

from phong import _phong


def _plain(key: str, value: Any) -> Any:
    """A value without anything that somebody else may change."""
    if value is None or isinstance(value, (bool, int, float, str, Keys)):
        return value
    if isinstance(value, dict):
        return {name: _plain(key, item) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return tuple(_plain(key, item) for item in value)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "tolist"):  # an array, or a number of numpy
        return _plain(key, value.tolist())
    if hasattr(value, "__float__"):
        return float(value)
    raise TypeError(f"{key} cannot be a {type(value).__name__}")


def _frozen(value: Any) -> Any:
    if isinstance(value, dict):
        return tuple(sorted((name, _frozen(item)) for name, item in value.items()))
    return value


class Keys:
    """A table of the scene text. It is checked where it is made, and does not change after that.

    A key that is a word of Python is written with an underscore: ``from_``.
    """

    __slots__ = ("_keys", "_name")

    _kind: ClassVar[str]
    _keys: dict[str, Any]
    _name: str | None

    def __init__(self, name: str | None = None, /, **keys: Any) -> None:
        said = {key.removesuffix("_"): value for key, value in keys.items() if value is not None}
        plain = {key: _plain(key, value) for key, value in said.items()}
        _phong.check_keys(self._kind, plain)
        object.__setattr__(self, "_keys", plain)
        object.__setattr__(self, "_name", name)

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_"):
            raise AttributeError(key)
        try:
            return self._keys[key.removesuffix("_")]
        except KeyError:
            message = f"this {type(self).__name__} does not say {key!r}"
            raise AttributeError(message, name=key, obj=self) from None

    def __setattr__(self, key: str, value: object) -> NoReturn:
        raise AttributeError(f"a {type(self).__name__} does not change: use replace({key}=...)")

    def __delattr__(self, key: str) -> NoReturn:
        raise AttributeError(f"a {type(self).__name__} does not change")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._keys]

    def replace(self, **keys: Any) -> Self:
        """The same with other values for some keys; ``None`` leaves one to its default."""
        new = type(self).__new__(type(self))
        keys = {key.removesuffix("_"): value for key, value in keys.items()}
        Keys.__init__(new, self._name, **{**self._keys, **keys})
        return new

    def to_dict(self) -> dict[str, Any]:
        """The keys that are said, and their values."""
        return dict(self._keys)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Keys):
            return NotImplemented
        return (self._kind, self._name, self._keys) == (other._kind, other._name, other._keys)

    def __hash__(self) -> int:
        return hash((self._kind, self._name, _frozen(self._keys)))

    def __repr__(self) -> str:
        said = [f"{key}={value!r}" for key, value in self._keys.items()]
        if self._name is not None:
            said.insert(0, repr(self._name))
        return f"{type(self).__name__}({', '.join(said)})"

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (type(self), self._name, self._keys)


def _restore(kind: type[Keys], name: str | None, keys: dict[str, Any]) -> Keys:
    new = kind.__new__(kind)
    object.__setattr__(new, "_keys", keys)
    object.__setattr__(new, "_name", name)
    return new


class Camera(Keys):
    """Where a picture is taken from: the keys of ``[camera]``, of them ``eye`` and ``look_at``."""

    __slots__ = ()
    _kind = "camera"


class Light(Keys):
    """A light: the keys of ``[[light]]``; ``kind`` is ``"point"``, ``"distant"`` or ``"spot"``."""

    __slots__ = ()
    _kind = "light"


class Material(Keys):
    """What a surface is made of: the keys of ``[materials.NAME]``; all have defaults."""

    __slots__ = ()
    _kind = "material"


class Texture(Keys):
    """A value that varies over a surface: the keys of ``[textures.NAME]``.

    It stands where a material's number or colour does: ``Material(color=Texture(...))``.
    """

    __slots__ = ()
    _kind = "texture"


class Shape(Keys):
    """A shape for :meth:`phong.Scene.add`. ``material``: a :class:`Material`, or a name of one."""

    __slots__ = ()


class Sphere(Shape):
    """All points at ``radius`` from ``center``; scaled unevenly, an ellipsoid."""

    __slots__ = ()
    _kind = "sphere"


class Plane(Shape):
    """An infinite plane through ``point``, across ``normal``."""

    __slots__ = ()
    _kind = "plane"


class Triangle(Shape):
    """One triangle of three ``points``, counter-clockwise seen from outside."""

    __slots__ = ()
    _kind = "triangle"


class Disc(Shape):
    """A flat disc of ``radius`` about ``center``, across ``normal``."""

    __slots__ = ()
    _kind = "disc"


class Box(Shape):
    """A box with faces along the axes, from ``min`` to ``max``."""

    __slots__ = ()
    _kind = "box"


class Cylinder(Shape):
    """A cylinder of ``radius`` around the line from ``from_`` to ``to``."""

    __slots__ = ()
    _kind = "cylinder"


class Cone(Shape):
    """A cone or frustum around the line from ``from_`` to ``to``."""

    __slots__ = ()
    _kind = "cone"


class Torus(Shape):
    """A ring with a round section."""

    __slots__ = ()
    _kind = "torus"
