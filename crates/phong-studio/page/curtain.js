// A and B: what was shown when A was kept, beside what is shown now, from the same eye. A is drawn by an
// engine of its own, which is given every turn of the camera too.

import { connect } from "./engine.js";
import { Picture } from "./picture.js";
import { element } from "./elements.js";

export class Curtain {
  constructor(frame, slider) {
    this.frame = frame;
    this.slider = slider;
    this.engine = null;
    slider.oninput = () => this.place();
  }

  // Keeps what is shown as A.
  keep({ path, text, set, values, frame }) {
    this.leave();
    this.root = element("div", { class: "curtain" }, element("canvas", { width: 1, height: 1 }), element("span", {}, "A"));
    this.frame.querySelector("canvas").after(this.root);
    this.canvas = this.root.querySelector("canvas");
    this.picture = new Picture(this.root, null, {});
    const begin = () => {
      this.send({ do: "open", path });
      if (frame > 0) this.send({ do: "frame", number: frame });
      if (text === null) this.send({ do: "look", set });
      else this.send({ do: "edit", text, set });
    };
    const hear = (reply) => {
      if (reply.is === "hello") begin();
      if (reply.is === "look") this.picture.begin(reply.picture, reply.size);
      if (reply.is === "pass" && reply.picture === this.picture.number) {
        if (reply.pass === 0) this.picture.first();
        this.done = reply.pass + 1 === reply.passes;
      }
    };
    this.engine = connect({ hear, take: (frame) => this.picture.tile(frame), gone: () => this.leave() });
    this.camera = values.camera ?? {};
    this.slider.hidden = false;
    this.place();
  }

  leave() {
    this.engine?.close?.();
    this.engine = null;
    this.root?.remove();
    this.slider.hidden = true;
  }

  send(request) {
    this.engine?.send(request);
  }

  // A is seen from where B is.
  follow({ values }) {
    if (!this.engine) return;
    const camera = values.camera ?? {};
    if (JSON.stringify(camera) === JSON.stringify(this.camera)) return;
    const gone = Object.keys(this.camera).filter((key) => !(key in camera));
    const set = Object.fromEntries(gone.map((key) => [`camera.${key}`, null]));
    for (const [key, value] of Object.entries(camera)) set[`camera.${key}`] = value;
    this.camera = camera;
    this.send({ do: "look", set });
  }

  place() {
    this.root?.style.setProperty("--share", `${this.slider.value}%`);
  }
}
