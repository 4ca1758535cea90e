"use strict";
// The results, and what of them is shown.

const results = JSON.parse(document.getElementById("results").textContent);
const uris = JSON.parse(document.getElementById("pictures").textContent);
const scenes = results.scenes ?? [];
const cells = results.cells ?? [];
const state = {scene: scenes[0]?.name, kind: null, metric: kMetrics[0], hidden: new Set()};
const at = id => document.getElementById(id);

const styles = new Map();
for (const cell of cells) {
  if (styles.has(cell.series)) continue;
  const before = [...styles.values()].filter(style => style.plain === isPlain(cell)).length;
  styles.set(cell.series, {plain: isPlain(cell), ...styleOf(before, isPlain(cell))});
}

function sceneCells() {
  return cells.filter(cell => cell.scene === state.scene);
}

function shownCells() {
  return sceneCells().filter(cell => kindOf(cell) === state.kind);
}
