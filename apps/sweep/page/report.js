"use strict";
// The controls, and the parts of the page that change with them.

function fillScenes() {
  at("scenes").hidden = scenes.length < 2;
  for (const scene of scenes) {
    const input = element("input", {type: "radio", name: "scene", value: scene.name, checked: scene.name === state.scene});
    input.addEventListener("change", () => {
      state.scene = scene.name;
      update();
    });
    at("scenes").append(element("label", {}, input, element("span", {textContent: scene.name})));
  }
}

/// Keeps what was chosen where the scene has it.
function fillChoices() {
  const names = referenceNames(sceneCells());
  if (!names.has(state.reference)) state.reference = [...names.keys()][0] ?? "path";
  at("reference-label").hidden = names.size < 2;
  at("reference").replaceChildren(...[...names].map(([key, name]) =>
    element("option", {value: key, textContent: name, selected: key === state.reference})));

  const metrics = availableMetrics();
  if (!metrics.includes(state.metric)) state.metric = metrics[0] ?? kMetrics[0];
  at("metric-label").hidden = metrics.length === 0;
  at("metric").replaceChildren(...metrics.map(metric => element("option", {value: metric.key, textContent: metric.label, selected: metric === state.metric})));
}

function drawPictures() {
  const scene = scenes.find(s => s.name === state.scene) ?? {};
  const pictures = picturesOf(scene, sceneCells());
  const some = pictures.some(p => p.cell);
  at("pictures-section").hidden = !some;
  drawStrip(pictures);
  if (!some) return;
  at("zoom").value = "fit";
  showPictures(pictures, defaultPair(pictures, state.reference));
}

function drawHead() {
  const names = scenes.map(scene => scene.name).join(", ");
  document.title = `gatelight sweep: ${names}`;
  at("title").textContent = names ? `Sweep: ${names}` : "Sweep";
  const failed = cells.filter(cell => cell.status === "failed").length;
  const seeds = new Set(cells.map(cell => cell.seed)).size;
  at("abstract").textContent = `${plural(cells.length - failed, "picture")} of ${plural(scenes.length, "scene")}, ` +
    `${plural(styles.size, "series")}, ${plural(seeds, "seed")}` +
    `${failed > 0 ? `, ${failed} failed` : ""}. How far each is from a reference, and what it took.`;
  at("no-charts").hidden = kHasCharts;
  at("chart-note").hidden = !kHasCharts;
  if (kHasCharts) at("chart-version").textContent = `Chart.js ${Chart.version}`;
  const bytes = pictureIndex.reduce((sum, entry) => sum + entry.bytes, 0);
  at("page-size").textContent = `${formatBytes(Number(document.body.dataset.bytes))}` +
    (pictureIndex.length > 0 ? `, of which ${formatBytes(bytes)} are ${plural(pictureIndex.length, "picture")} and maps` : "");
}

// A change of scene or reference changes everything, of the error only the charts.
function update() {
  fillChoices();
  drawWords();
  drawCharts();
  drawPictures();
  drawCosts();
  drawCells();
  drawFailures();
  drawProvenance();
}

at("reference").addEventListener("change", () => {
  state.reference = at("reference").value;
  update();
});
at("metric").addEventListener("change", () => {
  state.metric = kMetrics.find(metric => metric.key === at("metric").value);
  drawCharts();
});
at("max-error").addEventListener("input", () => {
  state.limits.errors.set(state.metric.key, at("max-error").value);
  drawCharts();
});
at("max-seconds").addEventListener("input", () => {
  state.limits.seconds = at("max-seconds").value;
  drawCharts();
});
at("limits").addEventListener("submit", event => event.preventDefault());
at("zoom").addEventListener("change", zoomStage);
addEventListener("resize", zoomStage);
at("filter").addEventListener("input", drawCells);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawCharts);
listenToKeys();
listenToPointer();
listenToStrip();
listenToCopied();
moveBorder(50);
drawHead();
fillScenes();
update();
