"""From which side scenes are looked at."""

from __future__ import annotations

from typing import Literal

#: What ``Scene.frame`` takes.
View = Literal["front", "back", "left", "right", "top", "bottom", "iso"]
