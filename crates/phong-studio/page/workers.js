// Engines in workers of this page, which draw each picture together: each has a share of its tiles, and
// to the page they are one engine. The first answers; of the others only tiles and passes are used.

import { frames } from "./frame.js";
import { prepare, script } from "./module.js";
import { words } from "./words.js";

// More share what is drawn, but each reads the scene for itself.
const MOST = 8;

// Requests that leave the picture as it is: the first engine alone is asked.
const ASKED = new Set(["explain", "export", "keys", "facets", "cosine-power", "lobe", "guess", "grade", "save", "check-file"]);

export function work({ hear, take }) {
  return new Team(hear, take);
}

class Team {
  constructor(hear, take) {
    this.hear = hear;
    this.take = take;
    const asked = new URLSearchParams(location.search).get("workers");
    this.count = Math.max(1, Math.min(Number(asked) || (navigator.hardwareConcurrency ?? 2), MOST));
    this.open = null; // the newest scene that was asked for
    this.parts = null; // who waits for shares
    this.exports = Promise.resolve(); // one export after another
    this.ready = prepare();
    this.ready.catch((error) => hear({ is: "error", message: words.noEngine + error.message }));
    this.start();
  }

  // Does something when the module is there; where it cannot be had, nothing.
  whenReady(act) {
    this.ready.then(act, () => {});
  }

  start() {
    this.picture = 0; // the number of the newest picture
    this.begun = false; // whether its first pass is shown
    this.passed = new Map(); // for each of its passes, how many engines have done it
    this.early = []; // what others have drawn that cannot be shown yet
    this.workers = Array.from({ length: this.count }, (_, index) => {
      const worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
      worker.onmessage = ({ data }) => this.heard(index, data);
      worker.onerror = (event) => this.restart(event.message ?? "");
      // Its script comes while the module is still compiled.
      worker.postMessage({ early: script() });
      this.whenReady((kit) => worker.postMessage({ ...kit, share: [index, this.count] }));
      return worker;
    });
  }

  send(request) {
    this.whenReady(() => {
      if (request.do === "open") this.open = request;
      if (request.do === "export") this.exports = this.exports.then(() => this.exported(request));
      else this.tell(request, ASKED.has(request.do) ? 1 : this.count);
    });
  }

  close() {
    this.hear = this.take = () => {};
    this.workers?.forEach((worker) => worker.terminate());
  }

  tell(request, many) {
    for (const worker of this.workers.slice(0, many)) worker.postMessage(JSON.stringify(request));
  }

  // The first engine is given the shares of the others, and then asked; unless another picture is under
  // way by then, if it is asked of one picture alone.
  async exported(request) {
    const others = this.workers.slice(1);
    const isGone = () => request.do === "finish" && request.picture !== this.picture;
    if (isGone()) return;
    const parts = new Promise((resolve) => (this.parts = { all: [], resolve }));
    others.forEach((worker) => worker.postMessage({ part: true }));
    const all = others.length > 0 ? await parts : [];
    if (isGone()) return;
    this.workers[0].postMessage({ join: all.filter((part) => part), picture: request.picture });
    this.tell(request, 1);
  }

  heard(index, data) {
    if (typeof data === "string") return this.replied(index, JSON.parse(data));
    if (data instanceof ArrayBuffer) {
      for (const frame of frames(data)) this.drawn(index, frame);
      return;
    }
    if (data.failed !== undefined) return this.restart(data.failed);
    this.parts.all.push(data.part);
    if (this.parts.all.length === this.count - 1) this.parts.resolve(this.parts.all);
  }

  replied(index, reply) {
    if (reply.is === "pass") return this.drawn(index, reply);
    if (index !== 0) return;
    if (this.again && (reply.is === "hello" || reply.is === "scene")) return;
    if (reply.is === "look") {
      this.again = false;
      this.picture = reply.picture;
      this.finished = reply.finished;
      this.begun = false;
      this.passed.clear();
      this.early = this.early.filter((one) => one.picture >= reply.picture);
    }
    this.hear(reply);
  }

  // A tile or a pass. The first pass is the first engine's; nothing finer is shown before.
  drawn(index, one) {
    if (one.kind === "file") return this.take(one);
    const first = index === 0 && one.picture === this.picture;
    if (!first && (one.picture > this.picture || (one.picture === this.picture && !this.begun))) {
      this.early.push(one);
    } else if (one.picture === this.picture) {
      this.show(one);
    }
  }

  show(one) {
    if (one.is !== "pass") return this.take(one);
    if (one.pass === 0) {
      this.begun = true;
      this.hear(one);
      const early = this.early.filter(({ picture }) => picture === this.picture);
      this.early = this.early.filter(({ picture }) => picture !== this.picture);
      return early.forEach((each) => this.show(each));
    }
    const passed = 1 + (this.passed.get(one.pass) ?? 0);
    this.passed.set(one.pass, passed);
    if (passed < this.count) return;
    const last = one.pass + 1 === one.passes;
    if (last && this.finished && passed === this.count && this.count > 1) {
      // What is drawn onto the whole is drawn by the first engine, which then says this pass once more.
      const request = { do: "finish", picture: one.picture };
      this.exports = this.exports.then(() => this.exported(request));
      return;
    }
    this.hear(one);
    if (last) keep();
  }

  // An engine has come to a bad end: all begin anew with the scene that was opened last.
  restart(why) {
    this.workers.forEach((worker) => worker.terminate());
    this.parts?.resolve([]); // nobody gives a share any more
    this.hear({ is: "error", message: words.failed + why });
    if (this.again) return; // twice in a row: it is the scene
    this.again = true;
    this.start();
    if (this.open) this.whenReady(() => this.tell(this.open, this.count));
  }
}

// Keeps the page for when there is no network, once there is time for it.
let isKept = false;
function keep() {
  if (isKept || !globalThis.isSecureContext) return;
  isKept = true;
  navigator.serviceWorker?.register(new URL("offline.js", import.meta.url)).catch(() => {});
}
