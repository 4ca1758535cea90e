"use strict";
// The tables of costs, pictures and failures, and where all of it comes from.

const kAnswers = "1920 × 1080 answers";

function drawCosts() {
  const trained = shownCells().filter(cell => cell.status === "done" && !isPlain(cell));
  const rows = [...groupBy(trained, cell => cell.series).values()].map(group => {
    const most = Math.max(...group.map(cell => cell.train_steps));
    return {series: group[0].series, steps: most, cells: group.filter(cell => cell.train_steps === most)};
  });
  at("costs").hidden = rows.length === 0;
  if (rows.length === 0) return;
  const number = (label, unit, of, show) => ({
    label, unit, number: true, value: row => mean(row.cells.map(of)),
    show: show ?? ((value, row) => spread(row.cells.map(of))),
  });
  const bytes = (label, of) => number(label, "", of, formatBytes);
  const memory = cell => cell.memory_bytes ?? {};
  makeTable("costs-table", [
    {label: "Series", value: row => row.series},
    {label: "Steps", number: true, value: row => row.steps, show: value => String(value)},
    number("Training step", "ms, with its paths", cell => cell.train_ms_per_step),
    number("Kernels of a step", "ms", cell => cell.train_step_ms),
    number(kAnswers, "ms", cell => cell.query_ms_per_2m),
    bytes("Parameters", cell => memory(cell).parameters),
    bytes("Optimizer", cell => memory(cell).optimizer),
    bytes("Layout", cell => memory(cell).layout),
    bytes("Memory", totalMemory),
  ], rows);
  at("costs-note").textContent = "At the most steps of each series; ± is the standard deviation over seeds.";
}

function totalMemory(cell) {
  const parts = Object.values(cell.memory_bytes ?? {}).filter(isNumber);
  return parts.length > 0 ? parts.reduce((sum, x) => sum + x, 0) : null;
}

function rowWords(cell) {
  return [cell.series, pointName(cell), `seed ${cell.seed}`, ...Object.values(cell.axes ?? {})].join(" ").toLowerCase();
}

function drawCells() {
  const error = key => cell => cell.errors?.[key];
  const seconds = key => cell => cell.seconds?.[key];
  const whole = value => (isNumber(value) ? String(value) : kNone);
  const done = shownCells().filter(cell => cell.status === "done");
  const words = at("filter").value.toLowerCase().split(/\s+/).filter(Boolean);
  const rows = done.filter(cell => words.every(word => rowWords(cell).includes(word)));
  at("all").hidden = done.length === 0;
  at("filter-count").textContent = words.length > 0 ? `${rows.length} of ${done.length}` : "";
  makeTable("cells-table", [
    {label: "Series", value: cell => cell.series},
    {label: "Steps", number: true, value: cell => cell.train_steps, show: whole},
    {label: "spp", number: true, value: cell => cell.spp, show: whole},
    {label: "Seed", number: true, value: cell => cell.seed, show: whole},
    {label: "Total", unit: "s", number: true, value: seconds("total")},
    {label: "FLIP", number: true, value: error("flip")},
    {label: "HDR-FLIP", number: true, value: error("hdr_flip")},
    {label: "Rel. MSE", number: true, value: error("rel_mse")},
    {label: "Rel. MSE", unit: "less noise", number: true, value: error("rel_mse_clean")},
    {label: "Rel. RMS", unit: "less noise", number: true, value: cell => relativeErrorOf(cell)?.is},
    {label: "Rel. RMS", unit: "estimated by the render", number: true, value: cell => relativeErrorOf(cell)?.estimated},
    {label: "SSIM", number: true, value: error("ssim"), show: value => formatNumber(value, 4)},
    {label: "PSNR", unit: "dB", number: true, value: error("psnr")},
    {label: "MSE", number: true, value: error("mse")},
    {label: "Scout", unit: "s", number: true, value: seconds("scout")},
    {label: "Train", unit: "s", number: true, value: seconds("train")},
    {label: "Render", unit: "s", number: true, value: seconds("render")},
    {label: "Denoise", unit: "s", number: true, value: seconds("denoise")},
    {label: "Memory", number: true, value: totalMemory, show: formatBytes},
    {label: "Loss", number: true, value: cell => cell.loss},
    {label: "Command", fixed: true, value: cell => cell.command, show: value => copyButton(value)},
  ], rows);
}

function drawFailures() {
  const failed = sceneCells().filter(cell => cell.status === "failed");
  at("failures").hidden = failed.length === 0;
  makeTable("failures-table", [
    {label: "Configuration", value: cell => `${cell.series}, ${pointName(cell)}`},
    {label: "Seed", number: true, value: cell => cell.seed, show: value => String(value)},
    {label: "Message", value: cell => cell.error, className: "line"},
    {label: "Command", fixed: true, value: cell => cell.command, show: value => copyButton(value)},
  ], failed);
}

function describe(list, pairs) {
  list.replaceChildren(...pairs.filter(([, value]) => value).flatMap(([term, value]) =>
    [element("dt", {textContent: term}), element("dd", {}, value)]));
}

function shellWord(word) {
  return /^[\w\-+=.\/:,@%]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;
}

/// Pictures that were kept from other programs or machines are named by those; nothing where there is one.
function makersText() {
  const done = cells.filter(cell => cell.status === "done");
  const makers = groupBy(done, cell => [cell.version ? `gatelight ${cell.version}` : "", cell.cpu, cell.isa].filter(Boolean).join(", "));
  if (makers.size < 2) return "";
  return [...makers].map(([name, made]) => `${name || "unknown"}: ${plural(made.length, "picture")}`).join("; ");
}

function drawProvenance() {
  const machine = results.machine ?? {};
  const scene = scenes.find(s => s.name === state.scene) ?? {};
  const names = referenceNames(sceneCells());
  const references = (scene.references ?? []).map(r => [
    `Reference, ${names.get(keyOf(r)) ?? kKinds[r.kind] ?? r.kind}`,
    [isNumber(r.spp) ? `${r.spp} spp` : "", formatSeconds(r.seconds),
      isNumber(r.rel_mse_noise) ? `noise ${formatNumber(r.rel_mse_noise)} (relative MSE)` : "", r.file]
      .filter(text => text && text !== kNone).join(", "),
  ]);
  describe(at("provenance"), [
    ["Scene", [scene.name, scene.file].filter(Boolean).join(": ")],
    ...references,
    ["Machine", [machine.cpu, isNumber(machine.threads) ? plural(machine.threads, "thread") : "", machine.isa].filter(Boolean).join(", ")],
    ["Versions", Object.entries(results.versions ?? {gatelight: results.version}).filter(([, version]) => typeof version === "string")
      .map(([name, version]) => `${name} ${version}`).join(", ")],
    ["Measured by", makersText()],
    ["Command", element("code", {textContent: (results.command ?? []).map(shellWord).join(" ")})],
  ]);
  const options = sceneCells().filter(cell => cell.status === "done").map(cell => cell.options ?? {});
  const same = Object.entries(options[0] ?? {}).filter(([key, value]) =>
    options.every(other => JSON.stringify(other[key]) === JSON.stringify(value)));
  at("common").hidden = same.length === 0;
  describe(at("common-options"), same.map(([key, value]) => [key, typeof value === "string" ? value : JSON.stringify(value)]));
}
