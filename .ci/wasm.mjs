// Draws scenes with the renderer as WebAssembly, in Node: `node .ci/wasm.mjs MODULES KIND OUT SCENE...`.
// For each scene OUT gets its picture at 320 × 180 as PNG and EXR, and a pixel explained as JSON.

import { readFileSync, writeFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";

const [modules, kind, out, ...scenes] = process.argv.slice(2);

let scene;
let replies = [];
let frames = [];
globalThis.hear = (reply) => replies.push(JSON.parse(reply));
globalThis.take = (bytes) => {
  if (bytes[0] === 3) frames.push(bytes.slice(24));
  return true;
};
globalThis.failed = (why) => console.error(why);
// The other part of the module, which is asked for when a scene is the first to need it.
globalThis.rest = () => {
  console.log(`${scene} needs the rest of the module`);
  return readFileSync(join(modules, `phong-${kind}_rest.wasm`));
};

const script = readFileSync(join(modules, `phong-${kind}.js`)).toString("base64");
const { default: load, Studio } = await import(`data:text/javascript;base64,${script}`);
await load({ module_or_path: readFileSync(join(modules, `phong-${kind}_bg.wasm`)) });

for (scene of scenes) {
  const studio = new Studio(0, 1);
  const ask = (request) => {
    replies = [];
    frames = [];
    studio.receive(JSON.stringify(request));
    return replies;
  };
  const open = { do: "open", path: basename(scene) };
  studio.put(basename(scene), readFileSync(scene));
  ask(open);
  for (let lacking = studio.lacking(); lacking.length > 0; lacking = studio.lacking()) {
    for (const path of lacking) studio.put(path, readFileSync(join(dirname(scene), path)));
    ask(open);
  }
  ask({ do: "look", set: { "image.size": [320, 180], "image.samples": 4 } });
  while (studio.has_work()) studio.advance();
  const stem = join(out, basename(scene, ".toml"));
  for (const format of ["png", "exr"]) {
    const [reply] = ask({ do: "export", format });
    if (reply.is !== "file") throw new Error(`${scene}: ${reply.message}`);
    writeFileSync(`${stem}.${format}`, frames[0]);
  }
  const [{ told }] = ask({ do: "explain", id: 1, pixel: [150, 100] });
  writeFileSync(`${stem}.json`, JSON.stringify(told));
  studio.free();
}
