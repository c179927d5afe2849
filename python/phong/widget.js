// The view of a scene in a notebook: shows the pictures that the kernel sends, and tells it what is
// turned, moved and asked. All that is computed is computed in the kernel.

const TURN = 0.01; // radians a pixel of dragging
const KEY_TURN = 0.1; // radians a key
const CLICK = 4; // pixels that a click may move

function element(name, properties = {}, children = []) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key === "text") made.textContent = value;
    else if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

// Gathers what is moved until the next frame of the screen, so that messages are few.
function gather(send) {
  let moved = { turn: [0, 0], pan: [0, 0], zoom: 0 };
  let asked = false;
  const empty = () => ({ turn: [0, 0], pan: [0, 0], zoom: 0 });
  return (change) => {
    for (const key of ["turn", "pan"]) {
      if (change[key]) moved[key] = moved[key].map((old, i) => old + change[key][i]);
    }
    moved.zoom += change.zoom ?? 0;
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      send({ kind: "move", ...moved });
      moved = empty();
    });
  };
}

// One slider with its name and its value.
function slider(control, changed) {
  const shown = element("output", { class: "phong-value", text: format(control.value) });
  const input = element("input", {
    type: "range",
    min: control.least,
    max: control.most,
    step: "any",
    value: control.value,
    "aria-label": `${control.group}, ${control.label}`,
    oninput: (event) => {
      const value = Number(event.target.value);
      shown.textContent = format(value);
      changed(control.id, value);
    },
  });
  return element("label", { class: "phong-slider" }, [
    element("span", { text: control.label }),
    input,
    shown,
  ]);
}

function format(value) {
  return Number(value).toPrecision(3);
}

// All sliders, those of a group under its name.
function panel(controls, changed) {
  const groups = new Map();
  for (const control of controls) {
    if (!groups.has(control.group)) groups.set(control.group, []);
    groups.get(control.group).push(slider(control, changed));
  }
  const folds = [...groups].map(([name, sliders], index) => {
    const fold = element("details", {}, [element("summary", { text: name }), ...sliders]);
    fold.open = index === 0;
    return fold;
  });
  return element("div", { class: "phong-panel" }, folds);
}

function render({ model, el }) {
  const [width, height] = model.get("size");
  const send = (message) => model.send(message);
  const move = gather(send);

  const canvas = element("canvas", {
    width,
    height,
    tabindex: "0",
    role: "img",
    "aria-label": model.get("label"),
    title: "Drag to turn, shift-drag to move, wheel to go nearer; click a pixel to explain it. "
      + "Keys: arrows, shift with arrows, + and -, Home.",
  });
  const mark = element("div", { class: "phong-mark", hidden: "" });
  const state = element("span", { class: "phong-state", role: "status" });
  const text = element("pre", { class: "phong-explanation", tabindex: "0", "aria-live": "polite" });
  text.textContent = "Click a pixel, and its explanation stands here.";
  const pixel = (name, most) =>
    element("input", { type: "number", min: 0, max: most - 1, value: most >> 1, "aria-label": `pixel ${name}` });
  const [x, y] = [pixel("x", width), pixel("y", height)];
  const explain = () => {
    const at = [Number(x.value), Number(y.value)];
    mark.hidden = false;
    mark.style.left = `${((at[0] + 0.5) / width) * 100}%`;
    mark.style.top = `${((at[1] + 0.5) / height) * 100}%`;
    send({ kind: "explain", x: at[0], y: at[1] });
  };
  const form = element("form", {
    class: "phong-form",
    onsubmit: (event) => {
      event.preventDefault();
      explain();
    },
  }, [
    element("label", {}, ["x ", x]),
    element("label", {}, ["y ", y]),
    element("button", { type: "submit", text: "Explain this pixel" }),
    element("button", { type: "button", text: "Look from the start", onclick: () => send({ kind: "home" }) }),
    state,
  ]);

  // The mouse and fingers: one turns, two (or with shift) move and pinch.
  const fingers = new Map();
  let travelled = 0;
  let spread = 0;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    if (fingers.size === 1) travelled = 0;
    spread = 0;
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const [dx, dy] = [event.clientX - before[0], event.clientY - before[1]];
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    travelled += Math.abs(dx) + Math.abs(dy);
    if (travelled <= CLICK) return;
    const shown = canvas.getBoundingClientRect();
    const part = [dx / shown.height / fingers.size, dy / shown.height / fingers.size];
    if (fingers.size === 2) {
      const [a, b] = [...fingers.values()];
      const now = Math.hypot(a[0] - b[0], a[1] - b[1]);
      move({ pan: part, zoom: spread > 0 ? Math.log(spread / now) : 0 });
      spread = now;
    } else if (event.shiftKey || event.buttons & 6) {
      move({ pan: part });
    } else {
      move({ turn: [dx * TURN, dy * TURN] });
    }
  });
  const lift = (event) => {
    const was = fingers.delete(event.pointerId);
    spread = 0;
    if (!was || event.type !== "pointerup" || fingers.size > 0 || travelled > CLICK) return;
    const shown = canvas.getBoundingClientRect();
    const inside = (value, most) => Math.min(Math.max(Math.floor(value), 0), most - 1);
    x.value = inside(((event.clientX - shown.left) / shown.width) * width, width);
    y.value = inside(((event.clientY - shown.top) / shown.height) * height, height);
    explain();
  };
  canvas.addEventListener("pointerup", lift);
  canvas.addEventListener("pointercancel", lift);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    // Only who has chosen the picture means it, not the page.
    if (document.activeElement !== canvas && canvas.getRootNode().activeElement !== canvas) return;
    event.preventDefault();
    move({ zoom: Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 100) * 0.002 });
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const arrow = arrows[event.key];
    if (arrow && event.shiftKey) move({ pan: arrow.map((v) => v * 0.05) });
    else if (arrow) move({ turn: arrow.map((v) => v * KEY_TURN) });
    else if (event.key === "+" || event.key === "=") move({ zoom: -0.1 });
    else if (event.key === "-") move({ zoom: 0.1 });
    else if (event.key === "Home") send({ kind: "home" });
    else if (event.key === "Enter") explain();
    else return;
    // The notebook has other uses for these keys.
    event.preventDefault();
    event.stopPropagation();
  });

  // Pictures come in order, but are unpacked at their own pace: an older one is never put on a newer.
  let latest = 0;
  const show = async (message, buffers) => {
    const picture = await createImageBitmap(new Blob([buffers[0]], { type: "image/png" }));
    if (message.number < latest) return;
    latest = message.number;
    const context = canvas.getContext("2d");
    context.imageSmoothingEnabled = false;
    context.clearRect(0, 0, width, height);
    context.drawImage(picture, 0, 0, width, height);
    canvas.dataset.number = message.number;
    canvas.dataset.done = message.done;
    state.textContent = message.done
      ? `${width} × ${height}, ${message.samples} samples a pixel`
      : `${message.size[0]} × ${message.size[1]}…`;
  };
  const receive = (message, buffers) => {
    if (message.kind === "picture") show(message, buffers);
    else if (message.kind === "explanation") {
      text.textContent = message.text;
      text.dataset.pixel = `${message.x},${message.y}`;
    } else if (message.kind === "error") state.textContent = message.text;
  };
  model.on("msg:custom", receive);

  const sliders = element("div");
  const lay = () => sliders.replaceChildren(
    panel(model.get("controls"), (id, value) => send({ kind: "set", id, value })),
  );
  model.on("change:controls", lay);
  lay();

  el.classList.add("phong");
  el.append(
    element("div", { class: "phong-top" }, [
      element("div", { class: "phong-picture" }, [canvas, mark]),
      sliders,
    ]),
    form,
    text,
  );
  send({ kind: "hello" });
  return () => {
    model.off("msg:custom", receive);
    model.off("change:controls", lay);
  };
}

export default { render };
