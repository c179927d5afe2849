// A worker of the page with an engine of its own: PROTOCOL.md without a server. Requests and replies
// are texts, tiles and files are buffers, as over a socket; what goes with workers alone is an object.

import { words } from "./words.js";

// The most bytes of a file that is read here: what is made of it takes several times as much, of the
// 4 GB that an engine can have in a page.
const MOST_BYTES = 5e8;

// How long to draw before the next request is heard, in ms.
const SLICE = 12;

// The first byte of a file among messages of bytes.
const FILE = 3;

let studio = null;
let shelf = {};
let deadline = 0;
let trouble = "";
// Replies that wait until it is known whether a file was lacking; null: they are sent at once.
let kept = null;
const asked = new Set();
// What is said of files that are too large.
const large = [];
// The number of the newest picture.
let picture = 0;
const queue = [];
// Tiles that are still to be posted.
const tiles = [];
let awake = false;

// What the module calls.
globalThis.hear = (reply) => {
  post();
  if (reply.startsWith('{"is":"look"')) ({ picture } = JSON.parse(reply));
  if (kept) kept.push(reply);
  else postMessage(reply);
};
globalThis.take = (bytes) => {
  if (bytes.length > 0) tiles.push(bytes.slice());
  if (bytes[0] === FILE) post();
  return performance.now() < deadline;
};

// Posts the tiles of a slice as one message.
function post() {
  if (tiles.length === 0) return;
  const all = new Uint8Array(tiles.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const tile of tiles.splice(0)) {
    all.set(tile, at);
    at += tile.length;
  }
  postMessage(all.buffer, [all.buffer]);
}

globalThis.failed = (why) => (trouble = why);

onmessage = ({ data }) => {
  queue.push(data);
  if (!awake) run();
};

async function run() {
  awake = true;
  try {
    for (;;) {
      while (queue.length > 0) await meet(queue.shift());
      if (!studio.has_work()) break;
      deadline = performance.now() + SLICE;
      studio.advance();
      post();
      await breath();
    }
    awake = false;
  } catch (error) {
    // The module cannot be used any more: whoever started this worker starts another.
    postMessage({ failed: trouble || String(error) });
  }
}

// Lets what was sent meanwhile come in.
const { port1, port2 } = new MessageChannel();
function breath() {
  return new Promise((resolve) => {
    port1.onmessage = resolve;
    port2.postMessage(null);
  });
}

async function meet(message) {
  if (typeof message === "string") return receive(message);
  if (message.module) return begin(message);
  if (message.join) {
    // Shares of a picture whose place another has taken meanwhile are no use.
    if ((message.picture ?? picture) === picture) message.join.forEach((part) => studio.join(part));
    return;
  }
  if (message.part) postMessage({ part: studio.part() ?? null });
}

// Gives the rest of the module, which a scene is the first to need. What needs it is in the middle of its work and
// cannot wait, so that it is fetched while nothing else goes on here; the page goes on.
function fetchRest(address) {
  const request = new XMLHttpRequest();
  request.open("GET", address, false);
  request.responseType = "arraybuffer";
  request.send();
  if (request.status !== 200) throw new Error(`${address}: ${request.status}`);
  return request.response;
}

async function begin({ module, script, rest, share, open, scenes, look }) {
  globalThis.rest = () => fetchRest(rest);
  const { default: load, Studio } = await import(script);
  await load({ module_or_path: module });
  studio = new Studio(...share);
  shelf = scenes;
  if (share[0] === 0) studio.hello(open, Object.keys(scenes).filter((name) => !scenes[name].hidden), look);
}

// Gives the engine a request; if that asks for files of the folder, it is given again with them.
async function receive(request) {
  for (;;) {
    kept = [];
    studio.receive(request);
    const [said, lacking] = [kept, studio.lacking().filter((path) => path in shelf && !asked.has(path))];
    kept = null;
    if (lacking.length === 0) {
      // That a file is too large says more than the engine, to which it is not there.
      return [...said, ...large.splice(0)].forEach((reply) => postMessage(reply));
    }
    for (const path of lacking) await fetchFile(path);
  }
}

async function fetchFile(path) {
  asked.add(path);
  // files.json says how large it is: this is told before any of it is read.
  const { bytes } = shelf[path];
  if (bytes > MOST_BYTES) {
    large.push(JSON.stringify({ is: "error", message: words.tooLargeHere(path, bytes, MOST_BYTES) }));
    return;
  }
  const address = new URL(`scenes/${path.split("/").map(encodeURIComponent).join("/")}`, location.href);
  const answer = await fetch(address).catch(() => null);
  if (answer?.ok) studio.put(path, new Uint8Array(await answer.arrayBuffer()));
}
