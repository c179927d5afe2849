"""Puts the functions of a module of WebAssembly in an order that packs well.

gzip finds again what it has seen in the last 32 kB. So each function is followed by the one that has most in common with
those just before it. No function is changed but for the numbers of those it calls, so the bits are the same.
"""

from collections import Counter, defaultdict

# What functions have in common is told by every other string of so many bytes that is in a few of them.
LENGTH, EVERY, MOST = 6, 2, 30
# How many of the last functions count.
LAST = 8
CALLS = (0x10, 0xD2)  # instructions that name a function: call, ref.func
# Instructions without anything behind them, with one number, with two.
PLAIN = {0x00, 0x01, 0x05, 0x0B, 0x0F, 0x1A, 0x1B, 0xD1, *range(0x45, 0xC5)}
ONE = {0x02, 0x03, 0x04, 0x0C, 0x0D, *range(0x20, 0x27), 0x3F, 0x40, 0x41, 0x42, 0xD0}
TWO = {0x11, *range(0x28, 0x3F)}


def number(data, at):
    """A number of LEB128, and where the next thing is."""
    value = shift = 0
    while True:
        byte = data[at]
        value |= (byte & 127) << shift
        at, shift = at + 1, shift + 7
        if byte < 128:
            return value, at


def written(value):
    """A number as LEB128."""
    out = bytearray()
    while True:
        value, low = value >> 7, value & 127
        out.append(low | (128 if value else 0))
        if not value:
            return bytes(out)


def sections(data):
    """The sections of a module: number, first byte, and the first behind it."""
    at = 8
    while at < len(data):
        length, start = number(data, at + 1)
        yield data[at], start, start + length
        at = start + length


def behind(data, at, numbers):
    """Where so many numbers end."""
    for _ in range(numbers):
        while data[at] > 127:
            at += 1
        at += 1
    return at


def after(data, at):
    """Where the instruction at a place ends, if it names no function."""
    code, at = data[at], at + 1
    if code in PLAIN:
        return at
    if code in ONE:
        return behind(data, at, 1)
    if code in TWO:
        return behind(data, at, 2)
    if code in (0x43, 0x44):
        return at + (4 if code == 0x43 else 8)
    if code in (0x0E, 0x1C):
        count, at = number(data, at)
        return behind(data, at, count + (code == 0x0E))
    inner, at = number(data, at)
    if code == 0xFC and inner < 18:
        return behind(data, at, 0 if inner < 8 else 2 if inner in (8, 10, 12, 14) else 1)
    if code == 0xFD and inner < 256:
        if inner in (12, 13):
            return at + 16
        if inner < 12 or 84 <= inner <= 93:
            return behind(data, at, 2) + (84 <= inner <= 91)
        return at + (21 <= inner <= 34)
    raise ValueError(f"an instruction that is not known: {code:#x} {inner}")


def renumbered(body, numbers):
    """The code of a function, where other functions have other numbers."""
    out, last = bytearray(), 0
    count, at = number(body, 0)
    for _ in range(count):
        at = behind(body, at, 1) + 1
    while at < len(body):
        if body[at] in CALLS:
            called, end = number(body, at + 1)
            out += body[last : at + 1] + written(numbers[called])
            at = last = end
        else:
            at = after(body, at)
    assert at == len(body) and body[-1] == 0x0B, "a function does not end where it should"
    return bytes(out + body[last:])


def order(bodies):
    """The numbers of functions, each next to what is like it."""

    def strings(body):
        all_of_them = {body[i : i + LENGTH] for i in range(len(body) - LENGTH + 1)}
        return {one for one in all_of_them if len(body) < 100 or sum(one) % EVERY == 0}

    parts = [sorted(strings(body)) for body in bodies]
    known = Counter(one for part in parts for one in part)
    parts = [[one for one in part if 1 < known[one] <= MOST] for part in parts]
    held = defaultdict(list)
    for function, part in enumerate(parts):
        for one in part:
            held[one].append(function)
    # Short ones have less in common with others, and cost less.
    size = [(len(body) + 30) ** 0.6 for body in bodies]
    left, all_of_them = dict.fromkeys(range(len(bodies))), []
    function = 0
    while True:
        del left[function]
        all_of_them.append(function)
        if not left:
            return all_of_them
        common = defaultdict(float)
        for recent in all_of_them[-LAST:]:
            for one in parts[recent]:
                for other in held[one]:
                    if other in left:
                        common[other] += 1 / known[one]
        function = max(common, key=lambda other: common[other] / size[other]) if common else next(iter(left))


def ordered(data):
    """A module whose functions are in such an order."""
    imports, types, bodies = 0, [], []
    for kind, at, end in sections(data):
        if kind == 2:
            count, at = number(data, at)
            for _ in range(count):
                for _ in range(2):
                    length, at = number(data, at)
                    at += length
                imported, at = data[at], at + 1
                imports += imported == 0
                if imported in (1, 3):
                    at += 1  # of what type it is
                if imported in (1, 2):
                    limits, at = data[at], at + 1
                    at = behind(data, at, 1 + (limits & 1))
                else:
                    at = at + 1 if imported == 3 else behind(data, at, 1)
        if kind == 3:
            count, at = number(data, at)
            for _ in range(count):
                one, at = number(data, at)
                types.append(written(one))
        if kind == 10:
            count, at = number(data, at)
            for _ in range(count):
                length, at = number(data, at)
                bodies.append(data[at : at + length])
                at += length
    new = order(bodies)
    numbers = dict(enumerate(range(imports)))
    numbers.update((imports + function, imports + place) for place, function in enumerate(new))
    out = bytearray(data[:8])
    for kind, start, end in sections(data):
        content = data[start:end]
        assert kind != 8, "a module begins by itself"
        if kind == 3:
            content = written(len(new)) + b"".join(types[function] for function in new)
        if kind == 7:
            content = exports(data, start, numbers)
        if kind == 9:
            content = tables(data, start, numbers)
        if kind == 10:
            codes = [renumbered(bodies[function], numbers) for function in new]
            content = written(len(new)) + b"".join(written(len(code)) + code for code in codes)
        out += bytes([kind]) + written(len(content)) + content
    return bytes(out)


def exports(data, at, numbers):
    """The list of exports, where functions have other numbers."""
    count, at = number(data, at)
    out = bytearray(written(count))
    for _ in range(count):
        length, name = number(data, at)
        kind = name + length
        exported, end = number(data, kind + 1)
        out += data[at : kind + 1] + written(exported if data[kind] else numbers[exported])
        at = end
    return bytes(out)


def tables(data, at, numbers):
    """What tables are filled with, where functions have other numbers."""
    count, at = number(data, at)
    out = bytearray(written(count))
    for _ in range(count):
        flags, start = data[at], at
        assert flags in (0, 2), f"a table is filled in a way that is not known: {flags}"
        at = behind(data, at + 1, flags // 2)
        while data[at] != 0x0B:  # where in the table
            at = after(data, at)
        at += 1 + flags // 2
        many, at = number(data, at)
        out += data[start:at]
        for _ in range(many):
            function, at = number(data, at)
            out += written(numbers[function])
    return bytes(out)
