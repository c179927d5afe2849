// The renderer as WebAssembly, and what there is to open. A page of static files loads this first, so that both are on
// their way while the rest of the page still comes.

// A module that gives a vector: whether it is one at all tells whether vectors are known here.
const VECTOR = [
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 8, 1, 6, 0, 65, 0, 253, 15, 11,
];

// The name of the module for this browser.
export function name() {
  return globalThis.WebAssembly?.validate(new Uint8Array(VECTOR)) ? "phong-simd" : "phong-plain";
}

// The script that puts the module to work.
export function script() {
  return address(`${name()}.js`);
}

function address(file) {
  return new URL(file, import.meta.url).href;
}

let prepared = null;

// The module, compiled once for all who need it, and what there is to open.
export function prepare() {
  prepared ??= begin();
  return prepared;
}

async function begin() {
  const [module, { open, scenes, look }] = await Promise.all([
    get(`${name()}_bg.wasm`).then(compiled),
    get("files.json").then((answer) => answer.json()),
  ]);
  return { module, script: script(), rest: address(`${name()}_rest.wasm`), open, scenes, look };
}

async function get(file) {
  const answer = await fetch(address(file));
  if (!answer.ok) throw new Error(`${file}: ${answer.status}`);
  return answer;
}

// A module is compiled while it comes in, where the server says that it is one.
async function compiled(answer) {
  if (answer.headers.get("Content-Type") === "application/wasm") return WebAssembly.compileStreaming(answer);
  return WebAssembly.compile(await answer.arrayBuffer());
}

// What goes wrong is told to who asks for it later.
if (globalThis.document?.documentElement.dataset.engine === "worker") prepare().catch(() => {});
