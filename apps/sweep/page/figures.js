"use strict";
// The charts of the page and their legend, and what is read off them: the advice and the table of the front.

function swatch(style) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("width", 30);
  svg.setAttribute("height", 14);
  svg.setAttribute("aria-hidden", "true");
  const color = `var(${style.variable})`;
  const shapes = {
    circle: `<circle cx="15" cy="7" r="4"/>`,
    rect: `<rect x="11" y="3" width="8" height="8"/>`,
    triangle: `<path d="M15 2l5 9h-10z"/>`,
    rectRot: `<path d="M15 2l5 5-5 5-5-5z"/>`,
    crossRot: `<path d="M11 3l8 8m0-8l-8 8" stroke="${color}" stroke-width="2"/>`,
  };
  svg.innerHTML = `<path d="M0 7h30" stroke="${color}" stroke-width="2" stroke-dasharray="${style.dash.join(" ")}"/>` +
    `<g fill="${color}">${shapes[style.marker]}</g>`;
  return svg;
}

function drawLegend(series) {
  const focused = document.activeElement?.dataset?.series;
  const buttons = series.map(({name}) => {
    const button = element("button", {type: "button"}, swatch(styles.get(name)), name);
    button.dataset.series = name;
    button.setAttribute("aria-pressed", !state.hidden.has(name));
    button.addEventListener("click", () => {
      if (!state.hidden.delete(name)) state.hidden.add(name);
      drawCharts();
    });
    return button;
  });
  if (series.length > 4) {
    const any = series.some(({name}) => !state.hidden.has(name));
    const every = element("button", {type: "button", className: "every", textContent: any ? "hide all" : "show all"});
    every.dataset.series = "\0every";
    every.addEventListener("click", () => {
      for (const {name} of series) any ? state.hidden.add(name) : state.hidden.delete(name);
      drawCharts();
    });
    buttons.push(every);
  }
  at("legend").replaceChildren(...buttons);
  if (focused) buttons.find(button => button.dataset.series === focused)?.focus();
}

const kWords = {
  path: "path tracing without a cache",
  ao: "ambient occlusion without a cache",
  nrc: "path tracing whose paths end in a neural cache, which learned from some of them first",
  nao: "ambient occlusion out of a neural cache",
  gate: "the cache keeps what it learned on the triangles of the scene",
  hashgrid: "the cache keeps what it learned in a table over space",
  bare: "--preset bare: the cache answers at the first surface that is no mirror",
  standard: "--preset standard: paths go on until they have spread out and query the cache there, and the picture is denoised",
  denoised: "Open Image Denoise takes the noise out, guided by albedo and normals",
};

function drawWords() {
  const used = new Set(shownCells().flatMap(cell => [cell.integrator, cell.encoding, cell.axes?.row, isDenoised(cell) ? "denoised" : null]));
  const plain = shownCells().some(isPlain);
  const trained = shownCells().some(cell => !isPlain(cell));
  describe(at("word-list"), [
    ...Object.entries(kWords).filter(([word]) => used.has(word)),
    ["steps", trained ? "training steps of the cache" : ""],
    ["spp", plain ? "samples per pixel" : ""],
    ...availableMetrics().map(metric => [metric.label, metric.means]),
  ]);
}

function errorsIn(configurations) {
  return configurations.flatMap(c => [c.low, c.high]);
}

function seedsNote(configurations) {
  const most = Math.max(...configurations.map(c => c.cells.length));
  return most > 1 ? ` Lines are means of ${most} seeds, bands reach from the least to the greatest.` : " One seed.";
}

function drawTimeChart(series, all) {
  const seconds = c => c.seconds;
  drawChart("time-chart", {
    title: "seconds",
    metric: state.metric,
    xs: all.map(seconds),
    ys: errorsIn(all),
    datasets: series.map(s => dataset(s, styles.get(s.name), seconds, true)),
    extras: {bands: series.flatMap(s => bandsOf(s, styles.get(s.name), seconds))},
    description: `${state.metric.label} against seconds of ${plural(series.length, "series")}; the table of all pictures has the numbers`,
  });
  at("time-caption").textContent = "Against seconds of scouting, set-up, training, rendering and denoising; both axes logarithmic." + seedsNote(all) +
    (all.some(c => c.plain) ? " Grey and dashed: without a cache." : "");
}

function drawStepsChart(series, all) {
  const trained = all.filter(c => !c.plain);
  at("steps-figure").hidden = trained.length === 0;
  at("steps-figure").parentElement.classList.toggle("alone", trained.length === 0);
  if (trained.length === 0) return;
  const steps = c => c.at;
  const distinct = [...new Set(trained.map(steps))].sort((a, b) => a - b);
  const roomy = distinct.length <= 12 && distinct.every((x, i) => i === 0 || x >= 1.4 * distinct[i - 1]);
  const learning = series.filter(s => !s.plain);
  const levels = series.filter(s => s.plain).flatMap(s => s.points.map(c => ({
    error: c.error,
    label: `${s.name}, ${c.point}, ${formatSeconds(c.seconds)}`,
    color: cssColor("--plain"),
    dash: styles.get(s.name).dash,
  })));
  drawChart("steps-chart", {
    title: "training steps",
    metric: state.metric,
    xs: distinct,
    ys: errorsIn(all),
    ticks: roomy ? distinct : undefined,
    datasets: learning.map(s => dataset(s, styles.get(s.name), steps, true)),
    extras: {bands: learning.flatMap(s => bandsOf(s, styles.get(s.name), steps)), levels},
    description: `${state.metric.label} against training steps of ${plural(learning.length, "series")}; the table of all pictures has the numbers`,
  });
  at("steps-caption").textContent = "Against training steps." +
    (levels.length > 0 ? " Dashed levels: without a cache, with samples a pixel and seconds." : "");
}

function drawParetoChart(series, all, shown, limits) {
  const kinds = [
    {name: "dashed: of those without", of: c => c.plain && !c.way.denoised, color: "--plain", dash: [6, 4]},
    {name: "dotted: of those denoised without", of: c => c.plain && c.way.denoised, color: "--plain", dash: [2, 3]},
    {name: "solid: the front of those with a cache", of: c => !c.plain, color: "--ink", dash: []},
  ];
  const fronts = kinds.map(kind => ({
    name: kind.name,
    points: frontOf(shown.filter(kind.of)),
    color: cssColor(kind.color),
    dash: kind.dash,
    width: 1.5,
  })).filter(front => front.points.length > 0);
  const onFront = new Set(fronts.flatMap(front => front.points));
  const scatter = series.map(s => ({
    ...dataset(s, styles.get(s.name), c => c.seconds, false),
    pointRadius: s.points.map(c => (onFront.has(c) ? 6 : 3)),
  }));
  drawChart("pareto-chart", {
    title: "seconds",
    metric: state.metric,
    xs: all.map(c => c.seconds),
    ys: errorsIn(all),
    datasets: scatter,
    extras: {fronts, limits: {...limits, color: cssColor("--accent")}},
    description: `${state.metric.label} against seconds of ${plural(shown.length, "configuration")}, with the Pareto front of those with and without a cache`,
  });
  const several = fronts.length > 1;
  const names = [...fronts].reverse().map(front => front.name).join("; ");
  at("pareto-caption").textContent = `${plural(shown.length, "configuration")}, each the mean of its seeds. ` +
    (several ? `${names[0].toUpperCase()}${names.slice(1)}.` : "The line is their front.") +
    ` Large points lie on a front: no other${several ? " of its kind" : ""} is both quicker and more accurate.` +
    (limits.chosen ? " The ring is around the one to take." : "");
}

/// The seconds that the fronts without a cache take to the same error: {traced, denoised}. Each is null where there is no such
/// front, or where the configuration belongs to it or has less than it.
function rivalsOf(configuration, shown) {
  const seconds = denoised => {
    const [way, own] = [kWays.find(w => w.plain && w.denoised === denoised), configuration.way];
    if (kWays.indexOf(own) <= kWays.indexOf(way)) return null;
    return secondsAtError(frontOf(shown.filter(c => c.way === way)), configuration.error);
  };
  return {traced: seconds(false), denoised: seconds(true)};
}

/// "22.6 s", or "22.6 s as traced and 9.1 s denoised".
function rivalsText({traced, denoised}) {
  const text = rival => `${sign(rival)}${formatSeconds(rival.seconds)}`;
  if (!traced && !denoised) return "";
  if (traced && denoised) return `${text(traced)} as traced and ${text(denoised)} denoised`;
  return text(traced ?? denoised);
}

function sign(rival) {
  return rival.above ? "> " : rival.below ? "< " : "";
}

/// A limit to begin with, in two digits: the error in the middle of the front.
function suggestedError(shown) {
  const front = frontOf(shown);
  if (front.length === 0) return "";
  const error = front[Math.floor(front.length / 2)].high;
  const step = 10 ** (Math.floor(Math.log10(error)) - 1);
  return String(Number((Math.ceil(error / step) * step).toPrecision(2)));
}

function limitOf(text) {
  const value = Number(text);
  return value > 0 && Number.isFinite(value) ? value : null;
}

/// Fills the form with what was typed for this error, or a limit to begin with, and answers it: {error, seconds, chosen}.
function drawAdvice(shown) {
  const typed = state.limits.errors.get(state.metric.key) ?? suggestedError(shown);
  if (at("max-error").value !== typed) at("max-error").value = typed;
  at("max-error-label").textContent = `${state.metric.label} at most`;
  const limits = {error: limitOf(typed), seconds: limitOf(state.limits.seconds)};
  at("advice-answer").hidden = shown.length === 0;
  if (shown.length === 0 || (limits.error === null && limits.seconds === null)) {
    at("advice-answer").replaceChildren(shown.length === 0 ? "" : "Give an error, a time or both.");
    at("advice-command").hidden = at("advice-note").hidden = true;
    return {...limits, chosen: null};
  }
  const {best, met} = adviceOf(shown, limits);
  const seeds = best.cells.length;
  const rivals = rivalsText(rivalsOf(best, shown));
  at("advice-answer").replaceChildren(
    met ? "" : `None of ${plural(shown.length, "configuration")} keeps that. The nearest: `,
    element("strong", {textContent: `${best.series}, ${best.point}`}),
    `: ${formatSeconds(best.seconds)}, ${state.metric.label} ${formatNumber(best.error)}` +
      (seeds > 1 ? ` (${formatNumber(best.low)} to ${formatNumber(best.high)} over ${plural(seeds, "seed")})` : "") +
      (rivals ? `. ${best.plain ? "As traced" : "Without a cache"} the same error takes ${rivals}.` : "."),
  );
  const command = best.cells[0].command;
  at("advice-command").hidden = false;
  at("advice-command").replaceChildren(...(command ? [element("code", {textContent: command})] : []),
    element("span", {className: "buttons"}, ...(command ? [copyButton(command, {show: false})] : []),
      ...(pictureOf(best) ? [lookButton(best)] : [])));
  at("advice-note").hidden = false;
  const why = limits.error === null ? "The most accurate within the time" : "The quickest of which no seed was above the error";
  at("advice-note").textContent = (met ? `${why}, of ${plural(shown.length, "configuration")}. ` : "") +
    "Times are without loading the scene and building.";
  return {...limits, chosen: best};
}

function drawFrontTable(shown) {
  const rows = frontOf(shown).map(c => ({...c, rivals: rivalsOf(c, shown)}));
  const rivalColumns = (key, label) => [
    {label, unit: "s, for the same error", number: true, value: c => c.rivals[key]?.seconds,
      show: (value, c) => (c.rivals[key] ? sign(c.rivals[key]) + formatNumber(value) : kNone)},
    {label: "Times faster", unit: `than ${label.toLowerCase()}`, number: true,
      value: c => (c.rivals[key] ? c.rivals[key].seconds / c.seconds : null),
      show: (value, c) => (c.rivals[key] ? sign(c.rivals[key]) + formatNumber(value, 2) : kNone)},
  ];
  const columns = [
    {label: "Configuration", value: c => `${c.series}, ${c.point}`},
    {label: "Time", unit: "s", number: true, value: c => c.seconds},
    {label: state.metric.label, number: true, value: c => c.error},
    ...rivalColumns("traced", "Without a cache"),
    ...rivalColumns("denoised", "Without, denoised"),
    {label: "Command", fixed: true, value: c => c.cells[0].command, show: value => copyButton(value)},
  ];
  if (rows.some(pictureOf)) columns.push({label: "Picture", fixed: true, value: c => c, show: lookButton});
  makeTable("front-table", columns, rows);
  const compared = rows.some(c => rivalsText(c.rivals));
  at("front-note").hidden = !compared;
  at("front-note").textContent = "Seconds without a cache are read off their fronts, by power laws between the points; < and > where a front ends.";
}

function drawCharts() {
  const {shown: all, leftOut} = configurationsOf(shownCells(), state.metric);
  const some = all.length > 0;
  at("nothing").hidden = some;
  at("advice").hidden = at("convergence").hidden = at("pareto").hidden = !some;
  if (!some) return;
  const everySeries = seriesOf(all);
  const series = everySeries.filter(s => !state.hidden.has(s.name));
  const shown = series.flatMap(s => s.points);
  drawLegend(everySeries);
  // Axes fit what is shown; with nothing shown they stay.
  const ranges = shown.length > 0 ? shown : all;
  drawTimeChart(series, ranges);
  drawStepsChart(series, ranges);
  drawParetoChart(series, ranges, shown, drawAdvice(shown));
  if (leftOut > 0) at("time-caption").textContent += ` Not shown: ${plural(leftOut, "configuration")} with an error of zero or below.`;
  drawFrontTable(shown);
}
