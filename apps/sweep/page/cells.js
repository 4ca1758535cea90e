"use strict";
// From cells to what is drawn: configurations (the seeds of one picture together), series, fronts.

const kMetrics = [
  {key: "flip", label: "FLIP", of: errors => errors.flip,
    means: "how different two pictures look to somebody who flips between them; 0 is no difference, 1 the greatest"},
  {key: "hdr_flip", label: "HDR-FLIP", of: errors => errors.hdr_flip, means: "FLIP over all exposures that show something, for each pixel the largest"},
  {key: "rel_mse", label: "relative MSE", of: errors => errors.rel_mse,
    means: "mean squared difference of radiance, where dark pixels count as much as bright ones"},
  {key: "rel_mse_clean", label: "relative MSE, less the reference's noise", of: errors => errors.rel_mse_clean,
    means: "the same without what the reference's own noise adds"},
  {key: "ssim", label: "1 − SSIM", of: errors => (isNumber(errors.ssim) ? 1 - errors.ssim : null),
    means: "how little of the structure is kept; 0 is all of it"},
  {key: "mse", label: "MSE", of: errors => errors.mse, means: "mean squared difference of radiance: bright pixels decide it"},
];

const kKinds = {path: "path tracing", ao: "ambient occlusion", cache: "what the cache should store"};

function errorOf(cell, metric) {
  const value = metric.of(cell.errors ?? {});
  return isNumber(value) ? value : null;
}

function secondsOf(cell) {
  const value = cell.seconds?.total;
  return isNumber(value) ? value : null;
}

/// Errors against different references are different things. Older results name only the kind.
function referenceOf(cell) {
  return cell.reference_id ?? cell.reference ?? "path";
}

/// Key of an entry of a scene's "references", as cells name it.
function keyOf(reference) {
  return reference.id ?? reference.kind;
}

/// Names of groups: the values that all cells of a group share and not all groups have; axes, else options.
function differencesOf(groups) {
  for (const of of [cell => cell.axes ?? {}, cell => cell.options ?? {}]) {
    const text = (cell, name) => (of(cell)[name] === undefined ? undefined : String(of(cell)[name]));
    const names = [...new Set(groups.flat().flatMap(cell => Object.keys(of(cell))))].filter(name =>
      groups.every(group => group.every(cell => text(cell, name) !== undefined && text(cell, name) === text(group[0], name))) &&
      groups.some(group => text(group[0], name) !== text(groups[0][0], name)));
    const word = (cell, name) => (name === "row" ? text(cell, name) : `${name} ${text(cell, name)}`);
    if (names.length > 0) return groups.map(group => names.map(name => word(group[0], name)).join(", "));
  }
  return groups.map((_, i) => `#${i + 1}`);
}

/// Names of the references of a scene's cells, by referenceOf(). Several of a kind are distinguished by the values in
/// which their cells differ.
function referenceNames(cells) {
  const names = new Map();
  for (const cell of cells) names.set(referenceOf(cell), "");
  for (const [kind, ofKind] of groupBy(cells, cell => cell.reference ?? "path")) {
    const groups = groupBy(ofKind, referenceOf);
    const differences = groups.size > 1 ? differencesOf([...groups.values()]) : [""];
    [...groups.keys()].forEach((key, i) => names.set(key, [kKinds[kind] ?? kind, differences[i]].filter(Boolean).join(", ")));
  }
  return names;
}

function isPlain(cell) {
  return !isNumber(cell.train_steps);
}

/// Whether its samples were fitted to normals and depth; otherwise it is their mean.
function isDenoised(cell) {
  return !["none", undefined].includes(cell.options?.denoiser);
}

/// The ways to a picture, in the order of what they add.
const kWays = [
  {name: "path tracing, as traced", plain: true, denoised: false},
  {name: "path tracing, denoised", plain: true, denoised: true},
  {name: "with the cache, as traced", plain: false, denoised: false},
  {name: "with the cache, denoised", plain: false, denoised: true},
];

function wayOf(cell) {
  return kWays.find(way => way.plain === isPlain(cell) && way.denoised === isDenoised(cell));
}

/// Relative root mean square, the measure of the estimated error: {is, estimated}. null where nothing was estimated.
function relativeErrorOf(cell) {
  if (!isNumber(cell.estimated_error)) return null;
  const square = cell.errors?.rel_mse_clean ?? cell.errors?.rel_mse;
  return {is: isNumber(square) ? Math.sqrt(Math.max(0, square)) : null, estimated: cell.estimated_error};
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

/// Standard deviation of the sample; null for fewer than two values.
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
      way: wayOf(group[0]),
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

/// The configurations that no other beats in both time and error, by time.
function frontOf(configurations) {
  const front = [];
  for (const c of [...configurations].sort((a, b) => a.seconds - b.seconds || a.error - b.error)) {
    if (front.length === 0 || c.error < front[front.length - 1].error) front.push(c);
  }
  return front;
}

/// The advice of `gatelight sweep --advise` for these: the quickest of which no seed was above the error, or without an error
/// the most accurate within the seconds. Where none meets the limits, the one that comes nearest. null: no limit.
function adviceOf(configurations, {error, seconds}) {
  const worse = error === null ? "error" : "high";
  const least = (list, ...keys) => [...list].sort((a, b) => keys.reduce((order, key) => order || a[key] - b[key], 0))[0];
  const fast = configurations.filter(c => seconds === null || c.seconds <= seconds);
  const chosen = fast.filter(c => error === null || c.high <= error);
  if (chosen.length > 0) {
    return {best: error === null ? least(chosen, worse, "seconds") : least(chosen, "seconds", worse), met: true};
  }
  return {best: fast.length > 0 ? least(fast, worse, "seconds") : least(configurations, "seconds", worse), met: false};
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
