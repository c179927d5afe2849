"""``phong.widget``: a scene to turn, light and ask in a notebook."""

from __future__ import annotations

import asyncio
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import phong

from ._viewer import Picture, Viewer

if TYPE_CHECKING:
    import anywidget
    import traitlets
else:
    try:
        import anywidget
        import traitlets
    except ModuleNotFoundError as error:
        raise ImportError(
            "phong.widget needs the package anywidget: pip install anywidget", name=error.name
        ) from error

_FOLDER: Final = Path(__file__).parent
#: The largest picture, pixels a side.
_MOST: Final = 8192


class SceneWidget(anywidget.AnyWidget):
    """What :func:`widget` makes."""

    _esm = _FOLDER / "widget.js"
    _css = _FOLDER / "widget.css"

    #: Width and height of the picture, pixels.
    size = traitlets.List(traitlets.Int()).tag(sync=True)
    #: The sliders.
    controls = traitlets.List(traitlets.Dict()).tag(sync=True)
    #: What a screen reader says of the picture.
    label = traitlets.Unicode().tag(sync=True)

    def __init__(self, scene: phong.Scene, size: tuple[int, int], samples: int) -> None:
        try:
            self._loop: asyncio.AbstractEventLoop | None = asyncio.get_running_loop()
        except RuntimeError:
            self._loop = None
        self._viewer = Viewer(scene, size, samples, self._show, self._fail)
        parts = len(scene.parts)
        super().__init__(
            size=list(size),
            controls=[control.to_json() for control in self._viewer.controls],
            label=f"A scene of {parts} {'part' if parts == 1 else 'parts'}, which arrow keys turn",
        )
        self.on_msg(self._asked)

    @property
    def scene(self) -> phong.Scene:
        """A copy of the scene as it is looked at now, with its camera, lights and materials."""
        import copy

        return copy.copy(self._viewer.scene)

    def close(self) -> None:
        """Takes it from the page and stops drawing."""
        self._viewer.close()
        super().close()

    def _asked(self, _: object, message: dict[str, Any], __: object) -> None:
        """What the page says."""
        kind = message.get("kind")
        try:
            if kind == "hello":
                self._viewer.redraw()
            elif kind == "home":
                self._viewer.home()
            elif kind == "move":
                turn, pan = _pair(message["turn"]), _pair(message["pan"])
                self._viewer.move(turn, pan, float(message["zoom"]))
            elif kind == "set":
                self._viewer.set(str(message["id"]), float(message["value"]))
            elif kind == "explain":
                x, y = int(message["x"]), int(message["y"])
                text = self._viewer.explain(x, y)
                self._tell({"kind": "explanation", "x": x, "y": y, "text": text}, [])
        except Exception as error:  # What goes wrong is told where it is seen.
            self._fail(str(error))

    def _show(self, picture: Picture) -> None:
        message = {
            "kind": "picture",
            "number": picture.number,
            "size": list(picture.size),
            "samples": picture.samples,
            "done": picture.done,
        }
        self._tell(message, [picture.png])

    def _fail(self, text: str) -> None:
        self._tell({"kind": "error", "text": text}, [])

    def _tell(self, message: dict[str, Any], buffers: list[bytes]) -> None:
        """Sends from the thread of the notebook, which is the only one that may everywhere."""
        if self._loop is None or self._loop.is_closed():
            self.send(message, buffers)
        else:
            self._loop.call_soon_threadsafe(self.send, message, buffers)


def widget(
    scene: phong.Scene | str | os.PathLike[str],
    *,
    size: tuple[int, int] = (640, 360),
    samples: int = 16,
) -> SceneWidget:
    """A scene to look at in a notebook: JupyterLab, marimo, or another that shows anywidgets.

    Dragging turns it, shift-dragging moves it, the wheel goes nearer; so do the arrow keys, shift
    with them, + and -. Sliders pull lights and materials. A click explains the pixel, with numbers.
    All is rendered by the kernel, from coarse to fine: ``size`` is of the finest picture, pixels,
    with ``samples`` a pixel. The scene is copied; ``.scene`` of what is returned is as it is looked
    at then.

    Raises ImportError without anywidget, SceneError for a scene that cannot be drawn, ValueError
    for a size or samples out of range.
    """
    width, height = (int(side) for side in size)
    if not (0 < width <= _MOST and 0 < height <= _MOST):
        raise ValueError(f"size is {size}; wanted are two numbers from 1 to {_MOST}")
    if samples < 1:
        raise ValueError(f"samples is {samples}; wanted is a whole number above 0")
    if not isinstance(scene, phong.Scene):
        scene = phong.Scene.read(scene)
    # What is wrong with the scene is told here and not in the page.
    phong.render(scene, size=(1, 1), samples=1, progress=False)
    return SceneWidget(scene, (width, height), samples)


def _pair(values: Any) -> tuple[float, float]:
    first, second = values
    return float(first), float(second)
