// Small pieces of the page.

const SVG = "http://www.w3.org/2000/svg";

export function element(name, attributes, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

export function drawn(name, attributes, ...children) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

// A number with as many digits as one wants to read; the title has them all.
export function number(value) {
  const text = value === null ? "∞" : Number(value.toPrecision(4)).toString();
  return element("span", { class: "number", title: String(value) }, text);
}

export function triple(values) {
  const parts = values.flatMap((value, i) => (i === 0 ? [number(value)] : [", ", number(value)]));
  return element("span", { class: "triple" }, "(", ...parts, ")");
}

export function swatch({ srgb8 }) {
  const sample = element("span", { class: "swatch" });
  sample.style.backgroundColor = `rgb(${srgb8.join(" ")})`;
  return sample;
}

// A check box with its word.
export function check(word, checked, change) {
  const box = element("input", { type: "checkbox" });
  box.checked = checked;
  box.onchange = () => change(box.checked);
  return element("label", {}, box, ` ${word}`);
}
