"""A folder of finished results: files named by their content, whole or not there."""

from __future__ import annotations

import hashlib
import os
import re
import tempfile
from pathlib import Path

_NAME = re.compile(r"([0-9a-f]{40})-(\d+)of(\d+)-([0-9a-f]{16})\.part")


def digest_of(*texts: str) -> str:
    """Forty hexadecimal digits that stand for the texts."""
    whole = hashlib.sha256()
    for text in texts:
        whole.update(len(text).to_bytes(8, "little"))
        whole.update(text.encode())
    return whole.hexdigest()[:40]


def write_whole(path: Path, content: bytes) -> None:
    """Writes a file that is complete or absent, whatever happens meanwhile."""
    handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        os.chmod(name, 0o666 & ~_umask())
        os.replace(name, path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def _umask() -> int:
    """What files may not be, which can only be asked by setting it."""
    mask = os.umask(0o022)
    os.umask(mask)
    return mask


class Store:
    """The folder.

    A file's name holds what was asked for, which share of how many it is, and a checksum of what is
    in it; one that does not agree with its name counts as absent.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)

    def names(self, asked: str) -> set[tuple[int, int]]:
        """What there is of what was asked for, as (share, of how many); some may be damaged."""
        matches = (_NAME.fullmatch(path.name) for path in self.folder.glob(f"{asked}-*.part"))
        return {(int(match[2]), int(match[3])) for match in matches if match is not None}

    def read(self, asked: str, index: int, count: int) -> bytes | None:
        """A share; None where it is not there, or damaged."""
        for path in sorted(self.folder.glob(f"{asked}-{index}of{count}-*.part")):
            match = _NAME.fullmatch(path.name)
            content = path.read_bytes()
            if match is not None and hashlib.sha256(content).hexdigest()[:16] == match[4]:
                return content
        return None

    def write(self, asked: str, index: int, count: int, content: bytes) -> None:
        """Keeps a share."""
        check = hashlib.sha256(content).hexdigest()[:16]
        write_whole(self.folder / f"{asked}-{index}of{count}-{check}.part", content)
