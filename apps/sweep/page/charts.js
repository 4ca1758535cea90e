"use strict";
// Charts with logarithmic axes, and what Chart.js does not draw: bands, levels, fronts and limits.

const kMarkers = ["circle", "rect", "triangle", "rectRot"];
const kColors = 7;

function cssColor(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/// How a series looks, here and in the legend. Those without training are grey and dashed.
function styleOf(index, plain) {
  const dashes = plain ? [[6, 4], [2, 3], [10, 3, 2, 3]] : [[], [8, 3], [3, 3]];
  const round = plain ? index : Math.floor(index / kColors);
  return {
    variable: plain ? "--plain" : `--series-${1 + (index % kColors)}`,
    marker: plain ? "crossRot" : kMarkers[index % kMarkers.length],
    dash: dashes[round % dashes.length],
  };
}

/// At most about eight, on round numbers.
function logTicks(min, max) {
  const decades = Math.log10(max / min);
  if (decades < 0.35) {
    const step = 10 ** Math.floor(Math.log10((max - min) / 2));
    const nice = [1, 2, 5, 10].map(n => n * step).find(s => (max - min) / s <= 6);
    const ticks = [];
    for (let i = Math.ceil(min / nice); i * nice <= max; ++i) ticks.push(Number((i * nice).toPrecision(12)));
    return ticks;
  }
  const digits = decades < 0.7 ? [1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8] : decades < 1 ? [1, 1.5, 2, 3, 4, 5, 7] : decades < 3.2 ? [1, 2, 5] : [1];
  const skip = Math.ceil(decades / 8);
  const ticks = [];
  for (let power = Math.floor(Math.log10(min)); power <= Math.log10(max); ++power) {
    if (digits.length === 1 && power % skip !== 0) continue;
    for (const digit of digits) {
      const value = Number(`${digit}e${power}`);
      if (value >= min && value <= max) ticks.push(value);
    }
  }
  return ticks;
}

/// Room around the values, in proportion to their span.
function logRange(values) {
  const low = Math.min(...values);
  const high = Math.max(...values);
  const room = Math.max(1.12, (high / low) ** 0.06);
  return low === high ? [low / 1.6, high * 1.6] : [low / room, high * room];
}

function logAxis(title, values, ticks) {
  const [min, max] = logRange(values);
  const at = ticks ?? logTicks(min, max);
  return {
    type: "logarithmic",
    min,
    max,
    title: {display: true, text: title, color: cssColor("--muted")},
    grid: {color: cssColor("--rule"), borderColor: cssColor("--rule")},
    ticks: {color: cssColor("--muted"), maxRotation: 0, autoSkipPadding: 10, callback: value => formatTick(value)},
    afterBuildTicks: axis => { axis.ticks = at.map(value => ({value})); },
  };
}

function clipped(chart, draw) {
  const {ctx, chartArea} = chart;
  ctx.save();
  ctx.beginPath();
  ctx.rect(chartArea.left, chartArea.top, chartArea.right - chartArea.left, chartArea.bottom - chartArea.top);
  ctx.clip();
  draw(ctx, chartArea);
  ctx.restore();
}

function drawBand(chart, ctx, band) {
  const {x, y} = chart.scales;
  const corners = [
    ...band.points.map(c => [band.x(c), c.low]),
    ...band.points.map(c => [band.x(c), c.high]).reverse(),
  ].map(([u, v]) => [x.getPixelForValue(u), y.getPixelForValue(v)]);
  ctx.beginPath();
  corners.forEach(([u, v]) => ctx.lineTo(u, v));
  ctx.closePath();
  if (band.points.length === 1) {
    // One picture has no area: a line from its best seed to its worst.
    ctx.globalAlpha = 0.6;
    ctx.strokeStyle = band.color;
    ctx.lineWidth = 2;
    ctx.stroke();
    return;
  }
  ctx.globalAlpha = 0.16;
  ctx.fillStyle = band.color;
  ctx.fill();
}

/// Labels stand on their lines at that end where the series are farther away, and give way where lines are close.
function drawLevels(chart, ctx, area, levels) {
  ctx.font = "12px system-ui, sans-serif";
  ctx.textBaseline = "bottom";
  const shown = chart.data.datasets.map(dataset => dataset.data).filter(data => data.length > 0);
  const distance = (pixel, of) => Math.min(...shown.map(data => Math.abs(chart.scales.y.getPixelForValue(of(data).y) - pixel)));
  const free = {left: Infinity, right: Infinity};
  const placed = levels.map(level => ({...level, pixel: Math.round(chart.scales.y.getPixelForValue(level.error)) + 0.5}))
    .sort((a, b) => b.pixel - a.pixel);
  for (const level of placed) {
    ctx.strokeStyle = level.color;
    ctx.fillStyle = level.color;
    ctx.lineWidth = 1;
    ctx.globalAlpha = 0.75;
    ctx.setLineDash(level.dash);
    ctx.beginPath();
    ctx.moveTo(area.left, level.pixel);
    ctx.lineTo(area.right, level.pixel);
    ctx.stroke();
    const side = distance(level.pixel, data => data[0]) > distance(level.pixel, data => data[data.length - 1]) ? "left" : "right";
    if (level.pixel > free[side] || level.pixel - area.top < 16) continue;
    ctx.globalAlpha = 1;
    ctx.textAlign = side;
    ctx.fillText(level.label, area[side] + (side === "left" ? 6 : -6), level.pixel - 2);
    free[side] = level.pixel - 16;
  }
}

/// The border of what is reached: down at each point, then right.
function drawFront(chart, ctx, area, front) {
  const {x, y} = chart.scales;
  if (front.points.length === 0) return;
  ctx.strokeStyle = front.color;
  ctx.lineWidth = front.width;
  ctx.setLineDash(front.dash);
  ctx.beginPath();
  let level = area.top;
  ctx.moveTo(x.getPixelForValue(front.points[0].seconds), level);
  for (const c of front.points) {
    const at = x.getPixelForValue(c.seconds);
    ctx.lineTo(at, level);
    level = y.getPixelForValue(c.error);
    ctx.lineTo(at, level);
  }
  ctx.lineTo(area.right, level);
  ctx.stroke();
}

/// The limits of the advice as lines, and a ring around the advised configuration.
function drawLimits(chart, ctx, area, {error, seconds, chosen, color}) {
  const {x, y} = chart.scales;
  ctx.strokeStyle = color;
  ctx.lineWidth = 1.5;
  ctx.setLineDash([2, 3]);
  ctx.beginPath();
  if (error !== null) {
    ctx.moveTo(area.left, y.getPixelForValue(error));
    ctx.lineTo(area.right, y.getPixelForValue(error));
  }
  if (seconds !== null) {
    ctx.moveTo(x.getPixelForValue(seconds), area.top);
    ctx.lineTo(x.getPixelForValue(seconds), area.bottom);
  }
  ctx.stroke();
  if (!chosen) return;
  ctx.setLineDash([]);
  ctx.lineWidth = 2;
  ctx.beginPath();
  ctx.arc(x.getPixelForValue(chosen.seconds), y.getPixelForValue(chosen.error), 11, 0, 2 * Math.PI);
  ctx.stroke();
}

const kExtras = {
  id: "extras",
  beforeDatasetsDraw(chart) {
    const extras = chart.config.options.extras;
    for (const band of extras.bands ?? []) clipped(chart, ctx => drawBand(chart, ctx, band));
    if (extras.levels) clipped(chart, (ctx, area) => drawLevels(chart, ctx, area, extras.levels));
    for (const front of extras.fronts ?? []) clipped(chart, (ctx, area) => drawFront(chart, ctx, area, front));
    if (extras.limits) clipped(chart, (ctx, area) => drawLimits(chart, ctx, area, extras.limits));
  },
};

function tooltipLines(item) {
  const c = item.raw.configuration;
  const lines = [`${c.point}, ${formatSeconds(c.seconds)}`];
  const range = c.cells.length > 1 ? ` (${formatNumber(c.low)} to ${formatNumber(c.high)}, ${c.cells.length} seeds)` : "";
  lines.push(`${item.chart.config.options.extras.metric} ${formatNumber(c.error)}${range}`);
  return lines;
}

const charts = new Map();
const kHasCharts = typeof Chart !== "undefined";

/// Replaces what the canvas showed; hides its figure where there is no Chart.js. `xs`, `ys`: values that are to fit; `ticks` of the x axis where not just any will do;
/// `extras`: bands, levels, fronts and limits.
function drawChart(id, {title, metric, xs, ys, ticks, datasets, extras, description}) {
  const canvas = at(id);
  if (!kHasCharts) {
    canvas.closest("figure").hidden = true;
    return;
  }
  charts.get(id)?.destroy();
  canvas.setAttribute("aria-label", description);
  const tooltip = {
    callbacks: {title: items => items[0].dataset.label, label: tooltipLines},
    displayColors: false,
    backgroundColor: cssColor("--ink"),
    titleColor: cssColor("--paper"),
    bodyColor: cssColor("--paper"),
  };
  charts.set(id, new Chart(canvas, {
    type: "line",
    data: {datasets},
    options: {
      animation: false,
      maintainAspectRatio: false,
      font: {family: "system-ui, sans-serif"},
      interaction: {mode: "nearest", intersect: false},
      plugins: {legend: {display: false}, tooltip},
      scales: {x: logAxis(title, xs, ticks), y: logAxis(metric.label, ys)},
      extras: {...extras, metric: metric.label},
    },
    plugins: [kExtras],
  }));
}

function dataset(series, style, x, connected) {
  const color = cssColor(style.variable);
  return {
    label: series.name,
    data: series.points.map(configuration => ({x: x(configuration), y: configuration.error, configuration})),
    showLine: connected,
    borderColor: color,
    backgroundColor: color,
    borderWidth: 2,
    borderDash: style.dash,
    pointStyle: style.marker,
    pointRadius: 4,
    pointHoverRadius: 6,
    pointBorderColor: color,
    // Crosses are nothing but border.
    pointBorderWidth: style.marker === "crossRot" ? 2 : 1,
  };
}

function bandsOf(series, style, x) {
  if (!series.points.some(c => c.cells.length > 1)) return [];
  return [{points: series.points, x, color: cssColor(style.variable)}];
}
