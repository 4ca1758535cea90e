"use strict";
// Numbers for people.

const kNone = "–";

function isNumber(x) {
  return typeof x === "number" && Number.isFinite(x);
}

/// Three digits: 0.00123, 0.123, 12.3, 1234; far from one as 1.23e-5.
function formatNumber(x, digits = 3) {
  if (!isNumber(x)) return kNone;
  const size = Math.abs(x);
  if (size === 0) return "0";
  if (size < 1e-3 || size >= 1e6) return x.toExponential(digits - 1).replace("e+", "e").replaceAll("-", "−");
  const text = Number(size.toPrecision(digits)) >= 10 ** digits ? x.toFixed(0) : x.toPrecision(digits);
  return text.replace("-", "−");
}

/// The unit stays with its number.
function formatSeconds(x) {
  return isNumber(x) ? `${formatNumber(x)}\u00a0s` : kNone;
}

function formatBytes(bytes) {
  if (!isNumber(bytes)) return kNone;
  const units = ["B", "KiB", "MiB", "GiB", "TiB"];
  let unit = 0;
  let value = bytes;
  while (value >= 999.5 && unit + 1 < units.length) {
    value /= 1024;
    ++unit;
  }
  return `${unit === 0 ? value : value.toPrecision(3)} ${units[unit]}`;
}

/// Ticks of a logarithmic axis: powers of ten have no digits that are not needed.
function formatTick(x) {
  const power = Math.log10(x);
  const short = Number(x.toPrecision(6));
  return power < -3.01 || power >= 6 ? short.toExponential().replace("e+", "e").replace("-", "−") : String(short);
}

function plural(count, word) {
  return `${count} ${word}${count === 1 || word.endsWith("s") ? "" : "s"}`;
}
