"use strict";
// The controls, and who is told when they change.

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
  const kinds = [...new Set(sceneCells().map(kindOf))];
  if (!kinds.includes(state.kind)) state.kind = kinds[0] ?? "path";
  at("kind-label").hidden = kinds.length < 2;
  at("kind").replaceChildren(...kinds.map(kind => element("option", {value: kind, textContent: kKinds[kind] ?? kind, selected: kind === state.kind})));

  const metrics = kMetrics.filter(metric => shownCells().some(cell => errorOf(cell, metric) !== null));
  if (!metrics.includes(state.metric)) state.metric = metrics[0] ?? kMetrics[0];
  at("metric-label").hidden = metrics.length === 0;
  at("metric").replaceChildren(...metrics.map(metric => element("option", {value: metric.key, textContent: metric.label, selected: metric === state.metric})));
}

function drawPictures() {
  const scene = scenes.find(s => s.name === state.scene) ?? {};
  const pictures = picturesOf(scene, sceneCells(), uris);
  const some = pictures.some(p => p.cell);
  at("pictures-section").hidden = !some;
  if (!some) return;
  const pair = defaultPair(pictures, state.kind);
  for (const side of ["left", "right"]) {
    const show = () => showSide(side, pictures.find(p => p.id === at(side).value));
    fillSelect(at(side), pictures, pair[side]);
    at(side).onchange = show;
    show();
  }
  at("zoom").value = "fit";
  zoomStage("fit");
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
  at("chart-version").textContent = `Chart.js ${Chart.version}`;
}

// A change of scene or reference changes everything, of the error only the charts.
function update() {
  fillChoices();
  drawCharts();
  drawPictures();
  drawCosts();
  drawCells();
  drawFailures();
  drawProvenance();
}

at("kind").addEventListener("change", () => {
  state.kind = at("kind").value;
  update();
});
at("metric").addEventListener("change", () => {
  state.metric = kMetrics.find(metric => metric.key === at("metric").value);
  drawCharts();
});
at("zoom").addEventListener("change", () => zoomStage(at("zoom").value));
at("filter").addEventListener("input", drawCells);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawCharts);
listenToBorder();
moveBorder(50);
drawHead();
fillScenes();
update();
