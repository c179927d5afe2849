// The table of keys, as the engine's schema has it.

// The keys of a table that go with the kind of this one.
export function keysOf({ table, values }) {
  const keys = { ...table.properties };
  for (const { if: condition, then } of table.allOf ?? []) {
    const [select, { const: word }] = Object.entries(condition.properties)[0];
    const chosen = values[select] ?? keys[select]?.default;
    if (chosen === word) Object.assign(keys, then.properties);
  }
  return Object.fromEntries(Object.entries(keys).filter(([, schema]) => schema !== false && !schema.not));
}
