// What hands do, gathered: the next of it is sent when the picture of the last can be seen, so that a
// drag shows as many pictures as can be drawn, each the newest.

// How long a picture is waited for, milliseconds.
const PATIENCE = 400;

export class Hands {
  constructor(send) {
    this.send = send;
    this.pending = {};
    this.waits = 0;
    this.asked = false;
  }

  turn(by) {
    this.gather("turn", (before = [0, 0]) => before.map((n, i) => n + by[i]));
  }

  move(by) {
    this.gather("move", (before = [0, 0]) => before.map((n, i) => n + by[i]));
  }

  zoom(by) {
    this.gather("zoom", (before = 1) => before * by);
  }

  look(set) {
    this.gather("look", (before = {}) => ({ ...before, ...set }));
  }

  drag(drag) {
    this.gather("drag", () => drag);
  }

  // Shows a frame.
  frame(number) {
    this.gather("frame", () => number);
  }

  // Shows a look; `null`: none.
  tryOn(look) {
    this.gather("try-on", () => ({ look }));
  }

  // Something of the last picture is seen, or will never be.
  seen() {
    this.waits = 0;
    if (Object.keys(this.pending).length) this.soon();
  }

  // Sends what is gathered, whatever is seen.
  flush() {
    const { turn, move, zoom, look, drag, frame, "try-on": tried } = this.pending;
    this.pending = {};
    if (turn) this.send({ do: "turn", by: turn });
    if (move) this.send({ do: "move", by: move });
    if (zoom) this.send({ do: "zoom", by: zoom });
    if (look) this.send({ do: "look", set: look });
    if (drag) this.send({ do: "drag", ...drag });
    if (frame !== undefined) this.send({ do: "frame", number: frame });
    if (tried) this.send({ do: "try-on", ...tried });
  }

  forget(what) {
    delete this.pending[what];
  }

  gather(what, change) {
    this.pending[what] = change(this.pending[what]);
    if (performance.now() > this.waits) this.soon();
    else setTimeout(() => performance.now() > this.waits && this.soon(), PATIENCE);
  }

  soon() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      if (!Object.keys(this.pending).length) return;
      this.waits = performance.now() + PATIENCE;
      this.flush();
    });
  }
}
