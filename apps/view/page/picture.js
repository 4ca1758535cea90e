"use strict";
// The pictures that come, the one that is kept beside them, and the place of a point in them.

const picture = {
  canvas: document.getElementById("picture"), kept: document.getElementById("kept"), wipe: document.getElementById("wipe"),
  shown: null, layer: "", version: 0, share: 0.5, request: new AbortController(),

  /** Waits for pictures, one after the other. */
  async watch() {
    document.addEventListener("visibilitychange", () => { if (document.hidden) this.request.abort(); });
    for (;;) {
      await visible();
      const {signal} = this.request = new AbortController();
      try {
        const response = await ask("picture", {after: this.version, layer: this.layer}, {signal});
        showLost(null);
        if (response.status === 204) continue;
        const description = JSON.parse(response.headers.get("X-Picture"));
        this.show(await createImageBitmap(await response.blob()), description);
      } catch (error) {
        if (signal.aborted) continue;
        showLost(error);
        this.version = 0;
        await pause(1000);
      }
    }
  },

  show(bitmap, description) {
    this.version = description.version;
    this.shown = description;
    if (this.canvas.width !== bitmap.width || this.canvas.height !== bitmap.height)
      Object.assign(this.canvas, {width: bitmap.width, height: bitmap.height});
    this.canvas.getContext("2d").drawImage(bitmap, 0, 0);
    bitmap.close();
    document.getElementById("waiting").hidden = true;
    drawHistogram(description.histogram);
    document.dispatchEvent(new CustomEvent("picture", {detail: description}));
  },

  /** Asks for another layer of the present picture, too. */
  setLayer(name) {
    this.layer = name;
    this.version = 0;
    this.request.abort();
    changes.send({}, name || "none");
  },

  keep() {
    Object.assign(this.kept, {width: this.canvas.width, height: this.canvas.height});
    this.kept.getContext("2d").drawImage(this.canvas, 0, 0);
    this.setWipe(this.share);
  },

  /** The kept picture is left of this share of the width. */
  setWipe(share) {
    this.share = share;
    this.kept.hidden = this.wipe.hidden = this.kept.width === 0;
    const box = this.box(), frame = this.canvas.getBoundingClientRect();
    const left = box.left - frame.left + share * box.width;
    this.kept.style.clipPath = `inset(0 ${frame.width - left}px 0 0)`;
    this.wipe.style.left = `${left}px`;
  },

  drop() {
    this.kept.hidden = this.wipe.hidden = true;
    this.kept.width = 0;
  },

  /** Where the picture lies in the window: the canvas is as large as its frame, with margins. */
  box() {
    const frame = this.canvas.getBoundingClientRect();
    const scale = Math.min(frame.width / this.canvas.width, frame.height / this.canvas.height);
    const width = scale * this.canvas.width, height = scale * this.canvas.height;
    return {left: frame.left + (frame.width - width) / 2, top: frame.top + (frame.height - height) / 2, width, height};
  },

  /** The place of a pointer in the picture, 0 to 1 from its top left corner; null outside. */
  place(event) {
    const box = this.box();
    const x = (event.clientX - box.left) / box.width, y = (event.clientY - box.top) / box.height;
    return x >= 0 && x <= 1 && y >= 0 && y <= 1 ? {x, y} : null;
  },
};

function drawHistogram(counts) {
  const canvas = document.getElementById("histogram"), context = canvas.getContext("2d");
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.globalCompositeOperation = "lighter";
  const bins = counts.length / 3;
  // The ends hold what is black or clipped, and would flatten the rest.
  const most = Math.max(1, ...counts.filter((_, i) => i % bins > 0 && i % bins < bins - 1));
  ["#d33", "#3b3", "#46f"].forEach((color, channel) => {
    context.fillStyle = color;
    for (let i = 0; i < bins; ++i) {
      const height = Math.min(1, Math.sqrt(counts[channel * bins + i] / most)) * canvas.height;
      context.fillRect(i * canvas.width / bins, canvas.height - height, canvas.width / bins, height);
    }
  });
  context.globalCompositeOperation = "source-over";
}
