"""Other packages, imported when they are needed."""

from __future__ import annotations

import importlib
from typing import Any


def need(module: str, *, package: str, caller: str) -> Any:
    """The module, or an ImportError that says which package to install.

    Where the package is there but one that it needs is not, the error is the package's own.
    """
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or error.name.partition(".")[0] != module.partition(".")[0]:
            raise
        raise ImportError(
            f"{caller} needs the package {package}: pip install {package}", name=error.name
        ) from error


def wrong_type(caller: str, argument: str, wanted: str, value: object) -> TypeError:
    """What is raised for an argument of another type."""
    return TypeError(f"{caller}: {argument} is a {type(value).__qualname__}; wanted is {wanted}")
