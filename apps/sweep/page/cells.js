"use strict";
// From cells to what is drawn: configurations (the seeds of one picture together), series, fronts.

const kMetrics = [
  {key: "flip", label: "FLIP", of: errors => errors.flip},
  {key: "hdr_flip", label: "HDR-FLIP", of: errors => errors.hdr_flip},
  {key: "rel_mse", label: "relative MSE", of: errors => errors.rel_mse},
  {key: "rel_mse_clean", label: "relative MSE, less the reference's noise", of: errors => errors.rel_mse_clean},
  {key: "ssim", label: "1 − SSIM", of: errors => (isNumber(errors.ssim) ? 1 - errors.ssim : null)},
  {key: "mse", label: "MSE", of: errors => errors.mse},
];

const kKinds = {path: "path tracing", ao: "ambient occlusion", cache: "what the cache is to hold"};

function errorOf(cell, metric) {
  const value = metric.of(cell.errors ?? {});
  return isNumber(value) ? value : null;
}

function secondsOf(cell) {
  const value = cell.seconds?.total;
  return isNumber(value) ? value : null;
}

function kindOf(cell) {
  return cell.reference ?? "path";
}

function isPlain(cell) {
  return !isNumber(cell.train_steps);
}

/// "512 steps", "16 spp".
function pointName(cell) {
  if (!isPlain(cell)) return plural(cell.train_steps, "step");
  return isNumber(cell.spp) ? `${cell.spp} spp` : "";
}

function mean(values) {
  const numbers = values.filter(isNumber);
  return numbers.length === 0 ? null : numbers.reduce((sum, x) => sum + x, 0) / numbers.length;
}

/// Of the sample; null for fewer than two.
function deviation(values) {
  const numbers = values.filter(isNumber);
  if (numbers.length < 2) return null;
  const middle = mean(numbers);
  return Math.sqrt(numbers.reduce((sum, x) => sum + (x - middle) ** 2, 0) / (numbers.length - 1));
}

function groupBy(items, key) {
  const groups = new Map();
  for (const item of items) {
    const name = key(item);
    if (!groups.has(name)) groups.set(name, []);
    groups.get(name).push(item);
  }
  return groups;
}

/// Seeds of the same picture. Logarithmic axes have no place for an error of zero or below (less the reference's noise
/// that happens): such configurations are left out, as are those without error or time.
function configurationsOf(cells, metric) {
  const measured = cells.filter(cell => cell.status === "done" && errorOf(cell, metric) !== null && secondsOf(cell) > 0);
  const groups = groupBy(measured, cell => JSON.stringify([cell.series, cell.train_steps, cell.spp]));
  const all = [...groups.values()].map(group => {
    const errors = group.map(cell => errorOf(cell, metric));
    return {
      series: group[0].series,
      plain: isPlain(group[0]),
      point: pointName(group[0]),
      at: isPlain(group[0]) ? group[0].spp : group[0].train_steps,
      cells: group,
      seconds: mean(group.map(secondsOf)),
      error: mean(errors),
      low: Math.min(...errors),
      high: Math.max(...errors),
    };
  });
  return {shown: all.filter(c => c.low > 0), leftOut: all.filter(c => !(c.low > 0)).length};
}

/// In order of steps or samples.
function seriesOf(configurations) {
  return [...groupBy(configurations, c => c.series).entries()].map(([name, points]) => ({
    name,
    plain: points.every(c => c.plain),
    points: points.sort((a, b) => a.at - b.at || a.seconds - b.seconds),
  }));
}

/// Those that no other beats in both time and error, by time.
function frontOf(configurations) {
  const front = [];
  for (const c of [...configurations].sort((a, b) => a.seconds - b.seconds || a.error - b.error)) {
    if (front.length === 0 || c.error < front[front.length - 1].error) front.push(c);
  }
  return front;
}

/// Seconds that a front takes to an error, by power laws between its points. {below} or {above}: it is quicker or slower
/// than any of its points, whose seconds that is.
function secondsAtError(front, error) {
  if (front.length === 0) return null;
  const last = front[front.length - 1];
  if (error >= front[0].error) return {seconds: front[0].seconds, below: error > front[0].error};
  if (error < last.error) return {seconds: last.seconds, above: true};
  const next = front.findIndex(c => c.error <= error);
  const [a, b] = [front[next - 1], front[next]];
  const t = Math.log(a.error / error) / Math.log(a.error / b.error);
  return {seconds: a.seconds * (b.seconds / a.seconds) ** t};
}
