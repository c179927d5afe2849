// The picture, what is drawn over it, and the hands on it.

import { drawn } from "./elements.js";

export class Picture {
  constructor(frame, hands, { point, pin }) {
    this.frame = frame;
    this.canvas = frame.querySelector("canvas");
    this.overlay = frame.querySelector("svg");
    this.context = this.canvas.getContext("2d");
    this.small = document.createElement("canvas");
    this.number = 0;
    this.hands = hands;
    this.point = point;
    this.pin = pin;
    this.held = false;
    this.under = null; // the pixel that a pointer was last over
    this.listen();
  }

  // A picture of this number and size begins; the last one stays until there is something of it.
  begin(number, [width, height]) {
    this.number = number;
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
      this.overlay?.setAttribute("viewBox", `0 0 ${width} ${height}`);
      this.frame.style.setProperty("--width", width);
      this.frame.style.setProperty("--height", height);
    }
  }

  tile({ step, picture, x, y, width, height, bytes }) {
    if (picture !== this.number) return;
    const image = new ImageData(bytes, width, height);
    if (step === 1) {
      this.context.putImageData(image, x, y);
      return;
    }
    const across = Math.ceil(this.canvas.width / step);
    const down = Math.ceil(this.canvas.height / step);
    if (this.small.width !== across || this.small.height !== down) {
      this.small.width = across;
      this.small.height = down;
    }
    this.small.getContext("2d").putImageData(image, x, y);
  }

  // The first pass is whole: it is shown at the picture's size.
  first() {
    this.context.drawImage(this.small, 0, 0, this.canvas.width, this.canvas.height);
  }

  // Draws what an explanation says over the picture.
  lines(lines, [x, y]) {
    const scale = this.canvas.height / 540;
    this.overlay.style.setProperty("--scale", scale);
    const parts = [this.ring([x, y], "pixel")];
    for (const { name, light, from, to } of lines) {
      const along = { x1: from[0], y1: from[1], x2: to[0], y2: to[1] };
      parts.push(drawn("line", { ...along, class: "under" }), drawn("line", { ...along, class: `line ${name}` }));
      if (name.length === 1) {
        parts.push(drawn("circle", { cx: to[0], cy: to[1], r: 3 * scale, class: `tip ${name}` }));
        const label = light === null ? name : `${name}${light}`;
        parts.push(drawn("text", { x: to[0] + 6 * scale, y: to[1] - 4 * scale, class: name }, label));
      }
    }
    if (this.other) parts.push(this.ring(this.other, "pixel other"));
    this.overlay.replaceChildren(...parts);
  }

  // Marks the other pixel of two that are compared; `null`: none.
  mark(pixel) {
    this.other = pixel;
    this.overlay.querySelector(".other")?.remove();
    if (pixel) this.overlay.append(this.ring(pixel, "pixel other"));
  }

  ring([x, y], kind) {
    return drawn("circle", { cx: x + 0.5, cy: y + 0.5, r: (4 * this.canvas.height) / 540, class: kind });
  }

  clear() {
    this.overlay.replaceChildren();
  }

  // The pixel under a pointer.
  pixel({ clientX, clientY }) {
    const box = this.canvas.getBoundingClientRect();
    const x = Math.floor(((clientX - box.left) / box.width) * this.canvas.width);
    const y = Math.floor(((clientY - box.top) / box.height) * this.canvas.height);
    const inside = x >= 0 && y >= 0 && x < this.canvas.width && y < this.canvas.height;
    return inside ? [x, y] : null;
  }

  listen() {
    const { frame, canvas } = this;
    const fingers = new Map();
    let travelled = 0;
    frame.addEventListener("pointerdown", (event) => {
      frame.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, [event.clientX, event.clientY]);
      travelled = fingers.size > 1 ? Infinity : 0;
      this.held = true;
    });
    frame.addEventListener("pointermove", (event) => {
      const before = fingers.get(event.pointerId);
      const pixel = this.pixel(event);
      this.under = pixel ?? this.under;
      if (!before) {
        if (pixel) this.point(pixel);
        return;
      }
      const now = [event.clientX, event.clientY];
      const height = canvas.getBoundingClientRect().height || 1;
      const by = now.map((n, i) => (n - before[i]) / height);
      travelled += Math.hypot(...by) * height;
      if (travelled < 4) return;
      if (fingers.size === 2) {
        const [other] = [...fingers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
        const apart = (place) => Math.hypot(place[0] - other[0], place[1] - other[1]) || 1;
        this.hands.zoom(apart(before) / apart(now));
        this.hands.move(by.map((n) => n / 2));
      } else {
        this.hands[event.shiftKey || event.buttons > 1 ? "move" : "turn"](by);
      }
      fingers.set(event.pointerId, now);
    });
    const end = (event) => {
      const was = fingers.delete(event.pointerId);
      this.held = fingers.size > 0;
      const pixel = this.pixel(event);
      if (was && travelled < 4 && pixel && event.type === "pointerup") this.pin(pixel, event.shiftKey);
    };
    frame.addEventListener("pointerup", end);
    frame.addEventListener("pointercancel", end);
    frame.addEventListener("contextmenu", (event) => event.preventDefault());
    frame.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.hands.zoom(event.deltaY > 0 ? 1.1 : 1 / 1.1);
      },
      { passive: false },
    );
    frame.addEventListener("keydown", (event) => {
      const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
      const way = ways[event.key];
      if (way) this.hands[event.shiftKey ? "move" : "turn"](way.map((n) => n * 0.04));
      else if (event.key === "+" || event.key === "=") this.hands.zoom(1 / 1.1);
      else if (event.key === "-") this.hands.zoom(1.1);
      else return;
      event.preventDefault();
    });
  }
}
