"""What type checkers see is what there is."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path
from types import ModuleType

import pytest

import phong
from phong import _phong


def writer() -> ModuleType:
    path = Path(__file__).parents[1] / "make_keys.py"
    spec = importlib.util.spec_from_file_location("make_keys", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_stub_of_keys_is_that_of_the_table_of_keys() -> None:
    stub = Path(__file__).parents[1] / "phong" / "_keys.pyi"
    assert stub.read_text(encoding="utf-8") == writer().stub(), "run python python/make_keys.py"


def test_every_shape_of_the_text_has_a_class() -> None:
    tables = set(json.loads(_phong.schema())["properties"])
    tables -= {
        "version",
        "image",
        "ambient",
        "ambient_occlusion",
        "fog",
        "sky",
        "clip",
        "outline",
        "furniture",
        "title",
        "scale_bar",
        "axes",
        "legend",
        "label",
        "tone",
        "groups",
        "include",
        "instance",
    }
    tables -= {"mesh", "points", "cylinders", "molecule"}  # they are made of arrays, or read
    assert tables == set(writer().CLASSES.values())


@pytest.mark.parametrize("name", phong.__all__)
def test_everything_public_is_there_and_documented(name: str) -> None:
    value = getattr(phong, name)
    assert isinstance(value, str) or value.__doc__


@pytest.mark.parametrize("kind", [_phong.Scene, _phong.Image, _phong.Part, _phong.Cancel])
def test_every_method_is_documented(kind: type) -> None:
    for name, value in vars(kind).items():
        if not name.startswith("_"):
            assert value.__doc__, f"{kind.__name__}.{name}"
