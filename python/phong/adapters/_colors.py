"""Colours of other packages, which are sRGB, as the renderer takes them: linear."""

from __future__ import annotations

import warnings

import numpy as np
import numpy.typing as npt

Colors = npt.NDArray[np.float32]


def decode(encoded: npt.ArrayLike) -> Colors:
    """Linear values, float32, of sRGB ones in [0, 1]; the shape stays. Float64 is used inside."""
    value = np.asarray(encoded, dtype=np.float64)
    low = value / 12.92
    high = ((np.maximum(value, 0.04045) + 0.055) / 1.055) ** 2.4
    return np.where(value <= 0.04045, low, high).astype(np.float32)


def opaque_bytes(colors: npt.ArrayLike, *, caller: str) -> npt.NDArray[np.uint8]:
    """The (N, 3) bytes of (N, 3) or (N, 4) ones; opacities are left out with a warning."""
    array: npt.NDArray[np.uint8] = np.asarray(colors, dtype=np.uint8)
    if array.shape[-1] == 4 and bool((array[..., 3] != 255).any()):
        warn(caller, "opacities of colours are left out: a material's opacity is one for all")
    return np.ascontiguousarray(array[..., :3])


def warn(caller: str, what: str) -> None:
    """A UserWarning at the line that called the adapter's function."""
    warnings.warn(f"{caller}: {what}", UserWarning, stacklevel=3)
