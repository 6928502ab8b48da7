// The page and the desktop give the same bits: tables of every built-in scene, compared as text.
//
// TABLES is the program `tables` of this crate, built for this machine.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, readdirSync } from "node:fs";
import { test } from "node:test";

const dist = new URL("../dist/", import.meta.url);
const { default: init, tables_of } = await import(new URL("interwell.js", dist));
await init({ module_or_path: readFileSync(new URL("interwell_bg.wasm", dist)) });

const presets = readdirSync(new URL("../../presets/", import.meta.url))
  .filter((file) => file.endsWith(".ron"))
  .map((file) => file.slice(0, -4));

for (const preset of presets) {
  test(preset, () => {
    const desktop = execFileSync(process.env.TABLES, [preset], { encoding: "utf8", maxBuffer: 1 << 28 }).split("\n");
    const page = tables_of(preset).split("\n");
    assert.ok(desktop.length > 400, `${desktop.length} rows`);
    for (const [row, line] of desktop.entries()) assert.equal(page[row], line, `row ${row}`);
    assert.equal(page.length, desktop.length);
  });
}
