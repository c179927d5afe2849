// What can be written at the caret, from the table of keys.

import { keysOf } from "./keys.js";

// The most that is offered at once.
const MOST = 12;

// What can stand at a place of the text: `from` is where it begins, `offers` are texts with what they
// mean; `null`: nothing is known.
export function complete(schema, text, caret) {
  const start = text.lastIndexOf("\n", caret - 1) + 1;
  const line = text.slice(start, caret);
  const header = /^\s*\[\[?\s*([\w.-]*)$/.exec(line);
  if (header) return offers(schema.properties, header[1], caret, headers(schema));
  const value = /^\s*([\w-]+)\s*=\s*(["']?)([\w-]*)$/.exec(line);
  const table = tableAt(schema, text, start);
  if (!table) return null;
  if (value) {
    const choices = table.keys[value[1]];
    const all = Object.fromEntries(wordsOf(choices).map((word) => [`"${word}"`, choices]));
    return offers(all, value[2] + value[3], caret, undefined, true);
  }
  const key = /^\s*([\w-]*)$/.exec(line);
  if (!key) return null;
  const left = Object.entries(table.keys).filter(([name]) => !table.written.has(name) || name === key[1]);
  return offers(Object.fromEntries(left), key[1], caret, undefined, key[1] === "");
}

function offers(all, typed, caret, names = Object.keys(all), whole = false) {
  const bare = typed.replace(/["']/g, "");
  const fits = (name) => name.replace(/"/g, "").startsWith(bare) && name !== typed;
  const list = names.filter(fits).slice(0, MOST);
  const told = list.map((name) => ({ text: name, means: all[name]?.description ?? "" }));
  return told.length && (typed || whole) ? { from: caret - typed.length, offers: told } : null;
}

function headers(schema) {
  return Object.keys(schema.properties).filter((name) => name !== "version");
}

function wordsOf(schema) {
  const all = [schema, ...(schema?.anyOf ?? []), ...(schema?.oneOf ?? [])];
  return all.flatMap((one) => one?.enum ?? []).filter((word) => typeof word === "string");
}

// The table that a line stands in: the keys that go with its kind, and those that it has.
function tableAt(schema, text, start) {
  const lines = text.slice(0, start).split("\n");
  let at = lines.length - 1;
  while (at >= 0 && !/^\s*\[/.test(lines[at])) at -= 1;
  if (at < 0) return { keys: schema.properties, written: keysWritten(lines) };
  const [, path] = /^\s*\[\[?\s*([^\]]*?)\s*\]/.exec(lines[at]) ?? [];
  const after = text.slice(start).split("\n");
  const end = after.findIndex((line) => /^\s*\[/.test(line));
  const own = [...lines.slice(at + 1), ...after.slice(0, end < 0 ? undefined : end)];
  const [first, ...rest] = (path ?? "").split(".");
  let table = schema.properties[first];
  if (first === "groups") table = schema.properties[rest[1]];
  table = table?.items ?? (rest.length ? table?.additionalProperties : table) ?? table;
  if (!table?.properties) return null;
  const values = {};
  for (const line of own) {
    const said = /^\s*([\w-]+)\s*=\s*["']([\w-]+)["']/.exec(line);
    if (said) values[said[1]] = said[2];
  }
  return { keys: keysOf({ table, values }), written: keysWritten(own) };
}

function keysWritten(lines) {
  return new Set(lines.map((line) => /^\s*([\w-]+)\s*[=.]/.exec(line)?.[1]).filter(Boolean));
}
