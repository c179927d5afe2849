// A pixel, explained: the equation with its numbers, as the engine tells them.

import { element, number, swatch, triple } from "./elements.js";
import { words } from "./words.js";

const SUBSCRIPTS = { c_a: "a", c_d: "d", c_s: "s" };

// `drawn` are the levels of the pixel in a picture with a mistake.
export function show(root, told, drawn) {
  const [sample] = told.samples;
  const parts = [result(told)];
  if (drawn) parts.push(element("p", { class: "result" }, swatch({ srgb8: drawn }), ` ${words.drawn} ${drawn.join(" ")}`));
  if (sample.hit) parts.push(...surface(sample));
  else parts.push(element("p", {}, words.background));
  parts.push(terms(told));
  root.replaceChildren(...parts);
}

function result(told) {
  const { pixel, linear, srgb8 } = told;
  const says = [` (${pixel.join(", ")}): ${words.linear} `, triple(linear), ` ${words.shown} ${srgb8.join(" ")}`];
  return element("p", { class: "result" }, swatch(told), ...says);
}

function surface(sample) {
  const { hit, material } = sample;
  const where = hit.at ? ` ${words.at} ${hit.at}` : "";
  const lead = `${hit.object}${where}, ${words.of} ${material.name}: ${material.model}`;
  const parts = [element("p", {}, lead)];
  parts.push(row("p", triple(hit.p)), row("n", triple(hit.n)), row("e", triple(sample.e)));
  parts.push(
    equation("ambient", [symbol("k", "a"), symbol("C", "a")], [number(material.k_a), triple(sample.c_a)], sample.ambient),
  );
  sample.lights.forEach((light, i) => parts.push(lit(light, i + 1, material)));
  for (const [key, word] of [["reflection", words.mirror], ["transmission", words.glass]]) {
    const onward = sample[key];
    if (onward) {
      parts.push(
        element("p", { class: key }, `${word}: ${words.weight} `, triple(onward.weight), ` × ${words.brought} `, triple(onward.light)),
      );
    }
  }
  return parts;
}

function symbol(letter, below) {
  return element("var", {}, letter, element("sub", {}, below ?? SUBSCRIPTS[letter]));
}

function row(name, value) {
  return element("div", { class: `row ${name}` }, element("var", {}, name), " = ", value);
}

// One term: its symbols, its numbers, what it comes to.
function equation(name, symbols, numbers, result) {
  const join = (parts) => parts.flatMap((part, i) => (i === 0 ? [part] : [" ", part]));
  const times = (parts) => parts.flatMap((part, i) => (i === 0 ? [part] : [" × ", part]));
  return element(
    "div",
    { class: `equation ${name}` },
    element("span", { class: "term" }, name),
    element("span", {}, ...join(symbols), " = ", ...times(numbers), " = ", triple(result)),
  );
}

function lit(light, count, material) {
  const fold = element("div", { class: "light" });
  const unseen = light.visible ? "" : `: ${words.unseen}`;
  const behind = light.blocker ? `, ${words.behind} ${light.blocker.object}` : "";
  fold.append(element("h3", {}, `${light.name}${unseen}${behind}${light.why_not ? ` (${light.why_not})` : ""}`));
  const vectors = [["l", light.l], ["r", light.r], ["h", light.h]].filter(([, v]) => v);
  fold.append(...vectors.map(([name, v]) => row(name, triple(v))));
  const dots = [["l·n", light.n_dot_l], ["r·e", light.r_dot_e], ["n·h", light.n_dot_h]];
  const shown = dots.flatMap(([name, v], i) => [i ? ", " : "", element("var", {}, name), " = ", number(v)]);
  fold.append(element("div", { class: "row" }, ...shown));
  if (light.visible) {
    const cosine = element("span", {}, "(", element("var", {}, `l${count}·n`), ")");
    fold.append(
      equation("diffuse", [symbol("k", "d"), cosine, symbol("C", "d")], [number(material.k_d), number(light.n_dot_l), triple(light.c_d)], light.diffuse),
    );
    if (light.power !== null) {
      fold.append(
        equation("specular", [symbol("k", "s"), element("var", {}, "lobe"), symbol("C", "s")], [number(material.k_s), number(light.power), triple(light.c_s)], light.specular),
      );
    } else {
      fold.append(element("div", { class: "equation specular" }, element("span", { class: "term" }, "specular"), triple(light.specular)));
    }
  }
  return fold;
}

// The bars of the terms, a bar a channel.
function terms(told) {
  const all = Object.entries(told.terms).filter(([, values]) => values.some((value) => value !== 0));
  const most = Math.max(1, ...told.linear, ...all.flatMap(([, values]) => values));
  const bar = (values) => {
    const bars = values.map((value, i) => {
      const one = element("span", { class: `bar ${"rgb"[i]}` });
      one.style.inlineSize = `${(100 * Math.max(value, 0)) / most}%`;
      return one;
    });
    return element("span", { class: "bars", "aria-hidden": "true" }, ...bars);
  };
  const line = (name, values) =>
    element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, triple(values)), element("td", {}, bar(values)));
  const lines = all.map(([name, values]) => line(name, values));
  return element("table", { class: "terms" }, ...lines, line(words.sum, told.linear));
}
