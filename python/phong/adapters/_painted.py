"""What is painted by numbers, and how thick its lines and points are."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from .matplotlib import from_matplotlib_colormap


def thickness(radius: float | None, diagonal: float) -> float:
    """The radius of lines and points: what was asked for, else 0.3 % of the diagonal."""
    return (0.003 * diagonal or 1.0) if radius is None else radius


def lengths(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Numbers as they are, vectors by their length."""
    made: npt.NDArray[Any] = np.linalg.norm(values, axis=1) if values.ndim == 2 else values
    return made


def painted(
    values: npt.NDArray[Any],
    cmap: str,
    clim: tuple[float, float] | None,
    nan: str | None,
) -> npt.NDArray[np.float32]:
    """The colours of numbers or vectors; ``clim``: None is their least and greatest."""
    low, high = clim or (None, None)
    return from_matplotlib_colormap(cmap, lengths(values), low, high, nan)


def no_array(caller: str, name: str, there: Iterable[str]) -> KeyError:
    """The error for an array that is not there."""
    names = ", ".join(there) or "none"
    return KeyError(f"{caller}: there is no array {name!r}; there are {names}")
