#!/usr/bin/env python3
"""Keeps the studio busy for a while, and tells what memory it has before and after.

`python3 .ci/soak.py PHONG [--minutes N] [--scene FILE] [--pause SECONDS] [--keep]`: clients come, turn the
scene, change it, ask and go, some of them in the middle of a picture, and some without a word, so that the
server has to find out. At the end memory may not have grown by more than a quarter and 4 MiB, open files
and threads not at all, and the last picture is the first, byte for byte. `--pause`: seconds between two
clients, on a machine that has other things to do.

What is measured is what the program holds: glibc is told to give every block of 16 kB and more back to the system
when it is freed. By itself it keeps what was freed for what comes, for each thread the most that it ever had, which
hides a leak of less, and is more or less as the threads happen to share the tiles. `--keep` lets it do so: then
memory is told as a user sees it, and only a growth to twice what one picture takes is an error.
"""

import argparse
import base64
import json
import os
import random
import socket
import struct
import subprocess
import time
from pathlib import Path
from urllib.parse import urlparse


# glibc gives back what is freed.
GIVES_BACK = {"MALLOC_MMAP_THRESHOLD_": "16384", "MALLOC_MMAP_MAX_": "1000000"}


class Client:
    """A page without a browser: a WebSocket, as RFC 6455 has it, as far as it is needed here."""

    def __init__(self, url):
        parsed = urlparse(url)
        token = parsed.query.partition("token=")[2]
        self.socket = socket.create_connection((parsed.hostname, parsed.port), timeout=60)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET /{token}/engine HTTP/1.1\r\nHost: {parsed.netloc}\r\nOrigin: http://{parsed.netloc}\r\n"
            "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
            f"Sec-WebSocket-Key: {key}\r\n\r\n".encode()
        )
        self.file = self.socket.makefile("rb")
        status = self.file.readline()
        assert b"101" in status, status
        while self.file.readline().strip():
            pass
        # The newest picture; how many messages of tiles came, and bytes in them.
        self.look, self.tiles, self.bytes = {}, 0, 0

    def ask(self, **request):
        self.say(0x81, json.dumps(request).encode())

    def say(self, kind, data):
        head = bytes([kind]) + (bytes([0x80 | len(data)]) if len(data) < 126 else bytes([0xFE]) + struct.pack(">H", len(data)))
        self.socket.sendall(head + bytes(4) + data)  # a mask of zeros is a mask

    def hear(self):
        """The next reply, or the bytes of the next frame."""
        first, second = self.file.read(2)
        length = second & 127
        if length > 125:
            length = int.from_bytes(self.file.read(2 if length == 126 else 8), "big")
        data = self.file.read(length)
        if first & 15 == 9:
            # Whoever does not answer for a minute is taken for gone: so long can a picture take on a busy machine.
            self.say(0x8A, data)
            return self.hear()
        return json.loads(data) if first & 15 == 1 else data

    def until(self, kind, **fields):
        while True:
            reply = self.hear()
            if isinstance(reply, bytes):
                self.tiles += 1
                self.bytes += len(reply)
                continue
            if reply["is"] == "look":
                self.look = reply
            if reply["is"] == kind and all(reply[key] == value for key, value in fields.items()):
                return reply

    def drawn(self):
        """Waits until the newest picture is done."""
        while True:
            reply = self.until("pass")
            if reply["picture"] == self.look["picture"] and reply["pass"] + 1 == reply["passes"]:
                return

    def picture(self):
        self.ask(do="export", format="png")
        self.until("file")
        return self.hear()

    def close(self):
        # The socket is closed when its file is as well.
        self.file.close()
        self.socket.close()


def resident(process):
    """Bytes of memory that a process has now."""
    pages = Path(f"/proc/{process.pid}/statm").read_text().split()[1]
    return int(pages) * os.sysconf("SC_PAGE_SIZE")


def held(process):
    """How many files and threads a process has now."""
    folder = Path(f"/proc/{process.pid}")
    return len(list((folder / "fd").iterdir())), len(list((folder / "task").iterdir()))


def busy(process):
    """Seconds that processors have worked for a process."""
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def visit(url, name, dice):
    """A client comes, does this and that, and goes. How many pictures were begun."""
    client = Client(url)
    client.until("hello")
    client.ask(do="open", path=name)
    client.until("look")
    for _ in range(dice.randrange(5, 40)):
        what = dice.randrange(5)
        if what == 0:
            client.ask(do="zoom", by=dice.choice([0.9, 1.1]))
        elif what == 1:
            client.ask(do="explain", id=1, pixel=[dice.randrange(20), dice.randrange(20)])
        elif what == 2:
            client.ask(do="look", set={"camera.fov": dice.uniform(20, 60)})
        else:
            client.ask(do="turn", by=[dice.uniform(-0.1, 0.1), dice.uniform(-0.05, 0.05)])
        if what != 1:
            client.until("look")
    if dice.randrange(3):
        client.drawn()
    pictures = client.look["picture"]
    if dice.randrange(4) == 0:
        # In the middle of a message, and by a reset.
        client.socket.sendall(bytes([0x81, 0xFE, 0x01]))
        client.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    client.close()
    return pictures


def soak(arguments):
    scene = Path(arguments.scene).resolve()
    words = [arguments.phong, "studio", scene, "--no-open"]
    env = os.environ if arguments.keep else {**os.environ, **GIVES_BACK}
    studio = subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=env)
    try:
        url = studio.stdout.readline().strip()
        dice = random.Random(1)
        client = Client(url)
        client.until("hello")
        client.ask(do="open", path=scene.name)
        client.until("look")
        client.drawn()
        first = client.picture()
        client.close()
        for _ in range(5):
            visit(url, scene.name, dice)
        time.sleep(0.5)
        before, held_before = resident(studio), held(studio)
        begun = told = time.monotonic()
        end, visits, pictures, most = begun + 60 * arguments.minutes, 0, 0, before
        while time.monotonic() < end:
            pictures += visit(url, scene.name, dice)
            visits += 1
            most = max(most, resident(studio))
            time.sleep(arguments.pause)
            if time.monotonic() - told > 60:
                told = time.monotonic()
                print(f"{(told - begun) / 60:.0f} min: {visits} clients, memory {resident(studio) / 2**20:.1f} MiB", flush=True)
        patience = time.monotonic() + 30
        more = lambda: any(now > then for now, then in zip(held(studio), held_before))
        while more() and time.monotonic() < patience:
            time.sleep(0.5)
        after, held_after = resident(studio), held(studio)
        client = Client(url)
        client.ask(do="open", path=scene.name)
        client.until("look")
        client.drawn()
        assert client.picture() == first, "the last picture is not the first"
        client.close()
        mib = [f"{n / 2**20:.1f}" for n in (before, most, after)]
        print(f"{arguments.minutes} min: {visits} clients, {pictures} pictures begun; memory {mib[0]} MiB, at most {mib[1]}, at the end {mib[2]}")
        print(f"open files and threads: {held_before} before, {held_after} at the end")
        assert after <= (2 * before if arguments.keep else 1.25 * before + 2**22), "memory has grown"
        # Not asked again: the last client has just gone.
        assert all(now <= then for now, then in zip(held_after, held_before)), "sessions have stayed"
    finally:
        studio.terminate()
        studio.wait()


def speed(arguments):
    """Pictures a second while a scene is turned: the next turn is asked for when the last is seen."""
    scene = Path(arguments.scene).resolve()
    studio = subprocess.Popen([arguments.phong, "studio", scene, "--no-open"], stdout=subprocess.PIPE, text=True)
    try:
        client = Client(studio.stdout.readline().strip())
        client.until("hello")
        client.ask(do="open", path=scene.name)
        client.until("look")
        client.ask(do="look", set={"image.size": [480, 270]})
        client.until("look")
        client.drawn()
        count, begun, worked = 0, time.monotonic(), busy(studio)
        while time.monotonic() - begun < arguments.seconds:
            client.ask(do="turn", by=[0.01, 0.002])
            client.until("look")
            client.until("pass", picture=client.look["picture"], **{"pass": arguments.full})
            count += 1
        took, worked = time.monotonic() - begun, busy(studio) - worked
        print(
            f"{scene.name} at 480 x 270, to pass {arguments.full}: {count} pictures, {count / took:.1f} a second, "
            f"{1000 * worked / count:.1f} ms of processors each"
        )
    finally:
        studio.terminate()
        studio.wait()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("phong")
    parser.add_argument("--scene", default="scenes/two-balls.toml")
    parser.add_argument("--minutes", type=float, default=60)
    parser.add_argument("--pause", type=float, default=0, help="seconds between two clients")
    parser.add_argument("--keep", action="store_true", help="let the allocator keep what was freed")
    parser.add_argument("--seconds", type=float, help="measure pictures a second for so long, and nothing else")
    parser.add_argument("--full", type=int, default=0, help="the pass that counts as a picture: 0 at an eighth of the size, 1 in full")
    arguments = parser.parse_args()
    if arguments.seconds:
        speed(arguments)
    else:
        soak(arguments)


if __name__ == "__main__":
    main()
