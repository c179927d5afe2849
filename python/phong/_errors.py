"""What went wrong, as data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One thing to say about a scene."""

    severity: Literal["error", "warning"]
    """``"error"``: there is no picture; ``"warning"``: it may not be what was meant."""
    message: str
    """One sentence."""
    file: str | None = None
    """The file as it was named; ``None``: no file is at fault."""
    line: int | None = None
    """Line from 1; ``None``: the file has none, or all of it is meant."""
    column: int | None = None
    """Column in characters from 1."""
    help: str | None = None
    """The way out, if one is known."""

    def __str__(self) -> str:
        place = ":".join(str(part) for part in (self.file, self.line, self.column) if part)
        way_out = f" ({self.help})" if self.help else ""
        return f"{place}: {self.message}{way_out}" if place else f"{self.message}{way_out}"


class SceneError(ValueError):
    """A scene, or something for one, is wrong: ``diagnostics`` says all there is to say."""

    diagnostics: list[Diagnostic]

    def __init__(self, message: str, diagnostics: list[Diagnostic] | None = None) -> None:
        super().__init__(message, diagnostics)
        self.diagnostics = list(diagnostics or [])

    def __str__(self) -> str:
        return str(self.args[0])


class Cancelled(Exception):
    """The work was stopped by a :class:`phong.Cancel`."""
