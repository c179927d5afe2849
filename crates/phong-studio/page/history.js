// Undo and redo: what the text was, and what was laid over it.

// Changes that follow one another sooner than this are one step, milliseconds.
const PAUSE = 700;

// The most steps that are kept.
const MOST = 200;

export class History {
  constructor({ restore, changed }) {
    this.restore = restore;
    this.changed = changed;
    this.start(null);
  }

  // Another scene: there is nothing to take back.
  start(state) {
    this.steps = state ? [state] : [];
    this.place = 0;
    this.noted = 0;
    this.changed?.(this);
  }

  // What holds now. While `held`, a hand is at work, and all of it is one step.
  note(state, held = false) {
    const now = this.steps[this.place];
    if (now && same(now, state)) return;
    const soon = performance.now() - this.noted < PAUSE || this.wasHeld;
    const joins = soon && this.place > 0 && this.place === this.steps.length - 1;
    this.steps.length = Math.min(this.steps.length, this.place + 1);
    if (joins) this.steps[this.place] = state;
    else this.place = this.steps.push(state) - 1;
    if (this.steps.length > MOST) {
      this.steps.shift();
      this.place -= 1;
    }
    this.noted = performance.now();
    this.wasHeld = held;
    this.changed?.(this);
  }

  // A hand lets go: what comes next is another step.
  settle() {
    this.wasHeld = false;
    this.noted = 0;
  }

  get canUndo() {
    return this.place > 0;
  }

  get canRedo() {
    return this.place < this.steps.length - 1;
  }

  undo() {
    if (this.canUndo) this.go(-1);
  }

  redo() {
    if (this.canRedo) this.go(1);
  }

  go(by) {
    this.place += by;
    this.settle();
    this.restore(this.steps[this.place]);
    this.changed?.(this);
  }
}

function same(a, b) {
  return a.text === b.text && a.dressed === b.dressed && JSON.stringify(a.set) === JSON.stringify(b.set);
}
