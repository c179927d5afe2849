#!/usr/bin/env python3
"""Walks through the studio's page in a headless browser: `python3 .ci/studio.py PHONG FOLDER`.

PHONG is the program, FOLDER where the screenshots go. The browser is Debian's Chromium. What the
page shows is held against what the program says on the command line.
"""

import json
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from playwright.sync_api import sync_playwright

import studio_speed
import studio_walks

PHONG, SHOTS = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
CHROMIUM = "/usr/bin/chromium"
ROOT = Path(__file__).resolve().parent.parent
SCENE = """# A scene that the walk changes.
version = 1
[image]
size = [320, 180]
samples = 4
background = { top = "#5d86c0", bottom = "#d5e1ee" }
[camera]
eye = [0, 2.2, 8]
look_at = [0, 0.9, 0]
fov = 30
[[light]]
kind = "point"
position = [-4, 6, 5]
[materials.plastic]
color = "#c8402f"
k_s = 0.5
shininess = 60   # a dull plastic
[materials.mirror]
color = 0.3
reflection = 0.5
[[sphere]]
center = [-1.15, 1, 0]
radius = 1
material = "plastic"
[[sphere]]
center = [1.2, 0.8, 0.6]
radius = 0.8
material = "mirror"
[[plane]]
point = [0, 0, 0]
normal = [0, 1, 0]
"""


def explained(scene, x, y, *more):
    """What the program says of a pixel."""
    said = subprocess.run(
        [PHONG, "explain", scene, str(x), str(y), "--samples", "1", "--json", *more],
        check=True, capture_output=True, text=True,
    )
    return json.loads(said.stdout)


def numbers(told):
    """All of an explanation but the places in the text, which name the file as it was opened."""
    if isinstance(told, dict):
        return {key: numbers(value) for key, value in told.items() if key != "at"}
    return [numbers(value) for value in told] if isinstance(told, list) else told


def wait(page, expression, seconds=60):
    """Waits until an expression of the page is true. (The page's policy forbids what Playwright's own
    waiting does: it evaluates text.)"""
    end = time.monotonic() + seconds
    while not page.evaluate(expression):
        assert time.monotonic() < end, f"not within {seconds} s: {expression}"
        page.wait_for_timeout(5)


def done(page):
    """Waits until the newest picture has all its samples."""
    wait(page, "studio.look && studio.done === studio.look.picture")


def newer(page, act):
    """Does what begins another picture, and waits until it is done."""
    before = page.evaluate("studio.look.picture")
    act()
    wait(page, f"studio.look.picture > {before}")
    done(page)


def walk(browser, url, scene):
    faults = []
    context = browser.new_context(viewport={"width": 1400, "height": 900}, accept_downloads=True)
    page = context.new_page()
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("console", lambda line: faults.append(line.text) if line.type == "error" else None)
    page.on("dialog", lambda dialog: dialog.accept())  # another file is opened, unsaved as the text is
    page.goto(url)
    done(page)
    page.screenshot(path=SHOTS / "1-light.png")

    # A pixel's numbers are those of `phong explain --json`.
    box = page.locator("#canvas").bounding_box()
    at = lambda x, y: (box["x"] + (x + 0.5) / 320 * box["width"], box["y"] + (y + 0.5) / 180 * box["height"])
    page.mouse.click(*at(105, 75))
    wait(page, "studio.told?.pixel[0] === 105")
    told = page.evaluate("studio.told")
    assert numbers(told) == numbers(explained(scene, 105, 75)), "the page and the program differ"
    letters = page.locator("#overlay text").all_text_contents()
    assert letters == ["n", "e", "l1", "r1", "h1"], letters
    page.screenshot(path=SHOTS / "2-explained.png")

    # Turned by hand, the picture is that of the command line below it.
    def drag():
        page.mouse.move(*at(160, 90))
        page.mouse.down()
        page.mouse.move(*at(120, 80), steps=8)
        page.mouse.up()

    newer(page, drag)
    page.wait_for_timeout(300)
    done(page)
    assert "camera.eye" in page.evaluate("studio.look.set")
    with page.expect_download() as download:
        page.click("#png")
    download.value.save_as(SHOTS / "turned.png")
    command = page.locator("#command").text_content()
    sets = re.findall(r"--set '([^']*)'", command)
    words = [word for one in sets for word in ("--set", one)]
    subprocess.run([PHONG, "render", scene, *words, "-o", SHOTS / "same.png", "--quiet"], check=True)
    same = (SHOTS / "same.png").read_bytes() == (SHOTS / "turned.png").read_bytes()
    assert same, "the page's file is not the program's"

    # The keyboard alone turns it, and a slider changes a material.
    newer(page, lambda: (page.focus("#frame"), page.keyboard.press("ArrowLeft")))
    newer(page, lambda: page.locator('input[type="number"][aria-label^="materials.plastic.shininess"]').fill("5") or page.keyboard.press("Enter"))
    assert "shininess = 5   # a dull plastic" in page.input_value("#text")
    newer(page, lambda: page.click("#reset"))
    assert page.evaluate("studio.look.set") == {}

    # What is wrong with the text is told; the last picture stays.
    page.fill("#text", SCENE.replace("radius = 1\n", "radus = 1\n"))
    page.wait_for_selector("#diagnostics .error")
    assert "did you mean" in page.locator("#diagnostics").text_content()
    assert "stale" in page.locator("#frame").get_attribute("class")
    page.screenshot(path=SHOTS / "3-error.png")
    newer(page, lambda: page.fill("#text", SCENE.replace("radius = 1\n", "radius = 0.6\n")))
    assert page.locator("#diagnostics li").count() == 0

    # Ten turns in a row: how soon is the first pass of each there?
    waits = []
    for _ in range(10):
        begun = time.monotonic()
        before = page.evaluate("studio.look.picture")
        page.evaluate("document.getElementById('frame').dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft'}))")
        wait(page, f"studio.look.picture > {before} && document.getElementById('progress').value > 0")
        waits.append(1000 * (time.monotonic() - begun))
    print(f"from a key to the first pass, browser and driver included: median {sorted(waits)[5]:.0f} ms")
    other = studio_walks.Walk(page, PHONG, SHOTS, scene, SCENE)
    other.start()
    for step in studio_walks.ALL:
        begun = time.monotonic()
        step(other)
        print(f"walked: {step.__name__}, {time.monotonic() - begun:.1f} s")
    print(f"pictures a second while it is turned, {SCENE.count('[[')} objects and lights: {studio_speed.keys(page):.1f}")
    assert not faults, faults
    context.close()

    dark = browser.new_context(viewport={"width": 1400, "height": 900}, color_scheme="dark")
    page = dark.new_page()
    page.goto(url)
    done(page)
    page.mouse.click(*at(105, 75))
    wait(page, "studio.told")
    page.screenshot(path=SHOTS / "4-dark.png")
    dark.close()

    phone = browser.new_context(viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True, device_scale_factor=2)
    page = phone.new_page()
    page.goto(url)
    done(page)
    page.locator("#canvas").tap()
    wait(page, "studio.told")
    wide = page.evaluate("document.documentElement.scrollWidth")
    assert wide <= 390, f"the page is {wide} pixels wide on a phone"
    page.screenshot(path=SHOTS / "5-phone.png", full_page=True)
    phone.close()


def main():
    SHOTS.mkdir(parents=True, exist_ok=True)
    scene = SHOTS / "walk.toml"
    scene.write_text(SCENE)
    (SHOTS / "run.xyz").write_text(studio_walks.RUN)
    (SHOTS / "run.toml").write_text(SCENE.split("[[sphere]]")[0] + '[[molecule]]\nfile = "run.xyz"\n')
    studio = subprocess.Popen([PHONG, "studio", scene, "--no-open"], stdout=subprocess.PIPE, text=True)
    try:
        url = studio.stdout.readline().strip()
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
            walk(browser, url, scene)
            with tempfile.TemporaryDirectory() as folder:
                studio_speed.tell(browser, PHONG, Path(folder))
            browser.close()
    finally:
        studio.terminate()
        studio.wait()
    print("the studio's page was walked through: 1 passed, 0 failed")


main()
