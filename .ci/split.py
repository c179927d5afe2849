#!/usr/bin/env python3
"""Parts a module of WebAssembly in two: `python3 .ci/split.py MODULE REST`.

MODULE keeps what every scene needs. What few do is moved to REST: letters and their drawing, models of other programs,
images, cuts, occlusion, outlines, files that are written, grades. REST is fetched when one of its functions is called for
the first time.
No function is changed, so the bits are the same. Binaryen's `wasm-split` does it; this says which functions go.
"""

import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

MODULE, REST = Path(sys.argv[1]), Path(sys.argv[2])
# The font, which nothing but functions of the rest reads: it is part of that.
FONT = Path(__file__).resolve().parent.parent / "crates/phong-lab/src/furniture/font/sans.ttf"
FEATURES = ["simd", "bulk-memory", "sign-ext", "mutable-globals", "nontrapping-float-to-int", "reference-types", "multivalue"]
TABLE = 1  # the kind of an export
# Whether a file is of a format is asked of every file, what may have been made of things is asked when they go, and rays of
# every scene come by where those of a cut one part.
ALWAYS = re.compile(r"^core::ptr::drop_in_place|::(is_\w+|First::of)\b|view::clip::<impl phong::view::View>")
# What few scenes need, by the paths of functions. What only these call goes with them.
SELDOM = re.compile(
    r"\b(rustybuzz|unicode_\w+|ttf_parser|tiny_skia\w*|zune_\w+|bevy_mikktspace"
    r"|fdeflate|miniz_oxide|flate2|png::(adam7|decoder|encoder|filter)"
    r"|phong_lab::(furniture|draw|grade|figures|tell::html)"
    r"|phong::(view::clip|integrator::openness|part::settings|finish::(outline|cel|patch))"
    r"|phong_scene::(molecule|texels::(decoded|file|jpeg|png|radiance))"
    r"|phong_scene::format::(gltf|tachyon|ply|obj|off|nff|stl|cif|gro|pdb|xyz|lammps|atoms|dcd|mtl|frames)"
    r"|phong::(image::(exr|jpeg|picture|png::write|write)|part::(join|tone|Part|write)|geometry::tangents))\b"
)


def number(data, at):
    """A number of LEB128, and where the next thing is."""
    value = shift = 0
    while True:
        byte = data[at]
        value |= (byte & 127) << shift
        at, shift = at + 1, shift + 7
        if byte < 128:
            return value, at


def sections(data):
    """The sections of a module: number, first byte, and the first behind it."""
    at = 8
    while at < len(data):
        length, start = number(data, at + 1)
        yield data[at], start, start + length
        at = start + length


def functions(data):
    """The names of functions by their numbers, and the numbers of those that tables hold."""
    names, held = {}, set()
    for kind, at, end in sections(data):
        if kind == 9:
            # Only what wasm-bindgen and the linker write: lists of functions for a table.
            count, at = number(data, at)
            for _ in range(count):
                flags, at = number(data, at)
                assert flags in (0, 2), f"a table is filled in a way that is not known: {flags}"
                if flags == 2:
                    _, at = number(data, at)
                assert data[at] == 0x41, "a table is filled from a place that is no constant"
                _, at = number(data, at + 1)
                at += 1 + (flags == 2)
                many, at = number(data, at)
                for _ in range(many):
                    function, at = number(data, at)
                    held.add(function)
        if kind == 0:
            length, at = number(data, at)
            name, at = data[at : at + length], at + length
            while name == b"name" and at < end:
                part = data[at]
                length, at = number(data, at + 1)
                behind = at + length
                if part == 1:
                    count, at = number(data, at)
                    for _ in range(count):
                        function, at = number(data, at)
                        length, at = number(data, at)
                        names[function], at = data[at : at + length].decode(), at + length
                at = behind
    return names, held


def seldom(module):
    """The names of the functions that go."""
    names, held = functions(module.read_bytes())
    words = ["wasm-opt", *(f"--enable-{one}" for one in FEATURES), "--print-call-graph", module, "-o", "/dev/null"]
    graph = subprocess.run(words, check=True, capture_output=True, text=True).stdout
    callers = defaultdict(set)
    for caller, called in re.findall(r'"([^"]+)" -> "([^"]+)"', graph):
        callers[called].add(caller)
    every = sorted(set(names.values()))
    told = subprocess.run(["c++filt"], check=True, capture_output=True, text=True, input="\n".join(every)).stdout
    gone = {name for name, path in zip(every, told.split("\n")) if SELDOM.search(path) and not ALWAYS.search(path)}
    held = {names[function] for function in held if function in names}
    # What else is called by these alone.
    fresh = True
    while fresh:
        fresh = {name for name, by in callers.items() if name not in gone and name not in held and by <= gone}
        gone |= fresh
    return sorted(gone & set(names.values()))


def written(value):
    """A number as LEB128."""
    out = bytearray()
    while True:
        value, low = value >> 7, value & 127
        out.append(low | (128 if value else 0))
        if not value:
            return bytes(out)


def with_exports(data, change):
    """A module whose list of exports, each its kind and its bytes, is changed."""
    out = bytearray(data[:8])
    for kind, start, end in sections(data):
        content = data[start:end]
        if kind == 7:
            count, at = number(data, start)
            exports = []
            for _ in range(count):
                begin = at
                length, at = number(data, at)
                exported = data[at + length]
                _, at = number(data, at + length + 1)
                exports.append((exported, data[begin:at]))
            exports = change(exports)
            content = written(len(exports)) + b"".join(entry for _, entry in exports)
        out += bytes([kind]) + written(len(content)) + content
    return bytes(out)


def without_font(data):
    """A module with zeros in the place of the font, and where in memory that is."""
    font = FONT.read_bytes()
    for kind, at, end in sections(data):
        if kind != 11:
            continue
        count, at = number(data, at)
        for _ in range(count):
            assert data[at] == 0 and data[at + 1] == 0x41, "memory is filled in a way that is not known"
            place, at = number(data, at + 2)
            length, at = number(data, at + 1)
            found = data.find(font, at, at + length)
            if found >= 0:
                return data[:found] + bytes(len(font)) + data[found + len(font) :], place + found - at
            at += length
    sys.exit("the font is not where it was")


def with_font(data, place):
    """A module that puts the font into memory when it is loaded."""
    assert all(kind != 11 for kind, _, _ in sections(data)), "the rest has memory of its own to fill"
    font = FONT.read_bytes()
    # The place as a constant. Its number has a sign, which five bytes always leave room for.
    constant = bytes([0x41]) + bytes(place >> shift & 127 | 128 for shift in (0, 7, 14, 21)) + bytes([place >> 28, 0x0B])
    content = bytes([1, 0]) + constant + written(len(font)) + font
    section = bytes([11]) + written(len(content)) + content
    ends = [end for kind, _, end in sections(data) if kind == 10]
    return data[: ends[0]] + section + data[ends[0] :]


def main():
    gone = seldom(MODULE)
    assert len(gone) > 500, f"only {len(gone)} functions are known by their names"
    names = REST.with_suffix(".txt")
    names.write_text("\n".join(gone) + "\n")
    # Tables that are exported are taken aside, as `wasm-split` takes the first of them for the one of functions.
    tables = []

    def aside(exports):
        tables.extend(entry for entry in exports if entry[0] == TABLE)
        return [entry for entry in exports if entry[0] != TABLE]

    MODULE.write_bytes(with_exports(MODULE.read_bytes(), aside))
    words = ["wasm-split", *(f"--enable-{one}" for one in FEATURES), "--export-prefix=%", f"--split-funcs=@{names}"]
    subprocess.run([*words, MODULE, "-o1", f"{MODULE}.part", "-o2", REST], check=True)
    part = Path(f"{MODULE}.part")

    def back(exports):
        # It exports all tables, in their order, but says of each that it is the first.
        numbers = iter(range(len(exports)))
        last = lambda entry, place: entry[:-1] + bytes([place])
        numbered = [(kind, last(entry, next(numbers)) if kind == TABLE else entry) for kind, entry in exports]
        return [*numbered, *tables]

    module, place = without_font(with_exports(part.read_bytes(), back))
    MODULE.write_bytes(module)
    REST.write_bytes(with_font(REST.read_bytes(), place))
    part.unlink()
    names.unlink()


main()
