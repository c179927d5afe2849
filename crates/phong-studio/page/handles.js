// Handles in the picture: lights, the point looked at, objects. Where they are, and where they go, says
// the engine.

import { words } from "./words.js";

// How far an arrow key moves a handle, in heights of the picture.
const NUDGE = 0.02;

export class Handles {
  constructor(frame, canvas, { drag, drop }) {
    this.canvas = canvas;
    this.drag = drag;
    this.drop = drop;
    this.held = null;
    this.root = document.createElement("div");
    this.root.id = "handles";
    frame.append(this.root);
  }

  show(handles) {
    this.places = new Map(handles.map((one) => [one.path, one.at]));
    const shown = [...this.root.children].map((one) => one.dataset.path).join();
    if (shown !== handles.map(({ path }) => path).join() && !this.held) {
      this.root.replaceChildren(...handles.map((handle) => this.button(handle)));
    }
    for (const button of this.root.children) {
      const at = this.places.get(button.dataset.path);
      button.hidden = !at;
      if (at) this.put(button, at);
    }
  }

  put(button, [x, y]) {
    button.style.left = `${(100 * x) / this.canvas.width}%`;
    button.style.top = `${(100 * y) / this.canvas.height}%`;
  }

  button({ path, kind, name }) {
    const button = document.createElement("button");
    button.type = "button";
    button.className = `handle ${kind}`;
    button.dataset.path = path;
    button.title = name;
    button.setAttribute("aria-label", words.handle(name, path));
    button.addEventListener("pointerdown", (event) => this.take(event, button));
    button.addEventListener("keydown", (event) => this.nudge(event, path));
    return button;
  }

  // From taking hold of a handle to letting go of it.
  take(event, button) {
    if (event.button !== 0) return;
    event.preventDefault();
    event.stopPropagation();
    button.focus();
    button.setPointerCapture(event.pointerId);
    const { path } = button.dataset;
    const box = this.canvas.getBoundingClientRect();
    const from = this.places.get(path);
    const start = [event.clientX, event.clientY];
    const to = (now) => [
      from[0] + ((now.clientX - start[0]) / box.width) * this.canvas.width,
      from[1] + ((now.clientY - start[1]) / box.height) * this.canvas.height,
    ];
    this.held = path;
    let moved = false;
    const move = (now) => {
      now.stopPropagation();
      moved = true;
      this.drag({ path, from, to: to(now) });
    };
    const end = (now) => {
      now.stopPropagation();
      button.removeEventListener("pointermove", move);
      button.removeEventListener("pointerup", end);
      button.removeEventListener("pointercancel", end);
      this.held = null;
      if (moved) this.drop({ path, from, to: to(now), keep: true });
    };
    button.addEventListener("pointermove", move);
    button.addEventListener("pointerup", end);
    button.addEventListener("pointercancel", end);
  }

  nudge(event, path) {
    const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const way = ways[event.key];
    const from = this.places.get(path);
    if (!way || !from) return;
    event.preventDefault();
    event.stopPropagation();
    const to = from.map((n, i) => n + way[i] * NUDGE * this.canvas.height);
    this.drop({ path, from, to, keep: true });
  }
}
