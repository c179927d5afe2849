// A worker of the page with an engine of its own: PROTOCOL.md without a server. Requests and replies
// are texts, tiles and files are buffers, as over a socket; what goes with workers alone is an object.

import { words } from "./words.js";

// The most bytes of a file that is read here: what is made of it takes several times as much, of the
// 4 GB that an engine can have in a page.
const MOST_BYTES = 5e8;

// How long to draw before the next request is heard, in ms.
const SLICE = 12;

// How long another change is waited for, in ms, before more than the first pass is drawn, where the picture before was
// given up with nothing more. The server does the same.
const PAUSE = 50;

// How much of a picture is drawn: nothing, its first pass, a pass of its full size.
const [BEGUN, COARSE, FINE] = [0, 1, 2];

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
// How much of it is drawn, and since when it is; whether the one before was given up with nothing but its first pass.
let stage = BEGUN;
let seen = 0;
let hasty = false;
// Whether this worker draws first passes.
let isFirst = true;
const queue = [];
// Tiles that are still to be posted.
const tiles = [];
let awake = false;
let wake = () => {};

// What the module calls.
globalThis.hear = (reply) => {
  post();
  if (reply.startsWith('{"is":"look"')) began(JSON.parse(reply));
  else if (reply.startsWith('{"is":"pass"')) reach(JSON.parse(reply).pass === 0 ? COARSE : FINE);
  if (kept) kept.push(reply);
  else postMessage(reply);
};
globalThis.take = (bytes) => {
  if (bytes.length > 0) tiles.push(bytes.slice());
  if (bytes[0] === FILE) post();
  return performance.now() < deadline;
};

// A picture begins.
function began(look) {
  ({ picture } = look);
  if (stage !== BEGUN) hasty = stage === COARSE;
  // Who draws no first pass has nothing to wait for.
  reach(isFirst ? BEGUN : COARSE);
}

function reach(now) {
  stage = now;
  seen = performance.now();
}

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
  if (awake) wake();
  else run();
};

async function run() {
  awake = true;
  try {
    for (;;) {
      while (queue.length > 0) await meet(queue.shift());
      if (!studio?.has_work()) break;
      const left = hasty && stage === COARSE ? seen + PAUSE - performance.now() : 0;
      if (left > 0) {
        await pause(left);
        continue;
      }
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

// Waits so many ms, or until something comes.
function pause(time) {
  return new Promise((resolve) => {
    const timer = setTimeout(resolve, time);
    wake = () => {
      clearTimeout(timer);
      resolve();
    };
  });
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
  if (message.early) return void import(message.early).catch(() => {}); // what is wrong with it is told when it is needed
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
  shelf = scenes;
  isFirst = share[0] === 0;
  // What will be opened first comes meanwhile.
  const first = scenes[open]?.bytes <= MOST_BYTES ? read(open) : null;
  const { default: load, Studio } = await import(script);
  await load({ module_or_path: module });
  studio = new Studio(...share);
  if (first) await put(open, first);
  if (isFirst) studio.hello(open, Object.keys(scenes).filter((name) => !scenes[name].hidden), look);
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
  await put(path, read(path));
}

// Fetches a file; null: it cannot be had.
async function read(path) {
  const address = new URL(`scenes/${path.split("/").map(encodeURIComponent).join("/")}`, location.href);
  const answer = await fetch(address).catch(() => null);
  return answer?.ok ? answer.arrayBuffer() : null;
}

// Gives the engine a file that is on its way.
async function put(path, coming) {
  asked.add(path);
  const bytes = await coming;
  if (bytes) studio.put(path, new Uint8Array(bytes));
}
