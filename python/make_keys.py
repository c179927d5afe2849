"""Writes ``phong/_keys.pyi`` from the table of keys: ``python python/make_keys.py``.

The classes take whatever keys the scene text has, so that a new key needs nothing in Python.
Editors and type checkers want to know them all the same: they are written here, and a test says
when this has to run again.
"""

from __future__ import annotations

import json
import keyword
import textwrap
from pathlib import Path
from typing import Any

from phong import _phong

#: Each class, and where its table stands in the schema.
CLASSES = {
    "Camera": "camera",
    "Light": "light",
    "Material": "materials",
    "Texture": "textures",
    "Sphere": "sphere",
    "Plane": "plane",
    "Triangle": "triangle",
    "Disc": "disc",
    "Box": "box",
    "Cylinder": "cylinder",
    "Cone": "cone",
    "Torus": "torus",
}
#: Those that may have a name of their own, as the first argument.
NAMED = {"Material", "Texture"}
HEAD = '''# Written by python/make_keys.py from the table of keys; not by hand.
from typing import Any, Literal, Self, TypeAlias

from numpy.typing import ArrayLike

_Color: TypeAlias = ArrayLike | str

class Keys:
    """A table of the scene text. It is checked where it is made, and does not change after that."""

    def __getattr__(self, key: str) -> Any: ...
    def replace(self, **keys: Any) -> Self: ...
    def to_dict(self) -> dict[str, Any]: ...
    def __eq__(self, other: object) -> bool: ...
    def __hash__(self) -> int: ...

class Shape(Keys):
    """A shape for :meth:`phong.Scene.add`. ``material``: a :class:`Material`, or a name of one."""
'''


def kinds(schema: dict[str, Any]) -> list[str]:
    """The types of Python that a value may have."""
    if "anyOf" in schema:
        if any(option.get("title", "").startswith("linear") for option in schema["anyOf"]):
            return ["_Color"]
        found = [kind for option in schema["anyOf"] for kind in kinds(option)]
        return list(dict.fromkeys(found))
    if "enum" in schema:
        return [f"Literal[{', '.join(json.dumps(word) for word in schema['enum'])}]"]
    if "texture" in schema.get("properties", {}):
        return ["Texture", "dict[str, Any]"]
    simple = {
        "string": "str",
        "boolean": "bool",
        "integer": "int",
        "number": "float",
        "array": "ArrayLike",
        "object": "dict[str, Any]",
    }
    return [simple[schema["type"]]] if "type" in schema else ["Any"]


def words(schema: dict[str, Any]) -> str:
    """What a key means."""
    said = schema.get("description")
    if said is None:
        said = " / ".join(
            option["description"] for option in schema.get("anyOf", []) if "description" in option
        )
    default = f" Default: {json.dumps(schema['default'])}." if "default" in schema else ""
    return str(said) + default


def table(name: str, schema: dict[str, Any]) -> str:
    """The class of one table."""
    required = schema.get("required", [])
    properties = sorted(schema["properties"].items(), key=lambda item: item[0] not in required)
    arguments, said = [], []
    for key, value in properties:
        is_shape = name not in ("Camera", "Light", "Material", "Texture")
        options = ["Material", "str"] if is_shape and key == "material" else kinds(value)
        kind = " | ".join(options)
        spelt = f"{key}_" if keyword.iskeyword(key) else key
        arguments.append(
            f"{spelt}: {kind}" if key in required else f"{spelt}: {kind} | None = None"
        )
        line = f"``{spelt}``: {words(value)}".replace("\\", "\\\\").replace('"""', "'''")
        said.append(textwrap.fill(line, 92, subsequent_indent="    "))
    base = "Keys" if name in ("Camera", "Light", "Material", "Texture") else "Shape"
    called = ["called: str | None = None", "/"] if name in NAMED else []
    description = textwrap.indent("\n".join([schema["description"], "", *said]), "    ").lstrip()
    body = ",\n        ".join(["self", *called, "*", *arguments])
    return (
        f'class {name}({base}):\n    """{description}\n    """\n\n'
        f"    def __init__(\n        {body},\n    ) -> None: ...\n"
    )


def stub() -> str:
    """The whole stub."""
    tables = json.loads(_phong.schema())["properties"]
    classes = []
    for name, key in CLASSES.items():
        schema = tables[key]
        schema = schema.get("items", schema.get("additionalProperties") or schema)
        classes.append(table(name, schema))
    lines = "\n".join([HEAD, *classes]).splitlines()
    return "\n".join(line.rstrip() for line in lines) + "\n"


if __name__ == "__main__":
    Path(__file__).with_name("phong").joinpath("_keys.pyi").write_text(stub(), encoding="utf-8")
