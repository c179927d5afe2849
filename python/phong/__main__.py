"""``python -m phong``: the program."""

from __future__ import annotations

import sys


def main() -> int:
    """Does what the command line asks for; the exit code."""
    from phong import _phong

    return _phong.main(["phong", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
