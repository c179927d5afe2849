// Two pixels side by side: what is the same, and what is not.

import { element, number, swatch, triple } from "./elements.js";
import { words } from "./words.js";

export function compare(root, kept, now) {
  const rows = lines(kept).map(([name, mine], i) => {
    const other = lines(now).find(([word]) => word === name)?.[1];
    return row(name, mine, other, i);
  });
  const only = lines(now).filter(([name]) => !lines(kept).some(([word]) => word === name));
  const head = [kept, now].map((told) => element("th", { scope: "col" }, swatch(told), ` ${told.pixel.join(", ")}`));
  root.replaceChildren(
    element(
      "table",
      { class: "compared" },
      element("tr", {}, element("td", {}), ...head),
      ...rows,
      ...only.map(([name, value]) => row(name, undefined, value)),
    ),
  );
}

function row(name, a, b) {
  const differs = JSON.stringify(a) !== JSON.stringify(b);
  const cells = [a, b].map((value) => element("td", {}, shown(value)));
  return element("tr", differs ? { class: "differs" } : {}, element("th", { scope: "row" }, name), ...cells);
}

function shown(value) {
  if (value === undefined || value === null) return words.none;
  if (Array.isArray(value)) return triple(value);
  return typeof value === "number" ? number(value) : String(value);
}

// What two pixels are compared by.
function lines(told) {
  const [sample] = told.samples;
  const all = [];
  if (sample.hit) {
    all.push([words.object, sample.hit.object], [words.material, sample.material.name]);
    all.push(["n", sample.hit.n], ["e", sample.e]);
    for (const light of sample.lights) {
      all.push([`${light.name}: ${words.seen}`, light.visible ? words.yes : light.blocker?.object ?? words.no]);
      all.push([`${light.name}: l·n`, light.n_dot_l], [`${light.name}: r·e`, light.r_dot_e]);
    }
  }
  for (const [name, values] of Object.entries(told.terms)) {
    if (values.some((value) => value !== 0)) all.push([name, values]);
  }
  all.push([words.sum, told.linear]);
  return all;
}
