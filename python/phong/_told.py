"""Answers of the program, as attributes."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

#: Places in the world, which are computed in f64.
_PLACES = {"p", "eye", "origin", "position", "lifted"}
#: Whole numbers, or what is no vector.
_PLAIN = {"pixel", "size", "srgb8", "worst", "at"}


def _value(key: str, value: Any) -> Any:
    if isinstance(value, dict):
        return Told(value)
    if isinstance(value, list):
        if value and all(isinstance(item, (int, float)) for item in value):
            if key in _PLAIN:
                return tuple(value)
            array = np.array(value, np.float64 if key in _PLACES else np.float32)
            array.flags.writeable = False
            return array
        return [_value(key, item) for item in value]
    return value


class Told:
    """A part of an answer: its keys are attributes, and its vectors are arrays.

    Vectors and colours are ``float32`` arrays of shape (3,), or ``float64`` where they are places
    in the world (``p``, ``eye``, ``origin``).
    """

    def __init__(self, told: dict[str, Any]) -> None:
        self._told = told
        for key, value in told.items():
            self.__dict__[key] = _value(key, value)

    def __getattr__(self, key: str) -> Any:
        raise AttributeError(f"nothing is told of {key!r}", name=key, obj=self)

    def __getitem__(self, key: str) -> Any:
        if key not in self._told:
            raise KeyError(key)
        return self.__dict__[key]

    def __iter__(self) -> Any:
        return iter(self._told)

    def to_dict(self) -> dict[str, Any]:
        """As plain data, which can be written as JSON."""
        told: dict[str, Any] = json.loads(json.dumps(self._told))
        return told

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Told) and self._told == other._told

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        plain = (str, int, float, bool, type(None))
        said = [f"{key}={value!r}" for key, value in self._told.items() if isinstance(value, plain)]
        return f"<{type(self).__name__} {' '.join(said)}>"

    def __getstate__(self) -> dict[str, Any]:
        return self._told

    def __setstate__(self, told: dict[str, Any]) -> None:
        Told.__init__(self, told)
