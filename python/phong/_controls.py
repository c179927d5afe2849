"""Sliders: which numbers of lights and materials can be pulled, and how far."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from typing import Any, Final

import numpy as np
import numpy.typing as npt

import phong

from . import _phong

#: How far sliders go whose keys have no end.
_FAR: Final = {"shininess": 256.0, "ior": 3.0, "reflection": 1.0, "transmission": 1.0}
_STRONGEST: Final = 3.0


@dataclass(frozen=True)
class Control:
    """A slider."""

    #: ``light/NUMBER/KEY`` or ``material/NUMBER/KEY``.
    id: str
    #: What stands above it and its like.
    group: str
    label: str
    least: float
    most: float
    value: float

    def to_json(self) -> dict[str, Any]:
        """As the page takes it."""
        return asdict(self)


def light_controls(
    lights: Sequence[phong.Light], middle: npt.NDArray[np.float64], reach: float
) -> list[Control]:
    """Strength and place or direction of each light; places about the middle of what is seen."""
    controls: list[Control] = []
    for number, one in enumerate(lights):
        light = one.to_dict()
        group = str(light.get("name", f"light {number + 1}"))

        def add(
            key: str, label: str, least: float, most: float, value: float, number: int = number,
            group: str = group,
        ) -> None:  # fmt: skip
            low, high = min(least, value), max(most, value)
            controls.append(Control(f"light/{number}/{key}", group, label, low, high, value))

        if not isinstance(light.get("color", 1.0), str):
            add("strength", "strength", 0.0, _STRONGEST, _strength(light.get("color", 1.0)))
        if "position" in light:
            for axis, name in enumerate("xyz"):
                at = float(light["position"][axis])
                add(
                    f"position {name}", name, middle[axis] - 2 * reach, middle[axis] + 2 * reach, at
                )
        if "direction" in light:
            around, height = _angles(light["direction"])
            add("around", "from around", -180.0, 180.0, around)
            add("height", "from height", -90.0, 90.0, height)
    return controls


def with_light_changed(given: phong.Light, key: str, value: float) -> phong.Light:
    """The light with what one of its sliders says."""
    light = given.to_dict()
    if key == "strength":
        color = light.get("color", 1.0)
        old = _strength(color)
        if isinstance(color, Sequence) and old > 0:
            return given.replace(color=[float(c) * value / old for c in color])
        return given.replace(color=value)
    if key.startswith("position "):
        place = [float(v) for v in light["position"]]
        place["xyz".index(key[-1])] = value
        return given.replace(position=place)
    around, height = _angles(light["direction"])
    around, height = (value, height) if key == "around" else (around, value)
    a, h = math.radians(around), math.radians(height)
    away = (math.cos(h) * math.sin(a), math.sin(h), math.cos(h) * math.cos(a))
    return given.replace(direction=[-v for v in away])


def material_controls(materials: Mapping[str, phong.Material]) -> list[Control]:
    """The numbers of each material that its model has, in the ranges of the scene text."""
    controls: list[Control] = []
    for number, (name, one) in enumerate(materials.items()):
        material = one.to_dict()
        for key, (least, most, default) in _ranges(str(material.get("model", "phong"))).items():
            value = material.get(key, default)
            if isinstance(value, (int, float)):
                far = min(most, _FAR.get(key, max(2.0, 2 * value)))
                controls.append(
                    Control(
                        f"material/{number}/{key}", name, key, least, max(far, value), float(value)
                    )
                )
    return controls


def _strength(color: float | Sequence[float]) -> float:
    return float(max(color)) if isinstance(color, Sequence) else float(color)


def _angles(direction: Sequence[float]) -> tuple[float, float]:
    """Whence a distant light comes: degrees around Y from Z, and above the level."""
    x, y, z = (-float(v) for v in direction)
    return math.degrees(math.atan2(x, z)), math.degrees(math.atan2(y, math.hypot(x, z)))


@cache
def _ranges(model: str) -> dict[str, tuple[float, float, float]]:
    """Least, most and default of every number of a model, from the table of keys."""
    material = json.loads(_phong.schema())["properties"]["materials"]["additionalProperties"]
    properties: dict[str, Any] = dict(material["properties"])
    for rule in material.get("allOf", []):
        said = rule.get("if", {}).get("properties", {}).get("model", {})
        if model == said.get("const") or model in said.get("enum", ()):
            properties.update(rule["then"].get("properties", {}))
    ranges: dict[str, tuple[float, float, float]] = {}
    for key, kinds in properties.items():
        if kinds is False or key.endswith("color") or "default" not in kinds:
            continue
        for kind in kinds.get("anyOf", [kinds]):
            if kind.get("type") == "number":
                least = kind.get("minimum", kind.get("exclusiveMinimum", 0.0) + 1e-3)
                ranges[key] = (float(least), float(kind["maximum"]), float(kinds["default"]))
    return ranges
