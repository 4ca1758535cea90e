"use strict";
// The charts of the page, their legend and the table of the front.

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
  at("time-caption").textContent = "Against seconds of scouting, set-up, training and rendering; both axes logarithmic." + seedsNote(all) +
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

function drawParetoChart(series, all, shown) {
  const fronts = [true, false].map(plain => ({
    points: frontOf(shown.filter(c => c.plain === plain)),
    color: cssColor(plain ? "--plain" : "--ink"),
    dash: plain ? [6, 4] : [],
    width: 1.5,
  }));
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
    extras: {fronts},
    description: `${state.metric.label} against seconds of ${plural(shown.length, "configuration")}, with the Pareto front of those with and without a cache`,
  });
  const both = fronts.every(front => front.points.length > 0);
  at("pareto-caption").textContent = `${plural(shown.length, "configuration")}, each the mean of its seeds. ` +
    (both ? "Solid: the front of those with a cache; dashed: of those without." : "The line is their front.") +
    " Large points lie on a front: no other is both quicker and more accurate.";
}

function drawFrontTable(shown) {
  const rivals = frontOf(shown.filter(c => c.plain));
  const rows = frontOf(shown).map(c => ({...c, rival: c.plain ? null : secondsAtError(rivals, c.error)}));
  const sign = rival => (rival.above ? "> " : rival.below ? "< " : "");
  const columns = [
    {label: "Configuration", value: c => `${c.series}, ${c.point}`},
    {label: "Time", unit: "s", number: true, value: c => c.seconds},
    {label: state.metric.label, number: true, value: c => c.error},
    {label: "Without a cache", unit: "s, for the same error", number: true, value: c => c.rival?.seconds,
      show: (value, c) => (c.rival ? sign(c.rival) + formatNumber(value) : kNone)},
    {label: "Times faster", number: true, value: c => (c.rival ? c.rival.seconds / c.seconds : null),
      show: (value, c) => (c.rival ? sign(c.rival) + formatNumber(value, 2) : kNone)},
    {label: "Command", fixed: true, value: c => c.cells[0].command, show: value => copyButton(value)},
  ];
  makeTable("front-table", columns, rows);
  const compared = rows.some(c => c.rival);
  at("front-note").hidden = !compared;
  at("front-note").textContent = "Seconds without a cache are read off the dashed front, by power laws between its points; < and > where it ends.";
}

function drawCharts() {
  const {shown: all, leftOut} = configurationsOf(shownCells(), state.metric);
  const some = all.length > 0;
  at("nothing").hidden = some;
  at("convergence").hidden = at("pareto").hidden = !some;
  if (!some) return;
  const everySeries = seriesOf(all);
  const series = everySeries.filter(s => !state.hidden.has(s.name));
  const shown = series.flatMap(s => s.points);
  drawLegend(everySeries);
  // Axes fit what is shown; with nothing shown they stay.
  const ranges = shown.length > 0 ? shown : all;
  drawTimeChart(series, ranges);
  drawStepsChart(series, ranges);
  drawParetoChart(series, ranges, shown);
  if (leftOut > 0) at("time-caption").textContent += ` Not shown: ${plural(leftOut, "configuration")} with an error of zero or below.`;
  drawFrontTable(shown);
}
