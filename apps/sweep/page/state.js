"use strict";
// The results, and the part of them that is shown.

const results = JSON.parse(document.getElementById("results").textContent);
const pictureIndex = JSON.parse(document.getElementById("pictures").textContent);
const scenes = results.scenes ?? [];
const cells = results.cells ?? [];
/// limits: those of the advice, as they were typed; of the error for each metric.
const state = {scene: scenes[0]?.name, reference: null, metric: kMetrics[0], hidden: new Set(), limits: {errors: new Map(), seconds: ""}};
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
  return sceneCells().filter(cell => referenceOf(cell) === state.reference);
}

/// Errors that some picture of those has.
function availableMetrics() {
  return kMetrics.filter(metric => shownCells().some(cell => errorOf(cell, metric) !== null));
}
