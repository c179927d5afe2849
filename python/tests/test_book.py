"""The Python of the book's pages runs as it stands there."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from drawing import need

# Other packages warn of what is to come.
pytestmark = pytest.mark.filterwarnings("default")

BOOK = Path(__file__).resolve().parents[2] / "book/src"
SCENES = BOOK.parents[1] / "scenes"
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.M | re.S)


PAGES = [path.stem for path in sorted(BOOK.glob("*.md")) if "import phong" in path.read_text()]


@pytest.mark.parametrize("page", PAGES)
def test_the_python_of_a_page_runs(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for package in ("ase", "anywidget", "distributed"):
        need(package)
    blocks = BLOCK.findall((BOOK / f"{page}.md").read_text())
    assert blocks, f"{page}.md has no Python"
    monkeypatch.chdir(tmp_path)
    shutil.copy(SCENES / "two-balls.toml", "scene.toml")
    scope: dict[str, object] = {"__name__": "__main__"}
    for number, block in enumerate(blocks, 1):
        exec(compile(block, f"{page}.md, block {number}", "exec"), scope)
