"""The scene, as Python sees it: the extension's own class with what is told in words of Python."""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Iterable
from typing import Any

from phong import _phong
from phong._keys import Camera, Light, Material, Texture


class Scene(_phong.Scene):
    """What is drawn, and what it looks like.

    ``camera``: a :class:`phong.Camera`; ``None``: one that shows everything, as ``frame("iso")``
    does. ``lights``: a list of :class:`phong.Light`; ``None``: two that stand behind the camera.
    ``ambient``: colour of the ambient light. ``background``: a colour, ``"transparent"``, or
    ``{"top": ..., "bottom": ...}``. Colours: one number is grey, three are linear red, green and
    blue; ``"#rrggbb"`` and CSS names are sRGB. ``settings``: the other tables of the scene text by
    their names, like ``fog={"end": 12}``, ``ambient_occlusion={"samples": 16}``, ``clip=[{...}]``.

    What rays meet is compiled by the first picture and kept: another camera, other lights,
    materials or colours need no second build. A scene can be pickled and copied, and used by
    several threads at once.
    """

    @property
    def camera(self) -> Camera:
        """Where the picture is taken from; assign another to look from there."""
        keys: dict[str, Any] = tomllib.loads(self._tables()).get("camera", {})
        return Camera(**keys)

    @camera.setter
    def camera(self, camera: Camera) -> None:
        self.set_camera(camera)

    @property
    def lights(self) -> list[Light]:
        """The lights, in order. The list is a copy: assign another to change them."""
        return [Light(**keys) for keys in tomllib.loads(self._tables()).get("light", [])]

    @lights.setter
    def lights(self, lights: Iterable[Light]) -> None:
        self.set_lights(list(lights))

    @property
    def materials(self) -> dict[str, Material]:
        """The materials by their names. A copy: :meth:`set_material` changes one."""
        tables = tomllib.loads(self._tables())
        textures = {
            name: Texture(name, **keys) for name, keys in tables.get("textures", {}).items()
        }

        def value(value: Any) -> Any:
            if isinstance(value, dict) and "texture" in value:
                return {**value, "texture": textures[value["texture"]]}
            return value

        materials = tables.get("materials", {})
        return {
            name: Material(name, **{key: value(item) for key, item in keys.items()})
            for name, keys in materials.items()
        }

    @property
    def ambient(self) -> Any:
        """Colour of the ambient light."""
        return tomllib.loads(self._tables()).get("ambient", {}).get("color", 1.0)

    @ambient.setter
    def ambient(self, color: Any) -> None:
        self.set_ambient(color)

    @property
    def background(self) -> Any:
        """What rays see that hit nothing."""
        return self.image.get("background", 0.0)

    @background.setter
    def background(self, background: Any) -> None:
        self.set_image({"background": background})

    @property
    def image(self) -> dict[str, Any]:
        """The keys of ``[image]`` that are not as by default; assign some to change them."""
        keys: dict[str, Any] = tomllib.loads(self._tables()).get("image", {})
        return keys

    @image.setter
    def image(self, keys: dict[str, Any]) -> None:
        self.set_image(keys)

    @property
    def settings(self) -> dict[str, Any]:
        """The tables that stand alone (``fog``, ``ambient_occlusion``, ``clip``, ...), as
        dictionaries of what is not as by default.

        A copy: :meth:`set_settings` changes one, as in ``scene.set_settings(fog={"end": 12})``, and
        takes it away as in ``scene.set_settings(fog=None)``.
        """
        others = ("version", "image", "camera", "ambient", "light", "materials", "textures")
        tables = tomllib.loads(self._tables())
        return {name: table for name, table in tables.items() if name not in others}

    def digest(self) -> str:
        """A hash (hexadecimal) of all that it is; equal scenes have equal ones."""
        text, arrays = self._content()
        digest = hashlib.blake2b(text.encode(), digest_size=16)
        for array in arrays:
            digest.update(len(array).to_bytes(8, "little"))
            digest.update(array)
        return digest.hexdigest()

    def render(self, **options: Any) -> _phong.Image:
        """A picture of it: as :func:`phong.render`."""
        from phong._render import render

        return render(self, **options)

    def _repr_png_(self) -> bytes:
        image = self.render(samples=4, progress=False)
        return image._repr_png_()


def _restore(kind: type[Scene], text: str, arrays: list[bytes]) -> Any:
    return kind._unpack(text, arrays)
