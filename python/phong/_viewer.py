"""A scene that is looked at from here and there: what the widget does, without a notebook.

Changes are taken at once, pictures are rendered by a thread of their own, from coarse to fine. A
change stops the finer ones; the first and coarsest is always finished, so that a drag shows
something.
"""

from __future__ import annotations

import copy
import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

import phong

from ._controls import Control, light_controls, material_controls, with_light_changed

Vector = npt.NDArray[np.float64]

#: The coarsest picture takes no longer than this, seconds, where its size can help it.
_PROMPT: Final = 0.04
_COARSEST: Final = 16
#: As near to straight up or down as the eye may come, radians.
_STEEPEST: Final = math.radians(89.0)


@dataclass(frozen=True)
class Picture:
    """One of the pictures that follow a change."""

    #: Counts all pictures of the viewer, from 1.
    number: int
    size: tuple[int, int]
    samples: int
    #: Whether it is the finest.
    done: bool
    png: bytes


class Viewer:
    """The scene, its camera's orbit, and the thread that draws."""

    def __init__(
        self,
        scene: phong.Scene,
        size: tuple[int, int],
        samples: int,
        show: Callable[[Picture], None],
        fail: Callable[[str], None],
    ) -> None:
        self.scene = copy.copy(scene)
        self.size = size
        self.samples = samples
        self._show = show
        self._fail = fail
        self.scene.image = {"size": size, "samples": samples}
        self._home: dict[str, Any] = self.scene.camera.to_dict()
        # Lights that were chosen for the picture stay while the camera moves.
        self.scene.lights = self.scene.lights
        reach = float(np.linalg.norm(np.subtract(self._home["eye"], self._home["look_at"])))
        self.controls: list[Control] = [
            *light_controls(
                self.scene.lights, np.asarray(self._home["look_at"], dtype=np.float64), reach
            ),
            *material_controls(self.scene.materials),
        ]
        self._lock = threading.Lock()
        self._changes = 0
        self._pictures = 0
        self._thread: threading.Thread | None = None
        self._cancel = phong.Cancel()
        self._divisor = 8
        # The orbit: angles, distance and middle, as `_orbit_of` finds them.
        self._yaw = self._pitch = 0.0
        self._distance = self._first_distance = 1.0
        self._target: Vector = np.zeros(3)
        self._orbit_of(self._home)

    # What is asked.

    def move(self, turn: tuple[float, float], pan: tuple[float, float], zoom: float) -> None:
        """Turns about the point looked at, moves that point, goes farther.

        ``turn``: radians. ``pan``: heights of the picture. ``zoom``: the natural logarithm of the
        factor on the distance.
        """
        with self._lock:
            self._yaw -= turn[0]
            self._pitch = min(max(self._pitch + turn[1], -_STEEPEST), _STEEPEST)
            self._distance *= math.exp(min(max(zoom, -3.0), 3.0))
            right, up = self._axes()
            self._target = self._target - (right * pan[0] - up * pan[1]) * self._height()
            camera = self._camera()
        self.scene.camera = camera
        self.redraw()

    def home(self) -> None:
        """Looks from where it was looked from at first."""
        with self._lock:
            self._orbit_of(self._home)
        self.scene.camera = phong.Camera(**self._home)
        self.redraw()

    def set(self, control: str, value: float) -> None:
        """Sets what a slider is for; KeyError where there is no such one."""
        kind, number, key = control.split("/")
        if kind == "light":
            lights = self.scene.lights
            lights[int(number)] = with_light_changed(lights[int(number)], key, value)
            self.scene.lights = lights
        else:
            name, material = list(self.scene.materials.items())[int(number)]
            self.scene.set_material(name, material.replace(**{key: value}))
        self.redraw()

    def explain(self, x: int, y: int) -> str:
        """The explanation of a pixel of the finest picture."""
        return phong.explain(self.scene, x, y, size=self.size, samples=self.samples).text

    def redraw(self) -> None:
        """Draws from coarse to fine, unless something newer comes."""
        with self._lock:
            self._changes += 1
            self._cancel.cancel()
            if self._thread is None:
                self._thread = threading.Thread(target=self._draw, name="phong-viewer", daemon=True)
                self._thread.start()

    def close(self) -> None:
        """Stops drawing."""
        with self._lock:
            self._changes += 1
            self._cancel.cancel()

    # The thread that draws.

    def _draw(self) -> None:
        try:
            while True:
                with self._lock:
                    seen = self._changes
                    self._cancel = phong.Cancel()
                    cancel = self._cancel
                self._passes(seen, cancel)
                with self._lock:
                    if seen == self._changes:
                        self._thread = None
                        return
        except Exception as error:  # The notebook is told, and the next change tries anew.
            with self._lock:
                self._thread = None
            self._fail(str(error))

    def _passes(self, seen: int, cancel: phong.Cancel) -> None:
        began = time.perf_counter()
        self._pass(self._divisor, 1, None)
        took = time.perf_counter() - began
        if took > _PROMPT and self._divisor < _COARSEST:
            self._divisor *= 2
        elif took < _PROMPT / 5 and self._divisor > 2:
            self._divisor //= 2
        divisor = self._divisor // 2
        try:
            while divisor > 1 and seen == self._changes:
                self._pass(divisor, 1, cancel)
                divisor //= 2
            for samples in sorted({1, self.samples}):
                if seen != self._changes:
                    return
                self._pass(1, samples, cancel)
        except phong.Cancelled:
            return

    def _pass(self, divisor: int, samples: int, cancel: phong.Cancel | None) -> None:
        size = (max(1, self.size[0] // divisor), max(1, self.size[1] // divisor))
        image = phong.render(self.scene, size=size, samples=samples, cancel=cancel, progress=False)
        self._pictures += 1
        done = size == self.size and samples == self.samples
        self._show(Picture(self._pictures, size, samples, done, image._repr_png_()))

    # The camera's orbit.

    def _orbit_of(self, camera: dict[str, Any]) -> None:
        self._keys = dict(camera)
        self._target = np.asarray(camera["look_at"], dtype=np.float64)
        away = np.asarray(camera["eye"], dtype=np.float64) - self._target
        self._distance = self._first_distance = float(np.linalg.norm(away))
        pole = np.asarray(camera.get("up", (0.0, 1.0, 0.0)), dtype=np.float64)
        self._pole = pole / np.linalg.norm(pole)
        # Two directions across the pole, the first on the side of the eye.
        level = away - self._pole * float(away @ self._pole)
        if float(np.linalg.norm(level)) < 1e-9 * self._distance:
            level = np.cross(self._pole, np.eye(3)[int(np.argmin(np.abs(self._pole)))])
        self._front = level / np.linalg.norm(level)
        self._side = np.cross(self._pole, self._front)
        self._yaw = 0.0
        sine = float(away @ self._pole) / self._distance
        self._pitch = min(max(math.asin(min(max(sine, -1.0), 1.0)), -_STEEPEST), _STEEPEST)

    def _away(self) -> Vector:
        """From the target to the eye, unit."""
        level = self._front * math.cos(self._yaw) + self._side * math.sin(self._yaw)
        away = level * math.cos(self._pitch) + self._pole * math.sin(self._pitch)
        return np.asarray(away, dtype=np.float64)

    def _axes(self) -> tuple[Vector, Vector]:
        """Right and up in the picture."""
        away = self._away()
        right = np.cross(self._pole, away)
        right /= np.linalg.norm(right)
        return right, np.cross(away, right)

    def _height(self) -> float:
        """The height of the picture at the target, scene units."""
        if "height" in self._keys:
            return float(self._keys["height"]) * self._distance / self._first_distance
        return (
            2
            * self._distance
            * math.tan(math.radians(min(float(self._keys.get("fov", 40.0)), 160.0)) / 2)
        )

    def _camera(self) -> phong.Camera:
        keys = dict(self._keys)
        keys["look_at"] = self._target.tolist()
        keys["eye"] = (self._target + self._away() * self._distance).tolist()
        if "height" in keys:
            keys["height"] = self._height()
        return phong.Camera(**keys)
