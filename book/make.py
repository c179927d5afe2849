#!/usr/bin/env python3
"""Makes the book, with the program of this very tree, and checks it: `python3 book/make.py`.

A chapter's `console` block is a promise: each `$ command` is run, in a folder of the chapter's own
(where `scenes` is the gallery), and has to succeed and to say what stands below it. There, `…` is
any part of a line and a line of `…` any lines; a command with nothing below it may say anything.
What follows `<!-- file: NAME -->` is first written to that file. Files that the commands make are
under `made/CHAPTER/` for the chapter to show.

`--bless` writes what the commands say into the chapters, except where there is a `…`; a line of `?`
is a place for it. `--built` takes the release build that is there, and the example that the tests
have built, as the gate has made them: to build it anew would take most of the book's time.
The book is then in `book/book`; every picture and link in it has to exist, and every picture to have
a text that says what it shows. Its figures are live if `bash .ci/wasm` was run before: then the
renderer as WebAssembly lies in it, with the scenes of `book/live`, and any web server serves it.
"""

import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

ROOT = Path(__file__).resolve().parent.parent
SOURCE = ROOT / "book/src"
BUILT = ROOT / "book/book"
MADE = SOURCE / "made"
WORK = ROOT / "target/book"
SCENES = ROOT / "scenes"
LIVE = ROOT / "book/live"
MODULES = ROOT / "target/release/wasm"
BLESS = "--bless" in sys.argv[1:]
IS_BUILT = "--built" in sys.argv[1:]

SHELL = {**os.environ, "PATH": f"{ROOT}/target/release{os.pathsep}{os.environ['PATH']}"}

BLOCK = re.compile(r"^```console\n(.*?)^```$", re.M | re.S)
FILE = re.compile(r"^<!-- file: (\S+) -->\n+```\w*\n(.*?)^```$", re.M | re.S)
# A command, with its continued lines or all up to `end`, and what it says.
PROMISE = re.compile(
    r"^\$ (.*<< end\n(?:.*\n)*?end|(?:.*\\\n)*.*)\n((?:(?!\$ ).*\n)*)", re.M
)


def run(command, folder=ROOT):
    """What a command says; it has to succeed."""
    example = ROOT / "target/debug/examples/embed"
    if IS_BUILT and example.is_file():
        command = command.replace("cargo run --quiet --release --package phong --example embed", str(example))
    done = subprocess.run(
        ["bash", "-c", command], cwd=folder, env=SHELL, text=True,
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )
    if done.returncode != 0:
        sys.exit(f"{done.stdout}\nfailed with {done.returncode}: {command}")
    return "".join(line.rstrip() + "\n" for line in done.stdout.splitlines())


def fits(said, promised):
    """Word for word and digit for digit: the same bits are drawn on every machine."""
    if "…" not in promised:
        return said == promised
    lines = (
        r"(?:.*\n)*" if line == "…" else ".*".join(map(re.escape, line.split("…"))) + r"\n"
        for line in promised.splitlines()
    )
    return re.fullmatch("".join(lines), said) is not None


def chapter(path):
    """Keeps the promises of a chapter; tells how many there were."""
    text = path.read_text()
    work = WORK / path.stem
    promises = 0

    def keep(match):
        nonlocal promises
        command, promised = match[1], match[2]
        said = run(command, work)
        promises += 1
        if not promised or fits(said, promised):
            return match[0]
        if BLESS and "…" not in promised:
            return f"$ {command}\n{said}"
        sys.exit(f"{path.name}: $ {command}\n--- it says\n{said}--- the book says\n{promised}---")

    def block(match):
        return f"```console\n{PROMISE.sub(keep, match[1])}```"

    if not BLOCK.search(text):
        return 0
    work.mkdir(parents=True)
    (work / "scenes").symlink_to(SCENES)
    for name, content in FILE.findall(text):
        (work / name).write_text(content)
    kept = BLOCK.sub(block, text)
    if kept != text:
        path.write_text(kept)
    (work / "scenes").unlink()
    shutil.copytree(work, MADE / path.stem)
    return promises


def gallery():
    """The gallery's scenes, with what their first lines say of them."""
    (MADE / "scenes").mkdir(parents=True)
    page = ""
    for scene in sorted(SCENES.glob("*.toml")):
        text = scene.read_text()
        says, name = text.splitlines()[0].removeprefix("# "), scene.stem
        width, height = re.search(r"(?m)^size = \[(\d+), (\d+)\]", text + "\nsize = [960, 540]").groups()
        size = f"{int(width) // 2}x{int(height) // 2}"
        run(f"phong render {scene} --size {size} --quiet -o {MADE}/scenes/{name}.png")
        alt = re.sub(r"[\[\]]", "", says)
        page += f"## {name}\n\n{says}\n\n![{alt}](made/scenes/{name}.png)\n\n"
        page += f"<details><summary><code>scenes/{scene.name}</code></summary>\n\n"
        page += f"```toml\n{text}```\n\n</details>\n\n"
    (MADE / "scenes.md").write_text(page)


def serves(command, folder):
    """A command that serves until Ctrl-C says where, and ends with 130."""
    words = [*shlex.split(command, comments=True), "--no-open"]
    with subprocess.Popen(words, cwd=folder, env=SHELL, stdout=subprocess.PIPE, text=True) as server:
        said = server.stdout.readline()
        server.send_signal(signal.SIGINT)
    if not said.startswith("http://127.0.0.1:") or server.returncode != 130:
        sys.exit(f"{command}\nsays {said}and ends with {server.returncode}")


def readme():
    """What the README asks its reader to type works, and its picture is what comes of it.

    The figures are among what comes of it.
    """
    work = WORK / "readme"
    work.mkdir(parents=True)
    (work / "scenes").symlink_to(SCENES)
    for command in re.findall(r"^phong .*$", (ROOT / "README.md").read_text(), re.M):
        if "--static" in command and not MODULES.is_dir():
            print(f"not run, as `bash .ci/wasm` was not: {command}")
        elif "--static" in command:
            run(command, work)
        elif command.startswith("phong studio"):
            serves(command, work)
        else:
            run(command, work)
    run("phong render scenes/terms.toml --quiet", work)
    run(f"phong compare terms.png {SOURCE}/pictures/terms.png", work)
    shutil.move(work / "figures", MADE / "figures")


class Page(HTMLParser):
    """The names and the links of a page."""

    def __init__(self, path):
        super().__init__()
        self.names, self.links, self.untold = set(), [], []
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        if tag == "img" and len(dict(attributes).get("alt") or "") < 12:
            self.untold.append(dict(attributes).get("src"))
        for key, value in attributes:
            if key in ("id", "name"):
                self.names.add(value)
            elif key in ("href", "src") and value and tag != "base":
                self.links.append((tag, value))


def check_links():
    """Every picture, script and link of the built book is there, and on this machine."""
    pages = {path: Page(path) for path in BUILT.rglob("*.html") if MADE.name not in path.parts}
    broken, count = [], 0
    for path, page in pages.items():
        broken += [f"{path.name}: no text says what {image} shows" for image in page.untold]
        for tag, link in page.links:
            count += 1
            url = urlsplit(link)
            if url.scheme or url.netloc:
                if tag != "a":
                    broken.append(f"{path.name}: {tag} is from elsewhere: {link}")
                continue
            # The page for a wrong address may be shown at any, and counts from the top.
            base = BUILT if link.startswith("/") or path.name == "404.html" else path.parent
            target = (base / unquote(url.path).lstrip("/")).resolve() if url.path else path
            if target.is_dir():
                target /= "index.html"
            if not target.is_file():
                broken.append(f"{path.name}: there is no {link}")
            elif url.fragment and target in pages:
                if unquote(url.fragment) not in pages[target].names:
                    broken.append(f"{path.name}: no such place: {link}")
    if broken:
        sys.exit("\n".join(broken))
    return count, len(pages)


def live():
    """Gives the figures an engine, and the book what keeps it for when there is no network."""
    asked = {
        name + ".toml"
        for path in SOURCE.glob("*.md")
        for name in re.findall(r'data-scene="([^"]*)"', path.read_text())
    }
    there = {path.name for path in LIVE.glob("*.toml")}
    if asked != there:
        sys.exit(f"scenes of live figures that are asked for and there differ: {sorted(asked ^ there)}")
    if not MODULES.is_dir():
        return "still, as `bash .ci/wasm` was not run"
    run(f"phong studio {LIVE} --static {BUILT}/studio")
    shutil.copy(BUILT / "studio/offline.js", BUILT)
    files = [path for path in BUILT.rglob("*") if path.is_file() and path.suffix != ".md"]
    names = [path.relative_to(BUILT).as_posix() for path in files]
    (BUILT / "files.json").write_text(json.dumps({"files": sorted(names)}))
    return "live"


def main():
    for folder in (MADE, WORK, BUILT):
        shutil.rmtree(folder, ignore_errors=True)
    if not IS_BUILT:
        run("cargo build --release -p phong-cli")
    gallery()
    readme()
    promises = sum(chapter(path) for path in sorted(SOURCE.glob("*.md")))
    said = run("mdbook build book")
    if "WARN" in said or "ERROR" in said:
        sys.exit(said)
    links, pages = check_links()
    print(f"{promises} commands say what the book says; {links} links on {pages} pages are whole")
    print(f"the figures are {live()}")


if __name__ == "__main__":
    main()
