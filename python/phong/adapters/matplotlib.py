"""Numbers as colours, through a colour map of Matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ._colors import Colors, decode
from ._need import need

if TYPE_CHECKING:
    from matplotlib.colors import Colormap


def from_matplotlib_colormap(
    name: str | Colormap,
    values: npt.ArrayLike,
    vmin: float | None = None,
    vmax: float | None = None,
    nan: npt.ArrayLike | str | None = "#808080",
) -> Colors:
    """Linear colours, float32, of shape ``values.shape + (3,)``: what ``colors=`` takes.

    ``name`` is that of a colour map, or one itself. ``vmin`` and ``vmax`` are the values of its two
    ends; None is the least and the greatest finite value. What lies beyond has the colour of the
    end, or the map's own for it. ``nan`` is the colour of NaN: a colour as Matplotlib takes it
    (sRGB), or None, which makes NaN a ValueError that names the first one.

    Raises ImportError without Matplotlib, ValueError for a name it does not know, for ends that are
    not finite or in the wrong order, and where no value is finite and an end is not given.
    """
    caller = "from_matplotlib_colormap"
    colors = need("matplotlib.colors", package="matplotlib", caller=caller)
    table: Colormap
    if isinstance(name, str):
        maps = need("matplotlib", package="matplotlib", caller=caller).colormaps
        if name not in maps:
            raise ValueError(
                f"{caller}: name is {name!r}, which Matplotlib does not know{_near(name, maps)}"
            )
        table = maps[name]
    else:
        table = name
    array = np.asarray(values, dtype=np.float64)
    finite = np.isfinite(array)
    low, high = _end("vmin", vmin, array, finite), _end("vmax", vmax, array, finite)
    if low > high:
        raise ValueError(f"{caller}: vmin is {low}, above vmax, which is {high}")
    missing = np.isnan(array)
    if nan is None and bool(missing.any()):
        index = tuple(int(i) for i in np.argwhere(missing)[0])
        raise ValueError(f"{caller}: values{list(index)} is NaN, and nan=None allows none")
    share = np.zeros_like(array) if low == high else (array - low) / (high - low)
    encoded = np.asarray(table(np.where(missing, 0.0, share)), dtype=np.float64)[..., :3]
    if nan is not None:
        encoded[missing] = colors.to_rgb(nan)
    return decode(encoded)


def _end(
    argument: str,
    given: float | None,
    values: npt.NDArray[np.float64],
    finite: npt.NDArray[np.bool_],
) -> float:
    """An end of the scale."""
    if given is not None:
        if not np.isfinite(given):
            raise ValueError(
                f"from_matplotlib_colormap: {argument} is {given}; wanted is a finite number"
            )
        return float(given)
    if not bool(finite.any()):
        if values.size == 0:
            return 0.0
        raise ValueError(
            f"from_matplotlib_colormap: no value is finite, so {argument} has to be given"
        )
    return float(values[finite].min() if argument == "vmin" else values[finite].max())


def _near(name: str, known: object) -> str:
    """Did you mean."""
    import difflib

    close = difflib.get_close_matches(name, list(known), n=1)  # type: ignore[call-overload]
    return f"; did you mean {close[0]!r}?" if close else ""
