"""Pictures of scenes, and shares of pictures."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any

from phong import _phong
from phong._progress import Listener
from phong._scene import Scene


def scene_of(scene: Scene | str | os.PathLike[str]) -> Scene:
    """A scene, or the one in a file."""
    if isinstance(scene, Scene):
        return scene
    if isinstance(scene, (str, os.PathLike)):
        return Scene.read(scene)
    kind = type(scene).__name__
    raise TypeError(f"scene must be a phong.Scene or the path of a file, not {kind}")


def render(
    scene: Scene | str | os.PathLike[str],
    *,
    size: tuple[int, int] | None = None,
    samples: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
    crop: tuple[int, int, int, int] | None = None,
    layers: Sequence[str] = (),
    progress: bool | Callable[[float], object] | None = None,
    cancel: _phong.Cancel | None = None,
    **overrides: Any,
) -> _phong.Image:
    """A picture of a scene, or of the scene or model in a file.

    ``size``: width and height, pixels. ``samples``: a pixel. ``threads``: ``None`` for all cores;
    the picture has the same bits with any number. ``crop``: ``(x0, y0, x1, y1)``, half-open; the
    picture has the crop's size. ``layers``: names of terms (``"diffuse"``; ``"terms"`` for all), of
    variables (``"depth"``, ``"normal"``, ...), and ``"lights"``: each light's share, ``light.1``
    and so on, and ``light.rest``; found in ``image.layers``. ``progress``:
    ``True`` shows it, ``False`` does not, ``None`` does in a session that somebody watches when it
    takes a while; a function is called with the share that is done, from 0 to 1. ``cancel``: a
    :class:`phong.Cancel`; when it is used, :class:`phong.Cancelled` is raised. ``overrides``: other
    keys of ``[image]`` (``background``, ``depth``, ``filter``, ...), ``shadows=False``,
    ``strict=True`` (warnings are errors), ``max_memory`` (bytes).

    Ctrl-C stops it within a fifth of a second.

    Raises :class:`phong.SceneError` for a scene that cannot be drawn, ``ValueError`` or
    ``TypeError`` for an argument, ``MemoryError`` for a picture or a scene over the limit.
    """
    keys = {
        "size": size,
        "samples": samples,
        "seed": seed,
        "threads": threads,
        "crop": crop,
        "layers": layers,
        **overrides,
    }
    scene = scene_of(scene)
    with Listener(progress) as listener:
        return _phong._render(scene, keys, cancel, listener.listen)


def render_part(
    scene: Scene | str | os.PathLike[str],
    index: int,
    count: int,
    *,
    progress: bool | Callable[[float], object] | None = False,
    cancel: _phong.Cancel | None = None,
    **options: Any,
) -> bytes:
    """Share ``index`` (from 0) of ``count`` of a picture: the bytes of a part file.

    ``options`` are those of :func:`render`. :func:`phong.merge` puts shares together, and so does
    ``phong merge``. Shares of one picture may be rendered on any machines.
    """
    with Listener(progress) as listener:
        scene = scene_of(scene)
        return _phong._render_part(scene, index, count, options, cancel, listener.listen)
