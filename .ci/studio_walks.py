"""Walks through what can be changed, compared and learnt in the studio's page; `studio.py` begins them."""

import base64
import re
import subprocess


class Walk:
    """A page that is open on the scene of the walk, and what one does with it."""

    def __init__(self, page, phong, shots, scene, text):
        self.page, self.phong, self.shots, self.scene, self.text = page, phong, shots, scene, text

    def wait(self, expression, seconds=60):
        end = self.page.evaluate("performance.now()") + 1000 * seconds
        while not self.page.evaluate(expression):
            assert self.page.evaluate("performance.now()") < end, f"not within {seconds} s: {expression}"
            self.page.wait_for_timeout(5)

    def done(self):
        self.wait("studio.look && studio.done === studio.look.picture")

    def newer(self, act):
        before = self.page.evaluate("studio.look.picture")
        act()
        self.wait(f"studio.look.picture > {before}")
        self.page.wait_for_timeout(50)
        self.done()

    def at(self, x, y):
        box = self.page.locator("#canvas").bounding_box()
        return box["x"] + (x + 0.5) / 320 * box["width"], box["y"] + (y + 0.5) / 180 * box["height"]

    def shot(self, name, **more):
        self.page.screenshot(path=self.shots / f"{name}.png", **more)

    def written(self):
        return self.page.input_value("#text")

    def start(self):
        """The scene as it was, and nothing laid over it."""
        self.newer(lambda: self.page.select_option("#file", "walk.toml"))
        if self.written() != self.text:
            self.newer(lambda: self.page.fill("#text", self.text))
        if self.page.evaluate("Object.keys(studio.look.set).length"):
            self.newer(lambda: self.page.click("#reset"))


def changed_lines(before, after):
    return [line for line in after.splitlines() if line not in before.splitlines()]


def writing(walk):
    """Sliders write into the text, and nothing else of it; undo takes it back, redo does it again."""
    page = walk.page
    number = page.locator('input[type="number"][aria-label^="materials.plastic.shininess"]')
    walk.newer(lambda: number.fill("5") or page.keyboard.press("Enter"))
    assert changed_lines(walk.text, walk.written()) == ["shininess = 5   # a dull plastic"], walk.written()
    slider = page.locator('input[type="range"][aria-label^="materials.plastic.k_s"]')
    page.wait_for_timeout(800)  # longer than what is one step
    walk.newer(lambda: slider.focus() or page.keyboard.press("ArrowRight"))
    assert len(changed_lines(walk.text, walk.written())) == 2, walk.written()
    walk.newer(lambda: page.keyboard.press("Control+z"))
    assert len(changed_lines(walk.text, walk.written())) == 1, walk.written()
    walk.newer(lambda: page.click("#undo"))
    assert walk.written() == walk.text
    assert page.locator("#undo").is_disabled()
    walk.newer(lambda: page.keyboard.press("Control+Shift+z"))
    walk.newer(lambda: page.keyboard.press("Control+y"))
    assert len(changed_lines(walk.text, walk.written())) == 2
    # The view is laid over the text until it is written.
    walk.newer(lambda: page.focus("#frame") or page.keyboard.press("ArrowLeft"))
    assert "camera.eye" in page.evaluate("studio.look.set")
    walk.newer(lambda: page.click("#write"))
    assert page.evaluate("studio.look.set") == {} and "eye = [0, 2.2, 8]" not in walk.written()
    walk.start()


def typing(walk):
    """Keys are offered while one types; a text that cannot be drawn leaves the picture, dimmed."""
    page = walk.page
    place = walk.text.index("[materials.mirror]\n") + len("[materials.mirror]\n")
    page.focus("#text")
    page.evaluate(f"document.getElementById('text').setSelectionRange({place}, {place})")
    page.keyboard.type("shin")
    page.wait_for_selector("#offers li")
    assert page.locator("#offers li b").first.text_content() == "shininess"
    walk.shot("6-completion")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    walk.newer(lambda: page.keyboard.type(" = 9\n"))
    assert "[materials.mirror]\nshininess = 9\n" in walk.written()
    page.keyboard.type("kk = 1\n")
    page.wait_for_selector("#diagnostics .error")
    assert "stale" in page.locator("#frame").get_attribute("class")
    walk.newer(lambda: [page.keyboard.press("Backspace") for _ in range(7)])
    assert "stale" not in (page.locator("#frame").get_attribute("class") or "")
    walk.start()


def handles(walk):
    """A light, a ball and the point looked at are dragged in the picture; it is written when let go of."""
    page = walk.page
    page.click('details[data-path="camera"] summary')
    walk.newer(lambda: page.locator('input[type="number"][aria-label^="camera.fov"]').fill("130") or page.keyboard.press("Enter"))
    before = walk.written()
    # Typing has scrolled down to the text.
    page.locator("#canvas").scroll_into_view_if_needed()
    walk.shot("7-handles")
    for path in ["light.1.position", "sphere.1.center"]:
        page.locator(f'.handle[data-path="{path}"]').scroll_into_view_if_needed()
        box = page.locator(f'.handle[data-path="{path}"]').bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

        def drag():
            page.mouse.move(x, y)
            page.mouse.down()
            page.mouse.move(x + 60, y + 20, steps=6)
            page.mouse.up()

        walk.newer(drag)
        page.wait_for_timeout(400)
        walk.done()
        after = walk.written()
        assert len(changed_lines(before, after)) == 1, changed_lines(before, after)
        box = page.locator(f'.handle[data-path="{path}"]').bounding_box()
        off = abs(box["x"] + box["width"] / 2 - x - 60) + abs(box["y"] + box["height"] / 2 - y - 20)
        assert off < 3, f"{path} is {off} pixels from where it was dragged to"
        before = after
    page.focus('.handle[data-path="sphere.2.center"]')
    walk.newer(lambda: page.keyboard.press("ArrowUp"))
    assert len(changed_lines(before, walk.written())) == 1
    assert page.evaluate("document.activeElement.dataset.path") == "sphere.2.center"
    walk.start()


def pointing(walk):
    """What is told of the pixel under the pointer, and the ring around it, are always of the picture that is shown."""
    page = walk.page
    page.mouse.move(*walk.at(105, 75))
    walk.wait("studio.told?.pixel[0] === 105")
    before = page.text_content("#why")
    walk.newer(lambda: page.focus("#frame") or page.keyboard.press("ArrowLeft"))
    walk.wait("studio.toldOf === studio.look.picture")
    assert page.evaluate("studio.told.pixel") == [105, 75] and page.text_content("#why") != before

    def drag():
        page.mouse.move(*walk.at(200, 50))
        page.mouse.down()
        page.mouse.move(*walk.at(130, 60), steps=6)
        page.mouse.up()

    walk.newer(drag)
    page.wait_for_timeout(400)
    walk.done()
    walk.wait("studio.toldOf === studio.look.picture")
    assert page.evaluate("studio.told.pixel") == [130, 60]
    ring = page.locator("#overlay .pixel").first
    assert [float(ring.get_attribute(key)) for key in ("cx", "cy")] == [130.5, 60.5]
    walk.shot("18-dragged")
    # A slider changes what is told of the same pixel; another scene takes it away, until it is pointed at.
    number = page.locator('input[type="number"][aria-label^="materials.plastic.k_s"]')
    walk.newer(lambda: number.fill("0.1") or page.keyboard.press("Enter"))
    walk.wait("studio.toldOf === studio.look.picture")
    assert page.evaluate("studio.told.pixel") == [130, 60]
    walk.start()


def seeing(walk):
    """Two pixels compared, a lobe plotted, a term left out, another alpha supposed, A beside B."""
    page = walk.page
    page.mouse.click(*walk.at(105, 75))
    walk.wait("studio.told?.pixel[0] === 105")
    page.keyboard.down("Shift")
    page.mouse.click(*walk.at(135, 100))
    page.keyboard.up("Shift")
    page.wait_for_selector(".compared .differs")
    page.click("#lobe summary")
    page.wait_for_selector("#plot .outline")
    page.click("#what-if summary")
    slider = page.locator('#supposed input[aria-label*="shininess"]')
    pictures = page.evaluate("studio.look.picture")
    slider.fill("4")
    page.wait_for_selector("#supposed .swatch")
    supposed = page.evaluate("document.querySelector('#supposed .triple').textContent")
    assert page.evaluate("studio.look.picture") == pictures and walk.written() == walk.text
    walk.shot("8-seeing", full_page=True)
    walk.newer(lambda: page.locator('input[type="number"][aria-label^="materials.plastic.shininess"]').fill("4") or page.keyboard.press("Enter"))
    page.wait_for_timeout(200)
    now = page.evaluate("document.querySelector('#why .result .triple').textContent")
    assert supposed == now, f"what was supposed is {supposed}, and it is {now}"
    page.click("#pin")
    # A is kept; B gets another model, and both are turned.
    page.click("#keep-a")
    page.wait_for_selector(".curtain")
    walk.newer(lambda: page.locator('[data-path="materials.plastic"] select').first.select_option("blinn-phong"))
    walk.newer(lambda: page.focus("#frame") or page.keyboard.press("ArrowRight"))
    page.wait_for_timeout(1500)
    walk.shot("9-curtain")
    page.click("#keep-a")
    assert page.locator(".curtain").count() == 0
    walk.newer(lambda: page.get_by_label("specular", exact=True).uncheck())
    assert page.evaluate("studio.look.off") == ["specular"]
    walk.shot("10-without-specular")
    walk.newer(lambda: page.get_by_label("specular", exact=True).check())
    walk.start()


def files(walk):
    """Every file that is saved, and what is copied."""
    page = walk.page
    for kind, begins in [("exr", b"\x76\x2f\x31\x01"), ("toml", walk.text.encode()[:30]), ("html", b"<!")]:
        with page.expect_download(timeout=120_000) as download:
            page.click(f"#{kind}")
        path = walk.shots / f"saved.{kind}"
        download.value.save_as(path)
        assert path.read_bytes().lstrip().startswith(begins), kind
    assert (walk.shots / "saved.toml").read_text() == walk.text
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.click("#python")
    page.wait_for_timeout(300)
    program = page.evaluate("navigator.clipboard.readText()")
    assert program.startswith("import phong\n") and 'phong.Scene.read("walk.toml")' in program, program


def looks(walk):
    """A look is put on by the keyboard, drawn with its lines as the program draws it, and taken back."""
    page = walk.page
    # It is shown before it is written; Escape leaves all as it was.
    page.focus("#look")
    before = page.evaluate("document.getElementById('canvas').toDataURL()")
    page.keyboard.press("ArrowDown")
    walk.newer(lambda: page.keyboard.press("End"))
    assert page.evaluate("studio.tried") == "technical" and walk.written() == walk.text
    assert "technical" in page.text_content("#status"), page.text_content("#status")
    assert page.evaluate("document.getElementById('canvas').toDataURL()") != before
    walk.shot("14-tried")
    walk.newer(lambda: page.keyboard.press("Escape"))
    assert page.evaluate("document.getElementById('canvas').toDataURL()") == before
    assert page.evaluate("document.activeElement.id") == "look" and page.locator("#undo").is_disabled()
    page.click("#look")
    walk.newer(lambda: page.hover('[data-look="ink"]'))
    tried = page.evaluate("document.getElementById('canvas').toDataURL()")
    walk.newer(lambda: page.click('[data-look="ink"]'))
    assert page.evaluate("document.getElementById('canvas').toDataURL()") == tried and page.locator("#looks").is_hidden()
    written = walk.written()
    assert "[outline]" in written and "shininess = 60   # a dull plastic" not in written, written
    kept = [line for line in walk.text.splitlines() if "center" in line or line.startswith("#")]
    assert all(line in written for line in kept), written
    assert page.locator("#unsaved").is_visible()
    walk.shot("15-ink")
    for kind in ["png", "svg"]:
        with page.expect_download() as download:
            page.click(f"#{kind}")
        download.value.save_as(walk.shots / f"ink.{kind}")
        rendered = walk.shots / f"ink-rendered.{kind}"
        subprocess.run([walk.phong, "render", walk.scene, "--look", "ink", "-o", rendered, "--quiet"], check=True)
        assert (walk.shots / f"ink.{kind}").read_bytes() == rendered.read_bytes(), f"not the program's ink as {kind}"
    walk.newer(lambda: page.keyboard.press("Control+z"))
    assert walk.written() == walk.text
    assert page.locator("#unsaved").is_hidden()
    walk.start()


# Three frames of a molecule that comes apart.
RUN = "".join(f"3\n\nO 0 0 0\nH {1 + frame} 0 0\nH 0 {1 + frame} 0\n" for frame in range(3))


def frames(walk):
    """A trajectory has a slider of its frames, which keys move; the eye stays where it is."""
    page = walk.page
    assert page.locator("#frames").is_hidden()
    walk.newer(lambda: page.select_option("#file", "run.toml"))
    assert page.locator("#frames").is_visible() and page.text_content("#frame-shown") == "0 (0 to 2)"
    camera = page.evaluate("JSON.stringify(studio.look.values.camera)")
    first = page.evaluate("document.getElementById('canvas').toDataURL()")
    walk.newer(lambda: page.focus("#frame-number") or page.keyboard.press("End"))
    assert page.text_content("#frame-shown") == "2 (0 to 2)"
    assert page.evaluate("JSON.stringify(studio.look.values.camera)") == camera
    assert page.text_content("#command") == "phong render run.toml --frames 2"
    assert page.evaluate("document.getElementById('canvas').toDataURL()") != first
    walk.shot("17-frame")
    walk.newer(lambda: page.keyboard.press("Home"))
    assert page.evaluate("document.getElementById('canvas').toDataURL()") == first
    walk.start()
    assert page.locator("#frames").is_hidden()


def saving(walk):
    """The text is saved in its file; what somebody else writes there is told, and taken or written over."""
    page = walk.page
    number = page.locator('input[type="number"][aria-label^="materials.plastic.shininess"]')
    walk.newer(lambda: number.fill("21") or page.keyboard.press("Enter"))
    assert page.locator("#unsaved").is_visible() and page.title().startswith("•")
    page.keyboard.press("Control+s")
    walk.wait("document.getElementById('unsaved').hidden")
    assert walk.scene.read_text() == walk.written() != walk.text
    # Somebody else writes: the page says so by itself, and takes it; that is undone, too.
    theirs = walk.text.replace("shininess = 60", "shininess = 7")
    walk.scene.write_text(theirs)
    page.evaluate("dispatchEvent(new Event('focus'))")  # it looks every few seconds, and when it is come back to
    walk.wait("!document.getElementById('changed').hidden", 20)
    walk.shot("16-changed")
    walk.newer(lambda: page.locator("#changed button").first.click())
    assert walk.written() == theirs and page.locator("#unsaved").is_hidden()
    # Nothing is written over what somebody else has written without asking.
    walk.newer(lambda: number.fill("8") or page.keyboard.press("Enter"))
    walk.scene.write_text(walk.text)
    page.keyboard.press("Control+s")
    walk.wait("!document.getElementById('changed').hidden", 20)
    assert walk.scene.read_text() == walk.text
    page.locator("#changed button").nth(1).click()
    walk.wait("document.getElementById('changed').hidden")
    assert "shininess = 8 " in walk.scene.read_text()
    walk.scene.write_text(walk.text)
    page.evaluate("dispatchEvent(new Event('focus'))")
    walk.wait("!document.getElementById('changed').hidden", 20)
    walk.newer(lambda: page.locator("#changed button").first.click())
    walk.start()


def teaching(walk):
    """A mistake is found, and a picture that is dropped on the page is graded."""
    page = walk.page
    page.click("#exercises summary")
    walk.newer(lambda: page.click("#find"))
    page.wait_for_selector(".choices button")
    walk.shot("11-mistake")
    causes = [one.get_attribute("data-cause") for one in page.locator(".choices button").all()]
    for cause in causes:
        page.click(f'[data-cause="{cause}"]')
        page.wait_for_selector(f'[data-cause="{cause}"][aria-pressed="true"]')
        if page.locator(".verdict.right").count():
            break
    assert page.locator(".verdict.right").count() == 1, causes
    page.click("#show-right")
    walk.done()
    picture = walk.shots / "graded.png"
    subprocess.run([walk.phong, "render", walk.scene, "--set", "materials.plastic.shininess=30", "--samples", "1", "-o", picture, "--quiet"], check=True)
    page.evaluate(
        """bytes => {
            const file = new File([Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0))], "mine.png");
            const data = new DataTransfer();
            data.items.add(file);
            dispatchEvent(new DragEvent("drop", { dataTransfer: data, cancelable: true }));
        }""",
        base64.b64encode(picture.read_bytes()).decode(),
    )
    page.wait_for_selector("#teaching h3", timeout=120_000)
    said = page.locator("#teaching").text_content()
    assert "mine.png: does not pass" in said and "exponent-half" in said, said
    walk.shot("12-graded")
    walk.start()


def manners(walk):
    """Everything has a name, keys alone reach everything, and text is readable in light and dark."""
    page = walk.page
    nameless = page.evaluate(
        """[...document.querySelectorAll("button, input, select, textarea, [role]:not([role='status'])")].filter((one) => {
            const label = one.labels?.[0]?.textContent ?? one.closest("label")?.textContent ?? "";
            return !(one.getAttribute("aria-label") || label.trim() || one.textContent.trim() || one.title);
        }).map((one) => one.outerHTML.slice(0, 120))"""
    )
    assert not nameless, nameless
    # Tab goes through the page, and is caught nowhere.
    page.evaluate("document.activeElement.blur()")
    reached = set()
    for _ in range(400):
        page.keyboard.press("Tab")
        reached.add(page.evaluate("document.activeElement.id || document.activeElement.dataset.path || ''"))
    missed = {"file", "look", "frame", "stop", "png", "text", "x", "follow", "sphere.1.center"} - reached
    assert not missed, f"not reached by Tab: {missed}"
    for scheme in ["light", "dark"]:
        page.emulate_media(color_scheme=scheme)
        faint = page.evaluate(CONTRAST)
        assert not faint, (scheme, faint)
    page.emulate_media(color_scheme="light")
    moving = page.evaluate("document.getAnimations().length")
    assert moving == 0
    # From right to left nothing is cut off.
    page.evaluate("document.documentElement.dir = 'rtl'")
    walk.shot("13-right-to-left")
    wide = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
    assert wide <= 0, f"{wide} pixels too wide from right to left"
    page.evaluate("document.documentElement.dir = 'ltr'")


# The least contrast of text on what is behind it, where it is below 4.5 (AA).
CONTRAST = """(() => {
    const channels = (color) => (color.match(/[\\d.]+/g) ?? []).map(Number);
    const light = (color) => {
        const [r, g, b] = channels(color).slice(0, 3).map((v) => v / 255)
            .map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const behind = (one) => {
        for (let at = one; at; at = at.parentElement) {
            const color = getComputedStyle(at).backgroundColor;
            const [, , , alpha = 1] = channels(color);
            if (color !== "transparent" && alpha > 0.99) return color;
        }
        return "rgb(255, 255, 255)";
    };
    const faint = [];
    for (const one of document.querySelectorAll("body *")) {
        const own = [...one.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
        if (!own || one.closest("svg, [hidden], :disabled, .curtain, .handle") || !one.getClientRects().length) continue;
        const [a, b] = [light(getComputedStyle(one).color), light(behind(one))].sort((x, y) => y - x);
        const ratio = (a + 0.05) / (b + 0.05);
        if (ratio < 4.5) faint.push([ratio.toFixed(2), one.outerHTML.slice(0, 100)]);
    }
    return faint;
})()"""

ALL = [writing, typing, handles, pointing, seeing, files, looks, frames, saving, teaching, manners]
