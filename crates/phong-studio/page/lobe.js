// The polar plot of a highlight: as far from the point as it is strong towards there.

import { drawn, element, number } from "./elements.js";
import { words } from "./words.js";

// Pixels of the plot for a length of 1.
const UNIT = 100;

export function plot(root, { light, points, marks, most, at_eye: atEye }) {
  const place = ([x, y]) => [UNIT * x, -UNIT * y];
  const path = points.map((point, i) => `${i ? "L" : "M"}${place(point).join(" ")}`).join("");
  const arrows = marks.flatMap(({ name, at }) => {
    const [x, y] = place(at);
    return [
      drawn("line", { x1: 0, y1: 0, x2: x, y2: y, class: `line ${name}` }),
      drawn("text", { x: 1.09 * x, y: 1.09 * y, class: name }, name),
    ];
  });
  const picture = drawn(
    "svg",
    { viewBox: "-130 -130 260 150", class: "lobe", role: "img", "aria-label": words.lobeOf(light) },
    drawn("path", { d: `M${-UNIT} 0 A ${UNIT} ${UNIT} 0 0 1 ${UNIT} 0`, class: "horizon" }),
    drawn("line", { x1: -120, y1: 0, x2: 120, y2: 0, class: "ground" }),
    drawn("path", { d: `${path}Z`, class: "outline" }),
    ...arrows,
  );
  const says = element("p", { class: "hint" }, `${words.lobeOf(light)}: ${words.strongest} `, number(most));
  says.append(`, ${words.towardsEye} `, number(atEye), ".");
  root.replaceChildren(picture, says);
}
