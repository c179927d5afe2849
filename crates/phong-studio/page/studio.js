// The studio's page: brings together the engine, the picture and what is asked of it. It computes nothing.

import { connect } from "./engine.js";
import { compare } from "./compare.js";
import { Controls } from "./controls.js";
import { Curtain } from "./curtain.js";
import { Editor } from "./editor.js";
import { OpenFile } from "./file.js";
import { check } from "./elements.js";
import { show } from "./explained.js";
import { Handles } from "./handles.js";
import { Hands } from "./hands.js";
import { History } from "./history.js";
import { plot } from "./lobe.js";
import { Looks } from "./looks.js";
import { Picture } from "./picture.js";
import { Saving } from "./saving.js";
import { drops, Teaching } from "./teaching.js";
import { WhatIf } from "./whatif.js";
import { fill, words } from "./words.js";

const PROTOCOL = 4;
const at = (id) => document.getElementById(id);

fill(document);
at("status").textContent = words.connecting;
at("why").textContent = words.nothing;

// What is known of the engine.
const state = { look: null, stopped: false, asked: 0, answered: 0, wanted: null, told: null, toldOf: 0, pinned: null, other: null };
globalThis.studio = state; // for who looks from outside, as tests do

const engine = connect({ hear, take, gone: () => say(words.lost) });
const send = (request) => engine.send(request);
const saving = new Saving(send, () => say(words.copied));
const hands = new Hands(send);
const picture = new Picture(at("frame"), hands, {
  point: (pixel) => at("follow").checked && !state.pinned && explain(pixel),
  pin: (pixel, another) => {
    if (another && state.pinned) keepOther();
    state.pinned = pixel;
    explain(pixel);
  },
});
const handles = new Handles(at("frame"), at("canvas"), {
  drag: (drag) => hands.drag(drag),
  drop: (drag) => {
    hands.forget("drag");
    editor.flush();
    send({ do: "drag", ...drag });
  },
});
const controls = new Controls(at("sliders"), { set: (set) => hands.look(set), keep: write });
const editor = new Editor(at("text"), at("diagnostics"), at("offers"), (text) => send({ do: "edit", text }));
const file = new OpenFile({
  send: (request) => {
    if (request.do !== "check-file") editor.flush();
    send(request);
  },
  text: () => (state.bare ? null : editor.text),
  said: say,
  download: () => saving.download("toml"),
});
at("text").addEventListener("input", () => file.show());
const looks = new Looks(at("look"), at("looks"), {
  tryOn: (look) => {
    editor.flush();
    hands.tryOn(look);
  },
  // Of a text there is no look to take off: undo does that.
  putOn: (name) => (name || state.bare) && putOn(name),
});
const curtain = new Curtain(at("frame"), at("curtain"));
const whatIf = new WhatIf(at("supposed"), (set) => {
  if (state.told) send({ do: "explain", id: SUPPOSED, pixel: state.told.pixel, set });
});
const teaching = new Teaching(at("teaching"), {
  send,
  begin: ({ scene, mistake }) => {
    send({ do: "open", path: scene });
    if (mistake !== null) teaching.plant(mistake);
  },
});
drops(teaching);
const history = new History({
  restore: ({ text, set, dressed }) => {
    if (text === null) {
      if (dressed !== state.look.dressed) send({ do: "put-on", look: dressed });
      const gone = Object.keys(state.look.set).map((path) => [path, null]);
      send({ do: "look", set: { ...Object.fromEntries(gone), ...set } });
    } else {
      editor.show(text);
      send({ do: "edit", text, set });
    }
  },
  changed: ({ canUndo, canRedo }) => {
    at("undo").disabled = !canUndo;
    at("redo").disabled = !canRedo;
  },
});

// The numbers of answers that are not about the pixel under the pointer.
const OTHER = 1e9;
const SUPPOSED = 2e9;

function say(text) {
  at("status").textContent = text;
}

// Writes values into the text; a bare model has none, and they are laid over it.
function write(set) {
  hands.forget("look");
  editor.flush();
  send(state.bare ? { do: "look", set } : { do: "write", set });
}

// Puts a look on; what was typed is sent before.
function putOn(name) {
  hands.forget("look");
  hands.forget("try-on");
  editor.flush();
  send({ do: "put-on", look: name || null });
}

// One question at a time; of those that come meanwhile the newest is asked next.
function explain(pixel) {
  state.wanted = pixel;
  if (state.asked === state.answered) ask();
}

// Explains anew in another picture: the pixel that is kept, or the one under the pointer, or the one that is told of.
// While a hand turns the picture, no ring is drawn and nothing asked: to write numbers takes longer than a first pass.
function explainAgain([width, height]) {
  if (picture.held && !state.pinned) {
    picture.clear();
    return picture.mark(state.other);
  }
  const pixel = state.pinned ?? (at("follow").checked ? picture.under : null) ?? state.told?.pixel;
  if (!pixel) return;
  if (pixel[0] < width && pixel[1] < height) explain(pixel);
  else forget();
}

// Nothing is explained any more.
function forget() {
  state.told = null;
  picture.clear();
  picture.mark(state.other);
  at("why").textContent = words.nothing;
}

function ask() {
  const pixel = state.wanted;
  state.wanted = null;
  if (!pixel) return;
  state.asked += 1;
  send({ do: "explain", id: state.asked, pixel });
}

function askLobe() {
  if (at("lobe").open && state.told?.samples[0].hit) {
    send({ do: "lobe", id: state.asked, pixel: state.told.pixel, light: Number(at("lobe-light").value) });
  }
}

// Keeps the pixel that is explained, to be compared with the next.
function keepOther() {
  state.other = state.other ? null : state.told?.pixel ?? null;
  at("pin").textContent = state.other ? words.unpin : words.pin;
  at("pin").setAttribute("aria-pressed", String(state.other !== null));
  at("compared").replaceChildren();
  picture.mark(state.other);
  if (state.other) send({ do: "explain", id: OTHER, pixel: state.other });
}

// The table of keys is asked for when the first scene is read, so that no picture waits for it.
function askKeys() {
  if (!state.hasKeys) send({ do: "keys" });
  state.hasKeys = true;
}

function note() {
  const text = state.bare ? null : editor.text;
  const { set = {}, dressed = null } = state.look ?? {};
  history.note({ text, set, dressed }, picture.held || handles.held !== null);
  file.show();
}

function terms({ terms: all, off }) {
  const boxes = all.map((name) =>
    check(name, !off.includes(name), (on) => {
      const left = state.look.off.filter((one) => one !== name);
      send({ do: "terms", off: on ? left : [...left, name] });
    }),
  );
  const [legend] = at("terms").children;
  const focused = [...at("terms").querySelectorAll("input")].indexOf(document.activeElement);
  at("terms").replaceChildren(legend, ...boxes);
  if (focused >= 0) at("terms").querySelectorAll("input")[focused]?.focus();
}

// Which frame of a trajectory is shown; the slider is where a hand left it.
function frames({ frame, frames: count }) {
  const slider = at("frame-number");
  at("frames").hidden = count < 2;
  slider.max = count - 1;
  if (document.activeElement !== slider || state.fresh) slider.value = frame;
  at("frame-shown").textContent = words.frameOf(frame, count);
}

const hearing = {
  hello({ protocol, open, files, look, looks: all, saves }) {
    if (protocol !== PROTOCOL) return say(words.old);
    const names = files.includes(open) ? files : [open, ...files];
    at("file").replaceChildren(...names.map((name) => new Option(name, name, name === open, name === open)));
    looks.names(all);
    file.begin(saves);
    state.lookFirst = look;
    send({ do: "open", path: open });
  },
  scene({ path, text }) {
    at("file").value = path;
    state.bare = text === null;
    state.fresh = true;
    state.path = path;
    editor.show(text);
    file.start(path, text);
    if (state.lookFirst) putOn(state.lookFirst);
    state.lookFirst = null;
    state.pinned = null;
    if (state.other) keepOther();
    if (curtain.engine) keepA();
    forget();
  },
  text({ text, note: left, from_file: fromFile }) {
    editor.show(text);
    state.left = left;
    if (fromFile) file.taken(text);
    say(fromFile ? words.taken : words.written);
  },
  saved() {
    file.saved();
  },
  "file-changed"(changed) {
    file.changed(changed);
  },
  checked({ ok, diagnostics }) {
    askKeys();
    // What was left to say of the text stands below it, until it changes again.
    const left = state.left ? [{ severity: "note", message: state.left }] : [];
    state.left = null;
    editor.say([...diagnostics, ...left]);
    at("frame").classList.toggle("stale", !ok);
    if (ok) return;
    say(words.broken);
    hands.seen();
    if (!state.fresh) note();
  },
  look(look) {
    const { picture: number, size, samples, tried } = look;
    // Of a look that is tried on nothing but the picture is shown.
    state.look = tried ? { ...state.look, picture: number, samples } : look;
    state.tried = tried;
    state.stopped = false;
    at("stop").textContent = words.stop;
    picture.begin(number, size);
    teaching.end();
    if (tried) return;
    looks.now(look.dressed);
    frames(look);
    controls.update(look);
    handles.show(at("show-handles").checked ? look.handles : []);
    terms(look);
    curtain.follow(look);
    at("command").textContent = look.command ?? "";
    at("write").disabled = state.bare || Object.keys(look.set).length === 0;
    at("reset").disabled = Object.keys(look.set).length === 0;
    at("x").max = look.size[0] - 1;
    at("y").max = look.size[1] - 1;
    if (state.fresh) history.start({ text: state.bare ? null : editor.text, set: look.set, dressed: look.dressed });
    else note();
    state.fresh = false;
    explainAgain(look.size);
    if (state.other) send({ do: "explain", id: OTHER, pixel: state.other });
  },
  pass({ picture: number, pass, passes, samples }) {
    if (number !== state.look?.picture) return;
    if (pass === 0) {
      state.seen = number;
      // Where there is one pass alone, its tiles are of full size.
      if (passes > 1) picture.first();
      hands.seen();
    }
    at("progress").value = (pass + 1) / passes;
    const all = state.look.samples;
    if (state.tried) say(words.trying(state.tried));
    else say(pass + 1 === passes ? words.done(all) : words.drawing(samples, all));
    state.done = pass + 1 === passes ? number : state.done;
  },
  explanation({ id, picture: number, told, drawn, lines }) {
    if (id === SUPPOSED) return whatIf.answer(told);
    if (id === OTHER) {
      state.compared = told;
    } else {
      state.answered = Math.max(state.answered, id);
      state.told = told;
      state.toldOf = number;
      show(at("why"), told, drawn);
      picture.lines(lines, told.pixel);
      [at("x").value, at("y").value] = told.pixel;
      whatIf.show(told, state.look.values);
      askLobe();
      ask();
    }
    if (state.other && state.compared && state.told) compare(at("compared"), state.compared, state.told);
  },
  mistake(mistake) {
    teaching.choose(mistake);
  },
  verdict(verdict) {
    teaching.judged(verdict);
  },
  graded(graded) {
    teaching.marked(graded);
  },
  sheet(sheet) {
    teaching.sheet(sheet);
    const [first] = sheet.exercises;
    if (first) send({ do: "open", path: first.scene });
  },
  lobe(lobe) {
    plot(at("plot"), lobe);
  },
  file({ name }) {
    saving.named(name);
  },
  keys({ schema }) {
    controls.keys(schema);
    editor.keys(schema);
    whatIf.keys(schema);
  },
  error({ message }) {
    askKeys();
    state.answered = state.asked;
    saving.refused();
    teaching.refused();
    if (state.tried) hands.tryOn(null);
    state.tried = null;
    hands.seen();
    say(message);
  },
};

function hear(reply) {
  hearing[reply.is]?.(reply);
}

function take(frame) {
  if (frame.kind === "file") return saving.take(frame.bytes);
  picture.tile(frame);
}

// Keeps what is shown as A, or leaves A.
function keepA() {
  const on = curtain.engine === null;
  if (on) curtain.keep({ path: state.path, text: state.bare ? null : editor.text, ...state.look });
  else curtain.leave();
  at("keep-a").textContent = on ? words.leaveA : words.keepA;
}

at("file").onchange = ({ target }) => {
  if (file.mayLeave()) send({ do: "open", path: target.value });
  else target.value = state.path;
};
at("undo").onclick = () => history.undo();
at("redo").onclick = () => history.redo();
at("reset").onclick = () => send({ do: "reset" });
at("write").onclick = () => write(state.look.set);
at("keep-a").onclick = keepA;
at("show-handles").onchange = () => handles.show(at("show-handles").checked ? state.look.handles : []);
at("lobe").ontoggle = askLobe;
at("lobe-light").onchange = askLobe;
at("pin").onclick = keepOther;
at("frame-number").oninput = ({ target }) => hands.frame(Number(target.value));
for (const format of ["png", "exr", "svg", "toml", "html"]) {
  at(format).onclick = () => saving.download(format);
}
at("copy").onclick = () => saving.clip(at("command").textContent);
at("python").onclick = () => saving.copy("python");
at("stop").onclick = () => {
  state.stopped = !state.stopped;
  at("stop").textContent = state.stopped ? words.resume : words.stop;
  if (state.stopped) say(words.stopped);
  send({ do: state.stopped ? "cancel" : "resume" });
};
at("pixel").onsubmit = (event) => {
  event.preventDefault();
  state.pinned = [Number(at("x").value), Number(at("y").value)];
  explain(state.pinned);
};
at("follow").onchange = () => (state.pinned = null);
addEventListener("pointerup", () => {
  history.settle();
  if (state.look && !state.pinned) explainAgain(state.look.size);
});
addEventListener("keydown", (event) => {
  const command = (event.ctrlKey || event.metaKey) && !event.altKey;
  const key = command ? event.key.toLowerCase() : "";
  if (key === "z") event.shiftKey ? history.redo() : history.undo();
  else if (key === "y") history.redo();
  else if (key === "s") file.save();
  else return;
  event.preventDefault();
});
