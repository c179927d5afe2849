// Sliders and colour wells for what can be laid over a scene, made from the table of keys.

import { keysOf } from "./keys.js";
import { words } from "./words.js";

// Where sliders end whose key has no end of its own.
const REACH = { shininess: 200, k_a: 1, k_d: 1, k_s: 2, k_e: 2, fov: 120, samples: 64 };

// Keys that have no slider here: they are set by turning, or in the text.
const LEFT_OUT = new Set(["eye", "look_at", "up", "size", "seed", "name", "attenuation"]);

// Tables that have controls where the scene has them.
const WHERE_THERE = ["ambient_occlusion", "sky", "fog", "outline", "tone", "title", "scale_bar", "axes", "legend"];

export class Controls {
  // `set` is called while a value is moved, `keep` when it is let go of.
  constructor(root, { set, keep }) {
    this.root = root;
    this.set = set;
    this.keep = keep;
    this.shown = "";
    this.refresh = [];
  }

  keys(schema) {
    this.schema = schema;
    this.shown = "";
    if (this.look) this.update(this.look);
  }

  // Shows what holds now; the controls are made anew only where there are others.
  update(look) {
    this.look = look;
    if (!this.schema) return;
    const groups = this.groups();
    const shown = JSON.stringify(groups.map(({ path, keys }) => [path, Object.keys(keys)]));
    if (shown !== this.shown) {
      this.shown = shown;
      this.refresh = [];
      const open = new Set([...this.root.querySelectorAll("details[open]")].map((one) => one.dataset.path));
      this.root.replaceChildren(...groups.map((group) => this.group(group, open)));
    }
    for (const refresh of this.refresh) refresh();
  }

  // The tables of the scene, each with the keys that go with its kind.
  groups() {
    const { values } = this.look;
    const table = (name) => this.schema.properties[name];
    const list = (name, title) =>
      Object.keys(values[name] ?? {}).map((key) => ({
        title: `${title} ${Array.isArray(values[name]) ? Number(key) + 1 : key}`,
        path: `${name}.${Array.isArray(values[name]) ? Number(key) + 1 : key}`,
        values: values[name][key],
        table: table(name).items ?? table(name).additionalProperties,
      }));
    const one = (name, title) => ({ title, path: name, values: values[name] ?? {}, table: table(name) });
    const all = [
      ...list("materials", words.groups.materials),
      ...list("light", words.groups.light),
      one("ambient", words.groups.ambient),
      ...WHERE_THERE.filter((name) => values[name] && table(name)).map((name) => one(name, words.groups[name])),
      one("camera", words.groups.camera),
      one("image", words.groups.image),
    ];
    const left = ([key]) => !LEFT_OUT.has(key);
    const keys = (group) => Object.fromEntries(Object.entries(keysOf(group)).filter(left));
    return all.map((group) => ({ ...group, keys: keys(group) }));
  }

  group({ title, path, keys }, open) {
    const details = document.createElement("details");
    details.dataset.path = path;
    details.open = open.has(path) || (open.size === 0 && path.startsWith("materials."));
    const summary = document.createElement("summary");
    summary.textContent = title;
    details.append(summary);
    for (const [key, schema] of Object.entries(keys)) {
      const control = this.control(`${path}.${key}`, key, schema);
      if (control) details.append(control);
    }
    return details;
  }

  // What holds for a key: what is laid over it, what the text says, or the default.
  value(path, schema) {
    const parts = path.split(".");
    const key = parts.pop();
    const walk = (at, part) => (Array.isArray(at) ? at[Number(part) - 1] : at?.[part]);
    return parts.reduce(walk, this.look.values)?.[key] ?? schema.default;
  }

  control(path, key, schema) {
    const row = document.createElement("label");
    row.className = "control";
    row.title = schema.description ?? "";
    const name = document.createElement("span");
    name.textContent = key;
    row.append(name);
    const set = (value) => this.set({ [path]: value });
    const keep = (value) => this.keep({ [path]: value });
    const input = (attributes) => {
      const element = document.createElement("input");
      Object.assign(element, attributes);
      element.setAttribute("aria-label", `${path}. ${schema.description ?? ""}`);
      row.append(element);
      return element;
    };
    const plain = schema.anyOf?.find((one) => one.type === "number" && !one.title) ?? schema;
    if (this.look.wells[path] !== undefined) {
      const well = input({ type: "color" });
      const held = hold(well, "input", set, keep);
      this.refresh.push(() => !held() && (well.value = this.look.wells[path] ?? well.value));
    } else if (schema.enum) {
      const select = document.createElement("select");
      select.append(...schema.enum.map((word) => new Option(word, word)));
      select.onchange = () => keep(select.value);
      row.append(select);
      this.refresh.push(() => (select.value = this.value(path, schema)));
    } else if (schema.type === "boolean") {
      const box = input({ type: "checkbox" });
      box.onchange = () => keep(box.checked);
      this.refresh.push(() => (box.checked = this.value(path, schema) === true));
    } else if (plain.type === "number" || plain.type === "integer") {
      const whole = plain.type === "integer";
      const least = plain.minimum ?? plain.exclusiveMinimum ?? 0;
      const most = Math.min(plain.maximum ?? plain.exclusiveMaximum ?? 1, REACH[key] ?? 10);
      const step = whole ? 1 : (most - Math.max(least, 0)) / 200;
      const slider = input({ type: "range", min: Math.max(least, whole ? 1 : 0), max: most, step });
      const number = input({ type: "number", step: "any" });
      const value = (of) => (to) => of(Number((number.value = to)));
      const held = hold(slider, "input", value(set), value(keep));
      const typed = hold(number, "input", () => {}, (to) => to !== "" && keep(Number(to)));
      this.refresh.push(() => {
        const value = this.value(path, schema);
        if (typeof value !== "number") {
          [slider.value, number.value] = [slider.min, ""];
          return;
        }
        if (!held()) {
          if (value > Number(slider.max)) slider.max = 2 * value;
          slider.value = value;
        }
        if (!typed()) number.value = Number(value.toPrecision(7));
      });
    } else {
      return null;
    }
    return row;
  }
}

// Calls `set` while a control is moved and `keep` when it is let go of; gives whether it is held.
function hold(control, moved, set, keep) {
  let held = false;
  control.addEventListener(moved, () => {
    held = true;
    set(control.value);
  });
  control.addEventListener("change", () => {
    held = false;
    keep(control.value);
  });
  return () => held;
}
