"use strict";
// Requests to the program.

const viewer = location.hash.slice(1) || "shared";

/** The program's answer; throws where it does not answer, or says that the request is wrong. */
async function ask(path, parameters = {}, options = {}) {
  const query = new URLSearchParams({viewer, ...parameters});
  const response = await fetch(`api/${path}?${query}`, {cache: "no-store", ...options});
  if (!response.ok) {
    let text = "";
    try {
      text = (await response.json()).error;
    } catch {
      text = "";
    }
    if (response.status === 404 && !text) text = "this address belongs to an earlier run: open the address that the program printed";
    const error = new Error(text || `the program answers with ${response.status}`);
    error.answered = true;
    throw error;
  }
  return response;
}

/** Hidden pages wait: a browser has six connections for all pages of a program. */
const visible = () => new Promise(done => {
  if (document.hidden) document.addEventListener("visibilitychange", done, {once: true});
  else done();
});

const pause = milliseconds => new Promise(done => setTimeout(done, milliseconds));

function showLost(error) {
  const lost = document.getElementById("lost");
  lost.hidden = !error;
  if (error) lost.textContent = error.answered ? error.message : "The program does not answer. It may have ended; this page tries again.";
}

function showError(text) {
  const element = document.getElementById("error");
  element.hidden = !text;
  element.textContent = text;
}

/** Changes of flags, the latest of each. Only one request is under way. */
const changes = {
  flags: {}, layer: "", waiting: false, busy: false, revision: 0,

  send(flags, layer = "") {
    Object.assign(this.flags, flags);
    if (layer) this.layer = layer;
    this.waiting = true;
    if (!this.busy) this.run();
  },

  async run() {
    this.busy = true;
    while (this.waiting) {
      const body = JSON.stringify({flags: this.flags, layer: this.layer});
      this.flags = {};
      this.layer = "";
      this.waiting = false;
      try {
        const response = await ask("change", {}, {method: "POST", body});
        this.revision = (await response.json()).revision;
        showError("");
      } catch (error) {
        if (error.answered) showError(error.message);
      }
    }
    this.busy = false;
  },
};
