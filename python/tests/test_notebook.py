"""The widget in a real JupyterLab and in marimo, in a real browser without a display."""

from __future__ import annotations

import hashlib
import json
import os
import re
import secrets
import shutil
import socket
import subprocess
import sys
import textwrap
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import phong

if TYPE_CHECKING:
    from playwright.sync_api import Page

# What servers and browsers warn of is not ours.
pytestmark = pytest.mark.filterwarnings("default")

SETUP = """\
import phong
scene = phong.Scene(
    camera=phong.Camera(eye=(0, 2, 8), look_at=(0, 1, 0)),
    lights=[
        phong.Light(kind="point", position=(3, 4, 5)),
        phong.Light(kind="distant", direction=(1, -2, -1), color=0.3),
    ],
)
scene.add_spheres([(-1.2, 1, 0), (1.2, 1, 0)], radii=1.0, colors=["#c8402f", "#2f60c8"])
floor = scene.add(phong.Plane(point=(0, 0, 0), normal=(0, 1, 0)))
"""
SIZE = (480, 270)
SHOW = f"phong.widget(scene, size={SIZE}, samples=4)"


def missing(what: str) -> None:
    """Skips aloud; where the gate runs, all that is needed is there, so that it is an error."""
    if os.environ.get("CI") == "true":
        pytest.fail(f"{what} is missing")
    pytest.skip(f"{what} is missing: the notebook was NOT tested")


def free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        port: int = one.getsockname()[1]
        return port


def answers(url: str, process: subprocess.Popen[bytes], log: Path) -> None:
    """Waits until a server answers."""
    until = time.monotonic() + 300
    while time.monotonic() < until:
        if process.poll() is not None:
            pytest.fail(f"the server ended:\n{log.read_text()}")
        try:
            with urllib.request.urlopen(url, timeout=2):
                return
        except (urllib.error.URLError, OSError):
            time.sleep(0.1)
    pytest.fail(f"the server does not answer:\n{log.read_text()}")


@pytest.fixture(scope="module")
def browser_page() -> Iterator[Page]:
    if find_spec("playwright") is None:
        missing("the package playwright")
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        missing("the program chromium")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium, args=["--no-sandbox", "--disable-dev-shm-usage"]
        )
        page = browser.new_page(viewport={"width": 1280, "height": 1100})
        page.set_default_timeout(300_000)
        yield page
        browser.close()


@pytest.fixture
def lab(tmp_path: Path) -> Iterator[str]:
    """A JupyterLab with a notebook of two cells; the address of the notebook."""
    if find_spec("jupyterlab") is None or find_spec("anywidget") is None:
        missing("jupyterlab or anywidget")
    cells: list[dict[str, object]] = [
        {
            "cell_type": "code",
            "execution_count": None,
            "id": f"c{i}",
            "metadata": {},
            "outputs": [],
            "source": text,
        }
        for i, text in enumerate([SETUP, SHOW])
    ]
    notebook = {
        "cells": cells,
        "metadata": {
            "kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}
        },
        "nbformat": 4,
        "nbformat_minor": 5,
    }
    folder = tmp_path / "notebooks"
    folder.mkdir()
    (folder / "walk.ipynb").write_text(json.dumps(notebook))
    settings = folder.parent / "settings/@jupyterlab/apputils-extension"
    settings.mkdir(parents=True)
    asks_nothing = {"fetchNews": "false", "checkForUpdates": False}
    (settings / "notification.jupyterlab-settings").write_text(json.dumps(asks_nothing))
    port, token, log = free_port(), secrets.token_hex(8), tmp_path / "jupyter.log"
    environment = {
        **os.environ,
        "JUPYTER_CONFIG_DIR": str(tmp_path / "config"),
        "JUPYTER_DATA_DIR": str(tmp_path / "data"),
        "JUPYTER_RUNTIME_DIR": str(tmp_path / "runtime"),
        "JUPYTERLAB_WORKSPACES_DIR": str(tmp_path / "workspaces"),
        "JUPYTERLAB_SETTINGS_DIR": str(tmp_path / "settings"),
        "IPYTHONDIR": str(tmp_path / "ipython"),
    }
    command = [
        sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root", f"--port={port}",
        "--ip=127.0.0.1", f"--ServerApp.root_dir={folder}", f"--IdentityProvider.token={token}",
        "--LabApp.extension_manager=readonly",
    ]  # fmt: skip
    with log.open("wb") as out:
        process = subprocess.Popen(command, env=environment, stdout=out, stderr=subprocess.STDOUT)
        try:
            answers(f"http://127.0.0.1:{port}/api?token={token}", process, log)
            yield f"http://127.0.0.1:{port}/lab/tree/walk.ipynb?reset&token={token}"
        finally:
            process.terminate()
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def run_all(page: Page, notebook: str) -> None:
    """Opens the notebook and runs all its cells, once its kernel listens."""
    page.goto(notebook)
    page.locator(".jp-Notebook .jp-Cell").first.wait_for()
    page.get_by_text("Python 3 (ipykernel) | Idle").wait_for()
    page.get_by_role("menuitem", name="Run", exact=True).click()
    page.get_by_text("Run All Cells", exact=True).click()


def number_of(page: Page) -> int:
    """Which picture is shown."""
    return int(page.locator(".phong canvas").get_attribute("data-number") or 0)


def finished_after(page: Page, number: int) -> int:
    """Waits until a later picture is shown, and it is the finest."""
    page.wait_for_function(
        """number => {
            const canvas = document.querySelector(".phong canvas");
            if (!canvas || canvas.dataset.done !== "true") return false;
            return Number(canvas.dataset.number) > number;
        }""",
        arg=number,
    )
    return number_of(page)


def digest(values: bytes) -> str:
    """Pixels as they are compared: pytest takes very long to say how two lists differ."""
    return hashlib.sha256(values).hexdigest()


def pixels(page: Page) -> str:
    """The digest of the pixels that are shown."""
    values: list[int] = page.locator(".phong canvas").evaluate(
        "c => Array.from(c.getContext('2d').getImageData(0, 0, c.width, c.height).data)"
    )
    return digest(bytes(values))


def comes_to(page: Page, wanted: str) -> bool:
    """Whether these pixels are shown in the end.

    On a busy machine the picture of an earlier key may come first.
    """
    until = time.monotonic() + 120
    while pixels(page) != wanted and time.monotonic() < until:
        time.sleep(0.1)
    return pixels(page) == wanted


def test_a_notebook_is_turned_lit_and_explained(
    lab: str, browser_page: Page, tmp_path: Path
) -> None:
    page = browser_page
    run_all(page, lab)
    canvas = page.locator(".phong canvas")
    canvas.wait_for()
    first = finished_after(page, 0)

    # Every control has a name, and the picture can be reached by keys.
    unnamed = page.locator(".phong").evaluate(
        """root => Array.from(root.querySelectorAll("input, button, canvas"))
            .filter(e => !(e.ariaLabel || e.textContent.trim() || e.labels?.length))
            .map(e => e.outerHTML)"""
    )
    assert unnamed == []
    assert canvas.get_attribute("tabindex") == "0"

    # What is shown is the picture that the package draws.
    scope: dict[str, phong.Scene] = {}
    exec(SETUP, scope)
    scene = scope["scene"]
    image = phong.render(scene, size=SIZE, samples=4)
    before = pixels(page)
    assert before == digest(image.to_srgb8().tobytes())

    # A click explains the pixel under it, with the numbers of `phong.explain`.
    canvas.scroll_into_view_if_needed()
    canvas.click(position={"x": 170.5, "y": 140.5})
    page.wait_for_selector('.phong-explanation[data-pixel="170,140"]')
    told = page.locator(".phong-explanation").text_content()
    assert told == phong.explain(scene, 170, 140, size=SIZE, samples=4).text
    assert len(re.findall(r"\d\.\d", told or "")) > 10

    # Dragging turns it: other pixels, coarse and then fine.
    box = canvas.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 100, box["y"] + 60)
    page.mouse.down()
    for step in range(1, 11):
        page.mouse.move(box["x"] + 100 + 8 * step, box["y"] + 60 + 2 * step)
    page.mouse.up()
    second = finished_after(page, first)
    turned = pixels(page)
    assert turned != before

    # Keys do as well, and so do sliders; Home looks from the start.
    canvas.focus()
    page.keyboard.press("ArrowLeft")
    finished_after(page, second)
    assert pixels(page) != turned
    canvas.focus()
    page.keyboard.press("Home")
    assert comes_to(page, before)
    fourth = number_of(page)
    slider = page.locator('.phong input[type="range"]').first
    slider.evaluate("s => { s.value = s.min; s.dispatchEvent(new Event('input')); }")
    finished_after(page, fourth)
    assert pixels(page) != before
    page.screenshot(path=os.environ.get("PHONG_SCREENSHOT", str(tmp_path / "lab.png")))


def test_marimo_shows_the_same_widget(browser_page: Page, tmp_path: Path) -> None:
    if find_spec("marimo") is None or find_spec("anywidget") is None:
        missing("marimo or anywidget")
    # The cell is a function, whose last expression is shown.
    body = textwrap.indent(SETUP + SHOW + "\nreturn\n", "    ")
    app = f"import marimo\n\napp = marimo.App()\n\n\n@app.cell\ndef _():\n{body}"
    (tmp_path / "app.py").write_text(app)
    port, log = free_port(), tmp_path / "marimo.log"
    command = [
        sys.executable, "-m", "marimo", "-q", "run", "app.py", "--headless", "--no-token",
        "--host", "127.0.0.1", "--port", str(port),
    ]  # fmt: skip
    environment = {**os.environ, "MARIMO_SKIP_UPDATE_CHECK": "1", "XDG_CACHE_HOME": str(tmp_path)}
    with log.open("wb") as out:
        process = subprocess.Popen(
            command, env=environment, cwd=tmp_path, stdout=out, stderr=subprocess.STDOUT
        )
        try:
            answers(f"http://127.0.0.1:{port}/health", process, log)
            page = browser_page
            page.goto(f"http://127.0.0.1:{port}/")
            page.locator('.phong canvas[data-done="true"]').wait_for()
            scope: dict[str, phong.Scene] = {}
            exec(SETUP, scope)
            scene = scope["scene"]
            image = phong.render(scene, size=SIZE, samples=4)
            assert pixels(page) == digest(image.to_srgb8().tobytes())
            page.locator(".phong canvas").click(position={"x": 170.5, "y": 140.5})
            told = page.locator('.phong-explanation[data-pixel="170,140"]')
            assert told.text_content() == phong.explain(scene, 170, 140, size=SIZE, samples=4).text
        finally:
            process.terminate()
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def test_interrupting_a_kernel_stops_a_picture_in_a_fifth_of_a_second(tmp_path: Path) -> None:
    if find_spec("jupyter_client") is None or find_spec("ipykernel") is None:
        missing("jupyter_client or ipykernel")
    from jupyter_client.manager import start_new_kernel

    manager, client = start_new_kernel(
        cwd=str(tmp_path), env={**os.environ, "IPYTHONDIR": str(tmp_path)}, startup_timeout=300
    )

    def reply(request: str) -> dict[str, Any]:
        """The answer to a cell; others are to what the client asks by itself."""
        while True:
            message: dict[str, Any] = client.get_shell_msg(timeout=300)
            if message["parent_header"].get("msg_id") == request:
                content: dict[str, Any] = message["content"]
                return content

    try:
        small = "phong.render(scene, size=(8, 8), progress=False)"
        assert reply(client.execute(SETUP + small))["status"] == "ok"
        cell = (
            "import time\nprint('begun', flush=True)\n"
            "try:\n    phong.render(scene, size=(1920, 1080), samples=4096, progress=False)\n"
            "except KeyboardInterrupt:\n    raised = time.monotonic()\n    raise"
        )
        # Or the kernel may refuse what it is asked for right after the error.
        request = client.execute(cell, stop_on_error=False)
        while client.get_iopub_msg(timeout=60)["content"].get("text") != "begun\n":
            pass
        time.sleep(0.5)
        interrupted = time.monotonic()
        manager.interrupt_kernel()
        stopped = reply(request)
        took = time.monotonic() - interrupted
        assert (stopped["status"], stopped.get("ename")) == ("error", "KeyboardInterrupt")
        request = client.execute("", user_expressions={"raised": "raised"})
        ours = float(reply(request)["user_expressions"]["raised"]["data"]["text/plain"])
        ours -= interrupted
        load = max(1.0, os.getloadavg()[0])
        print(
            f"from the interrupt to its exception {ours:.3f} s, and to the answer, for which "
            f"IPython makes a traceback, {took:.3f} s, with a load of {load:.1f}"
        )
        # On a busy machine the kernel may itself have to wait.
        assert ours < 0.2 * max(1.0, load / 4), ours
        assert took < 0.2 * load, took
        assert reply(client.execute(small))["status"] == "ok"
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)
