"use strict";
// Pictures that took about the same time, one of each way, and their reference: the same part of each, pixel by pixel.

/// `chosen` and, of each other way, the picture nearest in time; both compared with the same and shown likewise.
function sameTime(pictures, chosen) {
  const ratio = p => Math.abs(Math.log(secondsOf(p.cell) / secondsOf(chosen.cell)));
  const comparable = pictures.filter(p => p.cell && p.reference === chosen.reference && secondsOf(p.cell) > 0 && sameDisplay(p.display, chosen.display));
  return kWays.map(way => (wayOf(chosen.cell) === way ? chosen
    : comparable.filter(p => wayOf(p.cell) === way).sort((a, b) => ratio(a) - ratio(b))[0])).filter(Boolean);
}

/// The pictures whose time can be chosen: those of the last way that has any, by time.
function anchorsOf(pictures, reference) {
  const made = pictures.filter(p => p.cell && p.reference === reference && secondsOf(p.cell) > 0);
  const last = [...kWays].reverse().find(way => made.some(p => wayOf(p.cell) === way));
  return made.filter(p => wayOf(p.cell) === last).sort((a, b) => secondsOf(a.cell) - secondsOf(b.cell));
}

function stripFigure(title, picture) {
  const image = element("img", {src: uriOf(picture.entry), alt: picture.name, draggable: false});
  const look = picture.cell ? [" ", lookButton({cells: [picture.cell], series: picture.group, point: pointName(picture.cell)})] : [];
  return element("figure", {}, image, element("figcaption", {}, element("strong", {textContent: title}),
    element("span", {textContent: [picture.cell ? picture.name : "", picture.detail].filter(Boolean).join(", ")}), ...look));
}

function showStrip(pictures, chosen) {
  const shown = sameTime(pictures, chosen);
  const reference = referencePictureOf(pictures, chosen);
  at("strip").replaceChildren(...shown.map(p => stripFigure(wayOf(p.cell).name, p)),
    ...(reference ? [stripFigure("reference", reference)] : []));
}

/// Hidden where all pictures were made in one way.
function drawStrip(pictures) {
  const anchors = anchorsOf(pictures, state.reference);
  const some = anchors.length > 0 && sameTime(pictures, anchors[0]).length > 1;
  at("strip-section").hidden = !some;
  if (!some) return;
  const middle = anchors[Math.floor(anchors.length / 2)];
  at("strip-time").replaceChildren(...anchors.map(p => element("option", {
    value: p.id, textContent: `${formatSeconds(secondsOf(p.cell))}: ${p.name}`, selected: p === middle,
  })));
  at("strip-time").onchange = () => showStrip(pictures, anchors.find(p => p.id === at("strip-time").value));
  showStrip(pictures, middle);
}

/// All show the part under the mouse, or that was tapped.
function listenToStrip() {
  const strip = at("strip");
  const follow = event => {
    if (event.target.tagName !== "IMG") return;
    const box = event.target.getBoundingClientRect();
    strip.style.setProperty("--x", `${100 * (event.clientX - box.left) / box.width}%`);
    strip.style.setProperty("--y", `${100 * (event.clientY - box.top) / box.height}%`);
  };
  strip.addEventListener("pointermove", follow);
  strip.addEventListener("pointerdown", follow);
}
