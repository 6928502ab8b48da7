// The page and the desktop give the same bits: tables of every built-in scene, compared as text.
//
// TABLES is the program `tables` of this crate, built for this machine.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, readdirSync } from "node:fs";
import { test } from "node:test";

const dist = new URL("../dist/", import.meta.url);
const { default: init, map_of, tables_of } = await import(new URL("interwell.js", dist));
await init({ module_or_path: readFileSync(new URL("interwell_bg.wasm", dist)) });

function same(desktop, page) {
  const rows = page.split("\n");
  for (const [row, line] of desktop.split("\n").entries()) assert.equal(rows[row], line, `row ${row}`);
  assert.equal(page.length, desktop.length);
}

const native = (...names) => execFileSync(process.env.TABLES, names, { encoding: "utf8", maxBuffer: 1 << 28 });

const presets = readdirSync(new URL("../../presets/", import.meta.url))
  .filter((file) => file.endsWith(".ron"))
  .map((file) => file.slice(0, -4));

for (const preset of presets) {
  test(preset, () => {
    const desktop = native(preset);
    assert.ok(desktop.split("\n").length > 400, desktop);
    same(desktop, tables_of(preset));
  });
}

test("the map of the study", (context) => {
  const times = [performance.now()];
  const desktop = native("map", "paper");
  times.push(performance.now());
  same(desktop, map_of("paper"));
  times.push(performance.now());
  const [here, page] = [times[1] - times[0], times[2] - times[1]].map((time) => (time / 1e3).toFixed(2));
  context.diagnostic(`${desktop.split("\n").length - 2} cells: ${page} s in the page, ${here} s by this build here`);
});
