"""How far a picture is: a bar of tqdm where that is installed, else a line of text."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from types import TracebackType
from typing import Any, Self

#: Seconds after which a bar is shown that nobody asked for.
_A_WHILE = 1.0
#: Seconds between two changes of what is shown.
_OFTEN = 0.1


def _is_watched() -> bool:
    """Whether somebody looks: a terminal in an interactive session, or a notebook."""
    if hasattr(sys, "ps1") and sys.stderr is not None and sys.stderr.isatty():
        return True
    shell = sys.modules.get("IPython")
    return shell is not None and shell.get_ipython() is not None


class Listener:
    """Shows progress; ``listen`` is what the renderer calls, or ``None`` where nobody looks."""

    listen: Callable[[int, int], None] | None

    def __init__(self, progress: bool | Callable[[float], object] | None) -> None:
        self._tell = progress if callable(progress) else None
        shown = _is_watched() if progress is None else bool(progress)
        self.listen = self._heard if shown else None
        self._patience = _A_WHILE if progress is None else 0.0
        self._began = time.monotonic()
        self._last = 0.0
        self._bar: Any = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._bar is not None:
            self._bar.close()

    def _heard(self, done: int, of: int) -> None:
        if self._tell is not None:
            self._tell(done / of if of else 0.0)
            return
        now = time.monotonic()
        is_last = done >= of > 0
        if now - self._began < self._patience or of == 0:
            return
        if now - self._last < _OFTEN and not is_last:
            return
        self._last = now
        if self._bar is None:
            self._bar = _bar(of)
        self._bar.update(done - self._bar.n)


def _bar(total: int) -> Any:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _Line(total)
    return tqdm(total=total, unit="sample", unit_scale=True, leave=False)


class _Line:
    """One line of text on standard error."""

    def __init__(self, total: int) -> None:
        self.n = 0
        self._total = total

    def update(self, more: int) -> None:
        self.n += more
        if sys.stderr is not None:
            print(f"\rrendering: {100 * self.n // self._total} %", end="", file=sys.stderr)

    def close(self) -> None:
        if sys.stderr is not None and self.n:
            print(file=sys.stderr)
