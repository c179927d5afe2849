// The studio's page: it shows what an engine says, and says what is asked of it. It computes nothing.

import { connect } from "./engine.js";
import { Controls } from "./controls.js";
import { Editor } from "./editor.js";
import { Picture } from "./picture.js";
import { show } from "./explained.js";
import { fill, words } from "./words.js";

const PROTOCOL = 1;
const at = (id) => document.getElementById(id);

fill(document);
at("status").textContent = words.connecting;
at("why").textContent = words.nothing;

// What is known of the engine.
const state = { look: null, stopped: false, asked: 0, answered: 0, wanted: null, pinned: null, file: null };
globalThis.studio = state; // for who looks from outside, as tests do

const engine = connect({ hear, take, gone: () => say(words.lost) });
const send = (request) => engine.send(request);

const picture = new Picture(at("frame"), {
  turn: (by) => send({ do: "turn", by }),
  move: (by) => send({ do: "move", by }),
  zoom: (by) => send({ do: "zoom", by }),
  point: (pixel) => at("follow").checked && !state.pinned && explain(pixel),
  pin: (pixel) => {
    state.pinned = pixel;
    explain(pixel);
  },
});
const controls = new Controls(at("sliders"), (set) => send({ do: "look", set }));
const editor = new Editor(at("text"), at("diagnostics"), (text) => send({ do: "edit", text }));

function say(text) {
  at("status").textContent = text;
}

// One question at a time; of those that come meanwhile the newest is asked next.
function explain(pixel) {
  state.wanted = pixel;
  if (state.asked === state.answered) ask();
}

function ask() {
  const pixel = state.wanted;
  state.wanted = null;
  if (!pixel) return;
  state.asked += 1;
  send({ do: "explain", id: state.asked, pixel });
}

const hearing = {
  hello({ protocol, open, files }) {
    if (protocol !== PROTOCOL) return say(words.old);
    const names = files.includes(open) ? files : [open, ...files];
    at("file").replaceChildren(...names.map((name) => new Option(name, name, name === open, name === open)));
    send({ do: "keys" });
    send({ do: "open", path: open });
  },
  scene({ path, text }) {
    at("file").value = path;
    editor.show(text);
    state.pinned = null;
    picture.clear();
  },
  checked({ ok, diagnostics }) {
    editor.say(diagnostics);
    at("frame").classList.toggle("stale", !ok);
    if (!ok) say(words.broken);
  },
  look(look) {
    state.look = look;
    state.stopped = false;
    at("stop").textContent = words.stop;
    picture.begin(look.picture, look.size);
    controls.update(look);
    at("command").textContent = look.command ?? "";
    at("x").max = look.size[0] - 1;
    at("y").max = look.size[1] - 1;
    if (state.pinned) explain(state.pinned);
  },
  pass({ picture: number, pass, passes, samples }) {
    if (number !== state.look?.picture) return;
    if (pass === 0) picture.first();
    at("progress").value = (pass + 1) / passes;
    const all = state.look.samples;
    say(pass + 1 === passes ? words.done(all) : words.drawing(samples, all));
    state.done = pass + 1 === passes ? number : state.done;
  },
  explanation({ id, told, lines }) {
    state.answered = Math.max(state.answered, id);
    state.told = told;
    show(at("why"), told);
    picture.lines(lines, told.pixel);
    [at("x").value, at("y").value] = told.pixel;
    ask();
  },
  file({ name }) {
    state.file = name;
  },
  keys({ schema }) {
    controls.keys(schema);
  },
  error({ message }) {
    state.answered = state.asked;
    say(message);
  },
};

function hear(reply) {
  hearing[reply.is]?.(reply);
}

function take(frame) {
  if (frame.kind === "file") return save(state.file, frame.bytes);
  picture.tile(frame);
}

function save(name, bytes) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

at("file").onchange = ({ target }) => send({ do: "open", path: target.value });
at("reset").onclick = () => send({ do: "reset" });
for (const format of ["png", "exr", "toml"]) {
  at(format).onclick = () => send({ do: "export", format });
}
at("stop").onclick = () => {
  state.stopped = !state.stopped;
  at("stop").textContent = state.stopped ? words.resume : words.stop;
  if (state.stopped) say(words.stopped);
  send({ do: state.stopped ? "cancel" : "resume" });
};
at("copy").onclick = async () => {
  await navigator.clipboard.writeText(at("command").textContent);
  say(words.copied);
};
at("pixel").onsubmit = (event) => {
  event.preventDefault();
  state.pinned = [Number(at("x").value), Number(at("y").value)];
  explain(state.pinned);
};
at("follow").onchange = () => (state.pinned = null);
