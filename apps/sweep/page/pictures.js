"use strict";
// Two pictures with a border that moves, and their FLIP maps.

const stage = document.getElementById("stage");
const handle = document.getElementById("handle");

function moveBorder(percent) {
  const at = Math.min(100, Math.max(0, percent));
  stage.style.setProperty("--at", `${at}%`);
  handle.setAttribute("aria-valuenow", Math.round(at));
  handle.setAttribute("aria-valuetext", `${Math.round(at)} % of the left picture`);
}

function border() {
  return Number.parseFloat(stage.style.getPropertyValue("--at"));
}

function listenToBorder() {
  const steps = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10, Home: -100, End: 100};
  handle.addEventListener("keydown", event => {
    const step = steps[event.key];
    if (step === undefined || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    moveBorder(border() + (event.shiftKey ? 5 * step : step));
  });
  const follow = event => {
    const box = stage.getBoundingClientRect();
    moveBorder(100 * (event.clientX - box.left) / box.width);
  };
  let dragged = false;
  stage.addEventListener("pointerdown", event => {
    if (event.button !== 0) return;
    dragged = true;
    stage.setPointerCapture(event.pointerId);
    handle.focus({preventScroll: true});
    event.preventDefault();
    follow(event);
  });
  stage.addEventListener("pointermove", event => { if (dragged) follow(event); });
  for (const end of ["pointerup", "pointercancel"]) stage.addEventListener(end, () => { dragged = false; });
}

function flipText(cell) {
  return isNumber(cell.errors?.flip) ? `FLIP ${formatNumber(cell.errors.flip)}` : "";
}

/// What can be shown of a scene: {id, group, name, detail, uri, map, cell}, references first.
function picturesOf(scene, cells, uris) {
  const references = (scene.references ?? []).filter(r => uris[r.file]).map(r => ({
    id: `reference ${r.kind}`,
    group: "Reference",
    name: (scene.references.length > 1 ? `reference, ${kKinds[r.kind] ?? r.kind}` : "reference"),
    detail: isNumber(r.spp) ? `${r.spp} spp` : "",
    uri: uris[r.file],
  }));
  const made = cells.filter(cell => uris[cell.picture]).map(cell => ({
    id: cell.id,
    group: cell.series,
    name: `${cell.series}, ${pointName(cell)}`,
    detail: [secondsOf(cell) === null ? "" : formatSeconds(secondsOf(cell)), flipText(cell)].filter(Boolean).join(", "),
    uri: uris[cell.picture],
    map: uris[cell.error_map],
    cell,
  }));
  return [...references, ...made];
}

/// The most accurate picture with a cache, and the one without that took about as long; both compared with `kind`.
function defaultPair(pictures, kind) {
  const made = pictures.filter(p => p.cell && kindOf(p.cell) === kind);
  const best = list => [...list].sort((a, b) => compareValues(a.cell.errors?.flip, b.cell.errors?.flip, 1))[0];
  const right = best(made.filter(p => !isPlain(p.cell))) ?? best(made) ?? pictures[pictures.length - 1];
  const ratio = p => Math.abs(Math.log((secondsOf(p.cell) ?? Infinity) / (secondsOf(right.cell ?? {}) ?? 1)));
  const rivals = made.filter(p => isPlain(p.cell) && p !== right);
  const left = rivals.sort((a, b) => ratio(a) - ratio(b))[0] ?? pictures.find(p => p.id === `reference ${kind}`) ?? right;
  return {left: left.id, right: right.id};
}

function fillSelect(select, pictures, chosen) {
  const groups = [...groupBy(pictures, p => p.group).entries()];
  select.replaceChildren(...groups.map(([label, members]) => {
    const options = members.map(p => element("option", {
      value: p.id,
      // The select shows it without the name of its group.
      textContent: [p.name, p.detail].filter(Boolean).join(" · "),
      selected: p.id === chosen,
    }));
    return element("optgroup", {label}, ...options);
  }));
}

function showSide(side, picture) {
  const image = document.getElementById(`${side}-picture`);
  image.src = picture.uri;
  image.alt = `${side}: ${picture.name}`;
  document.getElementById(`${side}-caption`).textContent = [picture.name, picture.detail].filter(Boolean).join(", ");
  const map = document.getElementById(`${side}-map`);
  const none = document.getElementById(`${side}-no-map`);
  map.hidden = !picture.map;
  none.hidden = Boolean(picture.map);
  if (picture.map) {
    map.src = picture.map;
    map.alt = `FLIP map of ${picture.name}`;
  } else {
    map.removeAttribute("src");
    none.textContent = picture.cell ? "This picture has no FLIP map." : "The reference has no error.";
  }
  const p = picture.cell?.flip_percentiles;
  const quartiles = isNumber(p?.median)
    ? `weighted quartiles ${formatNumber(p.q25)}, ${formatNumber(p.median)}, ${formatNumber(p.q75)}` : "";
  document.getElementById(`${side}-map-caption`).textContent = picture.map
    ? [picture.name, flipText(picture.cell), quartiles].filter(Boolean).join("; ") : picture.name;
}

function zoomStage(zoom) {
  const image = document.getElementById("right-picture");
  stage.style.width = zoom === "fit" || !image.naturalWidth ? "" : `${image.naturalWidth * Number(zoom)}px`;
  stage.classList.toggle("large", Number(zoom) >= 2);
}
