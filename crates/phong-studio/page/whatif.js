// "What if": another value of this pixel's material, for this pixel alone. The text stays as it is.

import { element, number, swatch, triple } from "./elements.js";
import { keysOf } from "./keys.js";
import { words } from "./words.js";

// The keys that are asked about.
const KEYS = ["k_a", "k_d", "k_s", "shininess"];

export class WhatIf {
  constructor(root, ask) {
    this.root = root;
    this.ask = ask;
    this.set = {};
  }

  keys(schema) {
    this.table = schema.properties.materials.additionalProperties;
  }

  // Another pixel is explained; `values` are those of the scene.
  show(told, values) {
    const material = told.samples[0].material;
    const of = material ? `${told.pixel} ${material.name} ${material.model}` : "";
    if (of === this.of) return this.answer(null);
    this.of = of;
    this.set = {};
    this.root.replaceChildren();
    if (!material || !this.table) return;
    const known = keysOf({ table: this.table, values: values.materials?.[material.name] ?? {} });
    const rows = KEYS.filter((key) => typeof material[key] === "number" && known[key]);
    this.said = element("p", { class: "result", role: "status" });
    this.root.append(...rows.map((key) => this.row(material, key, known[key])), this.said);
  }

  row(material, key, schema) {
    const most = key === "shininess" ? Math.max(200, 2 * material[key]) : 1;
    const slider = element("input", { type: "range", min: 0, max: most, step: most / 200 });
    slider.value = material[key];
    slider.setAttribute("aria-label", `${words.whatIf} ${key}. ${schema.description ?? ""}`);
    const shown = element("output", {}, number(material[key]));
    slider.oninput = () => {
      shown.replaceChildren(number(Number(slider.value)));
      this.set[`materials.${material.name}.${key}`] = Number(slider.value);
      this.ask(this.set);
    };
    return element("label", { class: "control" }, element("span", {}, key), slider, shown);
  }

  // What the pixel would be.
  answer(told) {
    if (!this.said) return;
    if (told) this.said.replaceChildren(swatch(told), ` ${words.wouldBe} `, triple(told.linear));
    else if (Object.keys(this.set).length) this.ask(this.set);
  }
}
