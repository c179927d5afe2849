#!/usr/bin/env python3
"""A contact sheet of models, each drawn by two builds of the program side by side.

    python3 bench/sheet.py BEFORE AFTER SHEET.png MODEL [MODEL ...]     (needs Pillow)

BEFORE and AFTER are two `phong` programs. Under each pair stand the model's name and the share of pixels that differ by
more than 4 of 255; a model that a build refuses has its first error instead of a picture. What a build warns of is
printed.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image, ImageChops, ImageDraw

SIZE = 240, 180
LINE = 16
PAIRS = 4  # in a row
PAPER, INK = (255, 255, 255), (20, 20, 20)


def draw(program, model, folder):
    """The picture, or what was said instead of one; and what was said beside it."""
    out = Path(folder) / "picture.png"
    command = [program, "render", model, "-o", out, "--size", f"{SIZE[0]}x{SIZE[1]}", "--samples", "4", "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    said = done.stderr.strip()
    if done.returncode != 0:
        return None, said
    return Image.open(out).convert("RGB").copy(), said


def cell(picture, said):
    if picture is not None:
        return picture
    sheet = Image.new("RGB", SIZE, (230, 230, 230))
    words = said.splitlines()[0] if said else "no picture"
    ImageDraw.Draw(sheet).text((6, 6), "\n".join(words[i : i + 36] for i in range(0, len(words), 36)), INK)
    return sheet


def differing(one, other):
    """The share of pixels that differ by more than 4 of 255 in a channel."""
    red, green, blue = ImageChops.difference(one, other).split()
    counts = ImageChops.lighter(ImageChops.lighter(red, green), blue).histogram()
    return sum(counts[5:]) / sum(counts)


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    before, after, sheet_at, *models = sys.argv[1:]
    rows = -(-len(models) // PAIRS)
    sheet = Image.new("RGB", (PAIRS * 2 * SIZE[0], rows * (SIZE[1] + LINE)), PAPER)
    ink = ImageDraw.Draw(sheet)
    with tempfile.TemporaryDirectory() as folder:
        for number, model in enumerate(models):
            x, y = number % PAIRS * 2 * SIZE[0], number // PAIRS * (SIZE[1] + LINE)
            cells = []
            for program in (before, after):
                picture, said = draw(program, model, folder)
                if said:
                    print(f"{Path(model).name}, {Path(program).name}: {said.splitlines()[0]}")
                cells.append(cell(picture, said))
            sheet.paste(cells[0], (x, y))
            sheet.paste(cells[1], (x + SIZE[0], y))
            label = f"{Path(model).name}: {100 * differing(*cells):.1f} % differ"
            ink.text((x + 4, y + SIZE[1] + 2), label, INK)
    sheet.save(sheet_at)


if __name__ == "__main__":
    main()
