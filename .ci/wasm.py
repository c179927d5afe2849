#!/usr/bin/env python3
"""Holds the renderer as WebAssembly against the program: `python3 .ci/wasm.py PHONG FOLDER [BROWSER...]`.

PHONG is the program, with `wasm` beside it as `bash .ci/wasm` makes it; into FOLDER go pictures and
screenshots. Every scene of the gallery is drawn at 320 × 180 in Node, with vector instructions and without,
and by two workers of the page of static files in Debian's Chromium. The EXR and PNG files have to be those of
the program, byte for byte, and a pixel explained the same. The page is served from a folder below the root
with the strictest policy it can work under.
"""

import base64
import gzip
import json
import subprocess
import sys
import threading
import time
from functools import partial
from itertools import product
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from playwright.sync_api import sync_playwright

import studio_walks

PHONG, FOLDER = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
CHROMIUM = "/usr/bin/chromium"
ROOT = Path(__file__).resolve().parent.parent
SCENES = sorted((ROOT / "scenes").glob("*.toml"))
SETS = ["--set", "image.size=[320, 180]", "--set", "image.samples=4"]
LARGEST = 1_170_000  # bytes of the first part of the module with vectors, gzipped: what is loaded before anything is seen
LARGEST_REST = 810_000  # bytes of its rest, gzipped
POLICY = (
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' blob: data:; "
    "connect-src 'self'; worker-src 'self'; base-uri 'self'; form-action 'none'; frame-ancestors 'none'"
)

# A molecule of three frames, from an eye that stays where it is.
TRAJECTORY = """version = 1
[image]
size = [320, 180]
samples = 4
[camera]
eye = [0, 2.2, 8]
look_at = [0, 0.9, 0]
fov = 30
[[light]]
kind = "point"
position = [-4, 6, 5]
[[molecule]]
file = "run.xyz"
"""

# Draws a scene with the page's own engine, and hands over the files and a pixel explained.
DRAW = """async ([path, size, samples]) => {
  const { connect } = await import("./engine.js");
  const replies = [];
  const files = [];
  const wake = [];
  const stir = () => wake.splice(0).forEach((go) => go());
  const engine = (globalThis.own ??= connect({
    hear: (reply) => (globalThis.heard(reply), undefined),
    take: (frame) => (globalThis.taken(frame), undefined),
    gone: () => globalThis.heard({ is: "gone" }),
  }));
  globalThis.heard = (reply) => { replies.push(reply); stir(); };
  globalThis.taken = (frame) => { if (frame.kind === "file") files.push(frame.bytes); stir(); };
  const until = async (test) => {
    for (;;) {
      const found = replies.findLast(test);
      if (found) return found;
      const bad = replies.find((reply) => reply.is === "error" || reply.is === "gone");
      if (bad) throw new Error(`${path}: ${JSON.stringify(bad)}`);
      await new Promise((resolve) => wake.push(resolve));
    }
  };
  engine.send({ do: "open", path });
  const first = await until((reply) => reply.is === "look");
  engine.send({ do: "look", set: { "image.size": size, "image.samples": samples } });
  const look = await until((reply) => reply.is === "look" && reply.picture > first.picture);
  await until((reply) => reply.is === "pass" && reply.picture === look.picture && reply.pass + 1 === reply.passes);
  for (const format of ["png", "exr"]) engine.send({ do: "export", format });
  await until(() => files.length === 2);
  engine.send({ do: "explain", id: 1, pixel: [150, 100] });
  const { told } = await until((reply) => reply.is === "explanation");
  const text = (bytes) => {
    let all = "";
    for (let i = 0; i < bytes.length; i += 8192) all += String.fromCharCode(...bytes.subarray(i, i + 8192));
    return btoa(all);
  };
  return { png: text(files[0]), exr: text(files[1]), told };
}"""

# Turns a scene again and again, each time the first pass of the last turn is there; turns a second.
TURN = """async ([path, size]) => {
  const engine = globalThis.own;
  let count = 0;
  let begun = 0;
  engine.send({ do: "open", path });
  engine.send({ do: "look", set: { "image.size": size } });
  return new Promise((resolve) => {
    globalThis.heard = (reply) => {
      if (reply.is !== "pass" || reply.pass !== 0) return;
      if (count === 5) begun = performance.now();
      if (count === 65) return resolve(60000 / (performance.now() - begun));
      count += 1;
      engine.send({ do: "turn", by: [0.02, 0] });
    };
    globalThis.taken = () => {};
  });
}"""


ASKED = []  # the paths that browsers have asked for


class Served(SimpleHTTPRequestHandler):
    extensions_map = {**SimpleHTTPRequestHandler.extensions_map, ".js": "text/javascript", ".wasm": "application/wasm"}

    def end_headers(self):
        self.send_header("Content-Security-Policy", POLICY)
        super().end_headers()

    def log_message(self, *_):
        ASKED.append(self.path)


def serve(folder):
    """A server of static files; its address."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Served, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server, f"http://127.0.0.1:{server.server_port}"


def numbers(told):
    """All of an explanation but the places in the text, which name the file as it was opened."""
    if isinstance(told, dict):
        return {key: numbers(value) for key, value in told.items() if key != "at"}
    return [numbers(value) for value in told] if isinstance(told, list) else told


def explained(scene, told):
    """A pixel explained; without what its level is made of where the picture exposes itself: one sample of
    a pixel is explained by the program, and so exposed, while the engine has a picture of four."""
    exposes_itself = 'exposure = "auto"' in scene.read_text()
    return {key: value for key, value in numbers(told).items() if not (exposes_itself and key in ("tone", "srgb8"))}


def native():
    """What the program makes of each scene."""
    all_of_them = {}
    folder = FOLDER / "native"
    folder.mkdir(parents=True, exist_ok=True)
    for scene in SCENES:
        made = [folder / f"{scene.stem}.{ending}" for ending in ("png", "exr")]
        for file in made:
            subprocess.run([PHONG, "render", scene, *SETS, "-o", file, "--quiet"], check=True)
        words = [PHONG, "explain", scene, "150", "100", "--samples", "1", "--json", *SETS]
        said = subprocess.run(words, check=True, capture_output=True, text=True)
        all_of_them[scene.stem] = (*(file.read_bytes() for file in made), explained(scene, json.loads(said.stdout)))
    return all_of_them


def compare(name, table, expected, got):
    """Notes what is the same, scene by scene."""
    for scene, values in expected.items():
        same = ["same" if a == b else "DIFFERS" for a, b in zip(values, got[scene], strict=True)]
        table.setdefault(scene, {})[name] = same


def in_node(kind):
    """What Node makes of them with this kind of module, and how long it took."""
    out = FOLDER / f"node-{kind}"
    out.mkdir(parents=True, exist_ok=True)
    begun = time.monotonic()
    words = ["node", ROOT / ".ci/wasm.mjs", PHONG.parent / "wasm", kind, out, *SCENES]
    subprocess.run(words, check=True)
    seconds = time.monotonic() - begun
    read = lambda stem: tuple((out / f"{stem}.{ending}").read_bytes() for ending in ("png", "exr"))
    told = lambda scene: explained(scene, json.loads((out / f"{scene.stem}.json").read_text()))
    return {scene.stem: (*read(scene.stem), told(scene)) for scene in SCENES}, seconds


def wait(page, expression, seconds=60):
    """Waits until an expression of the page is true; the page's policy forbids Playwright's own waiting."""
    end = time.monotonic() + seconds
    while not page.evaluate(expression):
        assert time.monotonic() < end, f"not within {seconds} s: {expression}"
        page.wait_for_timeout(5)


def open_page(browser, address, faults, **more):
    """A page that may ask nobody but its own server, and whose complaints are kept."""
    context = browser.new_context(viewport={"width": 1400, "height": 900}, **more)
    page = context.new_page()
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("console", lambda line: faults.append(line.text) if line.type == "error" else None)
    page.on("request", lambda request: None if request.url.startswith(("blob:", "data:", address.rsplit("/", 3)[0]))
            else faults.append(f"asks for {request.url}"))
    page.goto(address)
    return context, page


def in_chromium(browser, address, faults):
    """What two workers of the page make of the scenes."""
    context, page = open_page(browser, f"{address}?workers=2", faults)
    wait(page, "studio.look")
    page.click("#stop")  # the processor is for the engine that is tried
    got = {}
    begun = time.monotonic()
    for scene in SCENES:
        made = page.evaluate(DRAW, [scene.name, [320, 180], 4])
        files = [base64.b64decode(made[kind]) for kind in ("png", "exr")]
        got[scene.stem] = (*files, explained(scene, made["told"]))
    seconds = time.monotonic() - begun
    turns = page.evaluate(TURN, ["two-balls.toml", [960, 540]])
    context.close()
    return got, seconds, turns


def walk(browser, address, faults):
    """The page of static files: how soon it shows something, by hand, and without a network."""
    firsts = []
    for _ in range(5):
        context, page = open_page(browser, address, faults)
        ASKED.clear()
        wait(page, "document.getElementById('progress').value > 0")
        firsts.append(page.evaluate("performance.now()"))
        assert not any("_rest" in path for path in ASKED), "the rest of the module is loaded for two balls"
        context.close()
    context, page = open_page(browser, address, faults)
    wait(page, "studio.look")
    before = page.evaluate("studio.look.picture")
    text = (ROOT / "scenes/two-balls.toml").read_text()
    assert "[image]\n" in text
    page.fill("#text", text.replace("[image]\n", "[image]\nsize = [320, 180]\n").replace("samples = 16", "samples = 4"))
    wait(page, f"studio.look.picture > {before} && studio.done === studio.look.picture")
    page.evaluate("document.getElementById('canvas').scrollIntoView({ block: 'center' })")
    box = page.locator("#canvas").bounding_box()
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    wait(page, "studio.told")
    before = page.evaluate("studio.look.picture")
    page.focus("#frame")
    page.keyboard.press("ArrowLeft")
    wait(page, f"studio.look.picture > {before} && studio.done === studio.look.picture")
    page.screenshot(path=FOLDER / "1-static.png")
    # Each worker tries a look on and takes it off again; the first has the whole figure to save.
    before = page.evaluate("studio.look.picture")
    page.focus("#look")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("End")
    wait(page, f"studio.tried === 'technical' && studio.look.picture > {before} && studio.done === studio.look.picture")
    page.keyboard.press("Escape")
    wait(page, "studio.tried === null && studio.done === studio.look.picture")
    with page.expect_download() as download:
        page.click("#svg")
    download.value.save_as(FOLDER / "saved.svg")
    assert (FOLDER / "saved.svg").read_bytes().startswith(b"<svg")
    # The service worker has all it needs: the page comes without a network, too.
    page.evaluate("navigator.serviceWorker.ready.then(() => true)")
    context.set_offline(True)
    page.reload()
    wait(page, "document.getElementById('progress').value > 0")
    # Letters are in the rest of the module, which is kept as well.
    before = page.evaluate("studio.look.picture")
    page.fill("#text", text.replace("[image]\n", "[title]\ntext = 'Two balls'\n[image]\nsize = [320, 180]\n"))
    wait(page, f"studio.look.picture > {before} && studio.done === studio.look.picture")
    page.screenshot(path=FOLDER / "2-offline.png")
    context.close()
    return sorted(firsts)[2]


def frames(browser, address, faults):
    """Every worker shows the frame of a trajectory that the slider is at, and the picture is the program's."""
    context, page = open_page(browser, f"{address}?workers=2", faults, service_workers="block")
    wait(page, "studio.look && studio.done === studio.look.picture")
    assert page.text_content("#frame-shown") == "0 (0 to 2)"
    first = page.evaluate("document.getElementById('canvas').toDataURL()")
    before = page.evaluate("studio.look.picture")
    page.focus("#frame-number")
    page.keyboard.press("End")
    wait(page, f"studio.look.picture > {before} && studio.done === studio.look.picture")
    assert page.text_content("#frame-shown") == "2 (0 to 2)"
    assert page.evaluate("document.getElementById('canvas').toDataURL()") != first
    with page.expect_download() as download:
        page.click("#png")
    download.value.save_as(FOLDER / "frame.png")
    subprocess.run([PHONG, "render", FOLDER / "run.toml", "--frames", "2", "-o", FOLDER / "same.png", "--quiet"], check=True)
    assert (FOLDER / "frame.png").read_bytes() == (FOLDER / "same.png").read_bytes(), "not the program's frame"
    before = page.evaluate("studio.look.picture")
    page.focus("#frame-number")
    page.keyboard.press("Home")
    wait(page, f"studio.look.picture > {before} && studio.done === studio.look.picture")
    assert page.evaluate("document.getElementById('canvas').toDataURL()") == first
    context.close()


def too_large(browser, address, faults):
    """A file that is too large for a browser: that is told, and nothing of it is asked for."""
    context, page = open_page(browser, address, faults, service_workers="block")
    wait(page, "studio.look")
    asked = []
    page.on("request", lambda request: asked.append(request.url))

    def enlarged(route):
        told = json.loads(route.fetch().text())
        told["scenes"][told["open"]]["bytes"] = 600_000_000
        route.fulfill(body=json.dumps(told), content_type="application/json")

    page.route("**/files.json", enlarged)
    page.reload()
    wait(page, "document.getElementById('status').textContent.includes('600 MB')")
    assert not any("/scenes/" in url for url in asked), asked
    context.close()


def without_vectors(playwright, address, faults, expected):
    """A browser whose processor has no vectors for WebAssembly gets the module that needs none, and the same bits."""
    browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--js-flags=--no-enable-sse4-1"])
    ASKED.clear()
    context, page = open_page(browser, f"{address}?workers=2", faults, service_workers="block")
    wait(page, "studio.look")
    page.click("#stop")
    modules = {path.rpartition("/")[2] for path in ASKED if ".wasm" in path}
    assert "phong-plain_bg.wasm" in modules and not any("simd" in name for name in modules), modules
    for scene in [scene for scene in SCENES if scene.stem in ("two-balls", "glass")]:
        made = page.evaluate(DRAW, [scene.name, [320, 180], 4])
        files = [base64.b64decode(made[kind]) for kind in ("png", "exr")]
        assert (*files, explained(scene, made["told"])) == expected[scene.stem], f"{scene.stem} differs without vectors"
    browser.close()
    print("Chromium without vectors gets the plain module, and the program's bits")


# Without vector instructions it may be left out: that takes as long again to build.
KINDS = [kind for kind in ("simd", "plain") if kind == "simd" or (PHONG.parent / f"wasm/phong-{kind}_bg.wasm").exists()]


def sizes():
    """Bytes of the modules, as they are and gzipped."""
    for kind, (part, most) in product(KINDS, [("bg", LARGEST), ("rest", LARGEST_REST)]):
        bytes_ = (PHONG.parent / f"wasm/phong-{kind}_{part}.wasm").read_bytes()
        packed = len(gzip.compress(bytes_, 9))
        print(f"phong-{kind}_{part}.wasm: {len(bytes_):,} bytes, {packed:,} gzipped")
        assert packed <= most or kind == "plain", f"more than {most:,}"


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    sizes()
    site = FOLDER / "web/a folder/studio"
    subprocess.run([PHONG, "studio", ROOT / "scenes", "--static", site], check=True)
    subprocess.run([PHONG, "studio", ROOT / "scenes/two-balls.toml", "--static", FOLDER / "web/two/balls"], check=True)
    (FOLDER / "run.xyz").write_text(studio_walks.RUN)
    (FOLDER / "run.toml").write_text(TRAJECTORY)
    subprocess.run([PHONG, "studio", FOLDER / "run.toml", "--static", FOLDER / "web/run"], check=True)
    table, expected = {}, native()
    for kind in KINDS:
        got, seconds = in_node(kind)
        compare(f"Node, {kind}", table, expected, got)
        print(f"Node, {kind}: {len(SCENES)} scenes in {seconds:.1f} s")
    server, root = serve(FOLDER / "web")
    address, faults = f"{root}/a%20folder/studio/", []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        got, seconds, turns = in_chromium(browser, address, faults)
        compare("Chromium, 2 workers", table, expected, got)
        print(f"Chromium, 2 workers: {len(SCENES)} scenes in {seconds:.1f} s")
        print(f"two balls at 960 × 540: {turns:.0f} turns a second, each with its first pass")
        first = walk(browser, f"{root}/two/balls/", faults)
        print(f"from the address to the first picture: median of 5 {first:.0f} ms")
        frames(browser, f"{root}/run/", faults)
        too_large(browser, f"{root}/two/balls/", faults)
        browser.close()
        if "plain" in KINDS:
            without_vectors(playwright, address, faults, expected)
    server.shutdown()
    engines = list(next(iter(table.values())))
    print(f"{'scene':20} " + " ".join(f"{name:24}" for name in engines) + "  (PNG, EXR, explained)")
    for scene, columns in table.items():
        print(f"{scene:20} " + " ".join(f"{' '.join(columns[name]):24}" for name in engines))
    bad = [scene for scene, columns in table.items() if "DIFFERS" in sum(columns.values(), [])]
    assert not bad, f"not the program's bits: {bad}"
    assert not faults, faults
    print(f"the renderer as WebAssembly: {len(table)} scenes in {len(engines)} engines have the program's bits")


main()
