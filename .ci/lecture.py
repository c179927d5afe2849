#!/usr/bin/env python3
"""Reads the lecture in a headless browser: `python3 .ci/lecture.py BOOK FOLDER [CHAPTER...]`.

BOOK is the built book with its engine, FOLDER where the screenshots go. Every live figure is drawn, and
every task done as a reader would: at first the page has to say *not yet*, and then *yes*. Of what a
task looks for, the pixel is searched with the page's own engine.
"""

import sys
import threading
import time
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from playwright.sync_api import sync_playwright

BOOK, SHOTS = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
CHROMIUM = "/usr/bin/chromium"

# The chapters, and for each of their tasks what is set before the pixel is looked for.
TASKS = {
    "vectors": [{}],
    "diffuse": [{"materials.ball.k_a": 0.725}, {}, {}],
    "reflection": [{"wrong": True}, {}],
    "specular": [{}, {"exponent i": 1.204}, {"materials.ball.shininess": 41}, {}, {"materials.ball.k_s": 0.4, "materials.ball.shininess": 200}],
    "halfway": [{}, {"materials.ball.shininess": 41}],
    "sum": [{"materials.ball.k_s": 0.9}],
    "microfacets": [{"facets": 6}],
}

# The pixel of a figure whose explanation comes nearest to what the task asks for, by halving a grid.
SEARCH = """async ([index, path, wanted]) => {
  const root = document.querySelectorAll("div.live")[index];
  const canvas = root.querySelector("canvas");
  const read = (told) => path.split(".").reduce((at, part) => at?.[part], told);
  let [best, away, step] = [[canvas.width / 2, canvas.height / 2], Infinity, 16];
  let [from, to] = [[0, 0], [canvas.width - 1, canvas.height - 1]];
  while (step >= 1) {
    for (let y = from[1]; y <= to[1]; y += step) {
      for (let x = from[0]; x <= to[0]; x += step) {
        const { told } = await lecture.ask({ do: "explain", pixel: [x, y] });
        const value = read(told);
        if (typeof value !== "number" || Math.abs(value - wanted) >= away) continue;
        [best, away] = [[x, y], Math.abs(value - wanted)];
      }
    }
    from = best.map((n) => Math.max(0, n - step));
    to = best.map((n, i) => Math.min([canvas.width, canvas.height][i] - 1, n + step));
    step /= 4;
  }
  return best;
}"""


class Quiet(SimpleHTTPRequestHandler):
    extensions_map = {**SimpleHTTPRequestHandler.extensions_map, ".js": "text/javascript", ".wasm": "application/wasm"}

    def log_message(self, *_):
        pass


def wait(page, expression, seconds=60):
    """Waits until an expression of the page is true."""
    end = time.monotonic() + seconds
    while not page.evaluate(expression):
        assert time.monotonic() < end, f"{page.url}: not within {seconds} s: {expression}"
        page.wait_for_timeout(20)


def verdict(page, index):
    """What the page says of a task."""
    live = page.locator("div.live").nth(index)
    said = live.locator(".live-verdict")
    before = said.text_content()
    live.locator(".live-check button").click()
    wait(page, f"!document.querySelectorAll('div.live')[{index}].querySelector('.live-check button').disabled")
    assert said.text_content() or before, "the page says nothing"
    return said.get_attribute("data-good") == "true", said.text_content()


def task(page, index, sets):
    """Does a task; the page says no before, and yes after."""
    root = f"document.querySelectorAll('div.live')[{index}]"
    live = page.locator("div.live").nth(index)
    live.scroll_into_view_if_needed()
    wait(page, f"{root}.dataset.done")
    good, said = verdict(page, index)
    assert not good, f"{page.url}, task {index + 1} is done from the start: {said}"
    if sets.get("wrong"):
        before = live.get_attribute("data-done")
        live.locator(".live-box input").check()
        wait(page, f"{root}.querySelector('.live-box input').checked && {root}.dataset.done !== '{before}'")
        live.screenshot(path=SHOTS / "wrong-sign.png")
        sets = {}
    for key, value in sets.items():
        slider = live.locator(f'input[aria-label="{key}"]')
        slider.evaluate("(input, value) => { input.value = value; input.dispatchEvent(new Event('input')); }", value)
    page.wait_for_timeout(400)
    kind, *parts = live.get_attribute("data-check").split(" ")
    if kind == "at":
        x, y = page.evaluate(SEARCH, [index, parts[0], float(parts[1])])
        live.locator("canvas").evaluate("(canvas) => canvas.scrollIntoView({ block: 'center' })")
        box = live.locator("canvas").bounding_box()
        width, height = live.locator("canvas").evaluate("(canvas) => [canvas.width, canvas.height]")
        page.mouse.click(box["x"] + (x + 0.5) / width * box["width"], box["y"] + (y + 0.5) / height * box["height"])
        wait(page, f"{root}.dataset.told === '{x} {y}'")
    good, said = verdict(page, index)
    assert good, f"{page.url}, task {index + 1}: {said}"
    return said


def read(browser, root, name, tasks, **more):
    """Reads a chapter; how many tasks were done."""
    faults = []
    context = browser.new_context(**more)
    page = context.new_page()
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("request", lambda request: None if request.url.startswith(("blob:", "data:", root))
            else faults.append(f"asks for {request.url}"))
    page.goto(f"{root}/{name}.html")
    assert page.locator("div.live").count() == len(TASKS[name]), name
    # All are drawn first, so that none takes the engine while a task of another is done.
    for index in range(len(tasks)):
        page.locator("div.live").nth(index).scroll_into_view_if_needed()
        wait(page, f"document.querySelectorAll('div.live')[{index}].dataset.done")
    for index, sets in enumerate(tasks):
        print(f"{name}, task {index + 1}: {task(page, index, sets)}")
    wide = page.evaluate("document.documentElement.scrollWidth")
    assert wide <= page.viewport_size["width"], f"{name} is {wide} pixels wide"
    kind = f"{'phone' if more.get('is_mobile') else 'wide'}-{more.get('color_scheme', 'light')}"
    for index in range(len(TASKS[name])):
        live = page.locator("div.live").nth(index)
        live.scroll_into_view_if_needed()
        wait(page, f"document.querySelectorAll('div.live')[{index}].dataset.done")
        live.screenshot(path=SHOTS / f"{name}-{index + 1}-{kind}.png")
    assert not faults, faults
    context.close()
    return len(tasks)


def main():
    SHOTS.mkdir(parents=True, exist_ok=True)
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=BOOK))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    root = f"http://127.0.0.1:{server.server_port}"
    wide = {"viewport": {"width": 1200, "height": 900}}
    phone = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True, "device_scale_factor": 2}
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        chapters = sys.argv[3:] or TASKS
        count = sum(read(browser, root, name, TASKS[name], **wide) for name in chapters)
        for name in chapters:
            read(browser, root, name, [], **phone)
            read(browser, root, name, [], **wide, color_scheme="dark")
        browser.close()
    server.shutdown()
    print(f"the lecture was read: {count} tasks were done, 0 failed")


main()
