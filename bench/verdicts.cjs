/* What phong says of glTF files, and what Khronos' validator says: how often they agree, and of what kinds the others are.
 *
 *     npm install --prefix FOLDER gltf-validator && NODE_PATH=FOLDER/node_modules node bench/verdicts.cjs PHONG FOLDER…
 *
 * Prints a table, then a line for each kind on which they differ: how many, why, and one of them.
 */
"use strict";
const fs = require("node:fs");
const path = require("node:path");
const { spawnSync } = require("node:child_process");
const validator = require("gltf-validator");

const [phong, ...folders] = process.argv.slice(2);
if (!folders.length) {
  console.error("usage: node bench/verdicts.cjs PHONG FOLDER…");
  process.exit(2);
}
const models = (folder) =>
  fs.readdirSync(folder, { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile() && /\.(gltf|glb)$/i.test(entry.name))
    .map((entry) => path.join(entry.parentPath ?? entry.path, entry.name));

/** The kinds of errors that the validator finds, none where the file is valid. */
async function verdict(file) {
  const beside = (uri) => fs.promises.readFile(path.resolve(path.dirname(file), decodeURIComponent(uri)));
  try {
    const options = { uri: path.basename(file), externalResourceFunction: async (uri) => new Uint8Array(await beside(uri)) };
    const { issues } = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), options);
    const errors = issues.messages.filter((message) => message.severity === 0);
    return [...new Set(errors.map((message) => message.code))].sort();
  } catch (error) {
    return [`no glTF: ${error}`.slice(0, 60)];
  }
}

/** Why phong refuses a file, without what is of this file alone; `null`: it reads it. */
function refused(file) {
  const { status, stderr } = spawnSync(phong, ["check", file], { encoding: "utf8", timeout: 60_000 });
  if (status === 0) return null;
  const line = (stderr ?? "").split("\n").find((line) => line.startsWith("error")) ?? `exit ${status}`;
  return line.replace(/`[^`]*`|\d[\d.]*|\/\S+/g, "…");
}

(async () => {
  const counts = {}, kinds = new Map();
  for (const file of folders.flatMap(models).sort()) {
    const [errors, reason] = [await verdict(file), refused(file)];
    const both = `${errors.length ? "invalid" : "valid"}, ${reason === null ? "read" : "refused"}`;
    counts[both] = (counts[both] ?? 0) + 1;
    if ((errors.length > 0) === (reason !== null)) continue;
    const kind = `${both}: ${reason ?? errors.slice(0, 3).join(", ")}`;
    kinds.set(kind, [...(kinds.get(kind) ?? []), file]);
  }
  console.table(counts);
  for (const [kind, files] of [...kinds].sort((a, b) => b[1].length - a[1].length)) console.log(files.length, kind, "e.g.", files[0]);
})();
