"use strict";
// How far the picture is, and what is under the pointer.

const bytes = count => count < 1e6 ? `${(count / 1024).toFixed(0)} KiB` : `${(count / 1048576).toFixed(1)} MiB`;
const short = x => x === null ? "-" : Math.abs(x) >= 1e4 || (x !== 0 && Math.abs(x) < 1e-3) ? x.toExponential(2) : Number(x.toPrecision(4)).toString();

function describeState(status, shown) {
  if (status.error) return `No picture: ${status.error}`;
  if (status.complete && !shown?.spp) return "A finished picture";
  if (status.complete) return `Finished: ${shown ? shown.spp : "?"} samples per pixel, after ${shown ? shown.seconds.toFixed(1) : "?"} s`;
  if (status.waits) return "Waiting for another tab";
  const what = {draft: "Draft", preview: "Preview", refined: "Preview with more samples", final: "Final picture"}[status.stage] || "Waiting";
  const how = {
    scout: "finding surfaces for the cache",
    train: `training the cache, step ${status.steps} of ${status.all_steps}, loss ${short(status.loss)}`,
    render: `${status.samples.toFixed(1)} of ${status.spp} samples per pixel`,
    denoise: "denoising",
  }[status.phase];
  return `${what}: ${how}`;
}

function describeReadings(status, shown) {
  const last = status.last || {}, rows = [];
  if (shown) rows.push(["Shown", `${shown.stage}, ${shown.width} x ${shown.height}`], ["After the change", `${shown.seconds.toFixed(2)} s`]);
  if (last.estimated_error) rows.push(["Estimated error", `${(100 * last.estimated_error).toFixed(1)} %`]);
  if (last.samples_per_second) rows.push(["Samples per second", `${(last.samples_per_second / 1e6).toFixed(2)} million`]);
  if (last.training_steps) rows.push(["Training steps", String(last.training_steps)], ["Loss", short(last.loss)]);
  if (last.cache_bytes) rows.push(["Cache", bytes(last.cache_bytes)]);
  if (last.scene_bytes) rows.push(["Scene", bytes(last.scene_bytes)]);
  return rows;
}

async function watchStatus() {
  for (;;) {
    try {
      const status = await (await ask("status")).json();
      document.getElementById("state").textContent = describeState(status, picture.shown);
      document.getElementById("done").style.width = `${100 * (status.complete ? 1 : status.fraction)}%`;
      document.getElementById("command").textContent = status.command;
      document.getElementById("readings").replaceChildren(
        ...describeReadings(status, picture.shown).flatMap(([name, value]) => [element("dt", {textContent: name}), element("dd", {textContent: value})]));
      if (status.error) showError(status.error);
    } catch {
      // watch() of the pictures says that the program is gone.
    }
    await pause(document.hidden ? 5000 : 400);
  }
}

const pointer = {
  place: null, busy: false,

  async read() {
    if (this.busy || !this.place) return;
    this.busy = true;
    try {
      const pixel = await (await ask("pixel", this.place)).json();
      if (!pixel.layers) return;
      const lines = [`${pixel.x}, ${pixel.y}${pixel.object ? `  ${pixel.object}` : ""}`];
      for (const [name, values] of Object.entries(pixel.layers)) lines.push(`${name}: ${values.map(short).join(", ")}`);
      document.getElementById("pixel").textContent = lines.join("\n");
    } catch {
      // watch() of the pictures says that the program is gone.
    } finally {
      await pause(60);
      this.busy = false;
    }
  },
};
