"use strict";
// Two pictures with a border that moves, and their FLIP maps.

/// Distance in pixels below which a finger's move is a tap.
const kSlop = 8;

/// The picture that each side shows now.
const sides = {left: null, right: null};

function moveBorder(percent) {
  const to = Math.min(100, Math.max(0, percent));
  at("stage").style.setProperty("--at", `${to}%`);
  at("handle").setAttribute("aria-valuenow", Math.round(to));
  at("handle").setAttribute("aria-valuetext", `${Math.round(to)} % of the left picture`);
}

function border() {
  return Number.parseFloat(at("stage").style.getPropertyValue("--at"));
}

function listenToKeys() {
  const steps = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10, Home: -100, End: 100};
  at("handle").addEventListener("keydown", event => {
    const step = steps[event.key];
    if (step === undefined || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    moveBorder(border() + (event.shiftKey ? 5 * step : step));
  });
}

/// The mouse takes the border anywhere. A finger that goes up or down scrolls the page, so it takes the border with its first
/// move sideways. Where the pictures are larger than their window both move them in it, and the border only by its
/// handle. A click or a tap puts the border where it is.
function listenToPointer() {
  const [stage, handle, scroller] = [at("stage"), at("handle"), at("stage-scroller")];
  let down = null;
  const follow = event => {
    const box = stage.getBoundingClientRect();
    moveBorder(100 * (event.clientX - box.left) / box.width);
  };
  const take = event => {
    down.drags = "border";
    stage.setPointerCapture(event.pointerId);
    handle.focus({preventScroll: true});
    follow(event);
  };
  stage.addEventListener("pointerdown", event => {
    if (event.button !== 0 || !event.isPrimary) return;
    const free = event.target === handle || !stage.classList.contains("zoomed");
    down = {x: event.clientX, y: event.clientY, left: scroller.scrollLeft, top: scroller.scrollTop, free, drags: null};
    if (event.pointerType === "touch") return;
    event.preventDefault();
    if (free) {
      take(event);
    } else {
      down.drags = "pictures";
      stage.setPointerCapture(event.pointerId);
    }
  });
  stage.addEventListener("pointermove", event => {
    if (!down || !event.isPrimary) return;
    const [x, y] = [event.clientX - down.x, event.clientY - down.y];
    if (down.drags === "border") {
      follow(event);
    } else if (down.drags === "pictures") {
      scroller.scrollTo(down.left - x, down.top - y);
    } else if (down.free && Math.abs(x) >= kSlop && Math.abs(x) > Math.abs(y)) {
      take(event);
    }
  });
  stage.addEventListener("pointerup", event => {
    if (!down || !event.isPrimary) return;
    if (Math.hypot(event.clientX - down.x, event.clientY - down.y) < kSlop) follow(event);
    down = null;
  });
  stage.addEventListener("pointercancel", () => { down = null; });
}

function flipText(cell) {
  return isNumber(cell.errors?.flip) ? `FLIP ${formatNumber(cell.errors.flip)}` : "";
}

/// Text of the error that the render itself estimated.
function estimateText(cell) {
  const error = relativeErrorOf(cell);
  const percent = x => `${formatNumber(100 * x, 2)}\u00a0%`;
  return error ? `relative error ${isNumber(error.is) ? percent(error.is) : kNone}, estimated ${percent(error.estimated)}` : "";
}

/// Entries of the index: {file, exposure, tonemap (only of references), size, width, element}.
function entriesOf(file) {
  return file ? pictureIndex.filter(entry => entry.file === file) : [];
}

function uriOf(entry) {
  return at(entry.element).textContent;
}

/// Whether two pictures, or one and the options of a cell, are shown with the same exposure and curve.
function sameDisplay(a, b) {
  return ["exposure", "tonemap"].every(key => (a?.[key] ?? null) === (b?.[key] ?? null));
}

/// A reference, once for each way in which its cells are shown.
function referencePictures(reference, names) {
  const entries = entriesOf(reference.file);
  const name = names.size > 1 ? `reference, ${names.get(keyOf(reference)) ?? kKinds[reference.kind] ?? reference.kind}` : "reference";
  const differ = key => new Set(entries.map(entry => entry[key] ?? null)).size > 1;
  return entries.map((entry, i) => ({
    id: ["reference", reference.id ?? reference.file, i > 0 ? i : ""].filter(part => part !== "").join(" "),
    group: "Reference",
    name: [name, ...["exposure", "tonemap"].filter(differ).map(key => `${key} ${entry[key]}`)].join(", "),
    detail: isNumber(reference.spp) ? `${reference.spp} spp` : "",
    reference: keyOf(reference),
    display: entry,
    entry,
  }));
}

/// The pictures of a scene: {id, group, name, detail, reference, display, entry, map, cell}, references first.
function picturesOf(scene, cells) {
  const names = referenceNames(cells);
  const references = (scene.references ?? []).flatMap(reference => referencePictures(reference, names));
  const made = cells.filter(cell => entriesOf(cell.picture).length > 0).map(cell => ({
    id: cell.id,
    group: cell.series,
    name: `${cell.series}, ${pointName(cell)}`,
    detail: [secondsOf(cell) === null ? "" : formatSeconds(secondsOf(cell)), flipText(cell)].filter(Boolean).join(", "),
    reference: referenceOf(cell),
    display: cell.options,
    entry: entriesOf(cell.picture)[0],
    map: entriesOf(cell.error_map)[0],
    cell,
  }));
  return [...references, ...made];
}

/// The reference that a picture was compared with, shown likewise.
function referencePictureOf(pictures, picture) {
  const own = pictures.filter(p => !p.cell && p.reference === picture.reference);
  return own.find(p => sameDisplay(p.display, picture.display)) ?? own[0];
}

/// The most accurate picture with a cache, and the one as traced without that took about as long; both compared with
/// `reference`.
function defaultPair(pictures, reference) {
  const made = pictures.filter(p => p.cell && p.reference === reference);
  const best = list => [...list].sort((a, b) => compareValues(a.cell.errors?.flip, b.cell.errors?.flip, 1))[0];
  const right = best(made.filter(p => !isPlain(p.cell))) ?? best(made) ?? pictures[pictures.length - 1];
  const ratio = p => Math.abs(Math.log((secondsOf(p.cell) ?? Infinity) / (secondsOf(right.cell ?? {}) ?? 1)));
  const plain = made.filter(p => isPlain(p.cell) && p !== right && sameDisplay(p.display, right.display));
  const traced = plain.filter(p => !isDenoised(p.cell));
  const left = (traced.length > 0 ? traced : plain).sort((a, b) => ratio(a) - ratio(b))[0] ?? referencePictureOf(pictures, right) ?? right;
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
  sides[side] = picture;
  const image = at(`${side}-picture`);
  image.src = uriOf(picture.entry);
  image.alt = `${side}: ${picture.name}`;
  at(`${side}-caption`).textContent = [picture.name, picture.detail, picture.cell ? estimateText(picture.cell) : ""].filter(Boolean).join(", ");
  const map = at(`${side}-map`);
  const none = at(`${side}-no-map`);
  map.hidden = !picture.map;
  none.hidden = Boolean(picture.map);
  if (picture.map) {
    map.src = uriOf(picture.map);
    map.alt = `FLIP map of ${picture.name}`;
  } else {
    map.removeAttribute("src");
    none.textContent = picture.cell ? "This picture has no FLIP map." : "The reference has no error.";
  }
  const p = picture.cell?.flip_percentiles;
  const quartiles = isNumber(p?.median)
    ? `weighted quartiles ${formatNumber(p.q25)}, ${formatNumber(p.median)}, ${formatNumber(p.q75)}` : "";
  at(`${side}-map-caption`).textContent = picture.map
    ? [picture.name, flipText(picture.cell), quartiles].filter(Boolean).join("; ") : picture.name;
}

/// In pixels of the picture that was rendered; the page may hold a smaller one.
function zoomStage() {
  const [stage, scroller] = [at("stage"), at("stage-scroller")];
  const zoom = at("zoom").value;
  stage.style.width = zoom === "fit" || !sides.right ? "" : `${sides.right.entry.size[0] * Number(zoom)}px`;
  stage.classList.toggle("large", Number(zoom) >= 2);
  stage.classList.toggle("zoomed", zoom !== "fit" && stage.offsetWidth > scroller.clientWidth);
  const smaller = Object.values(sides).filter(side => side && side.entry.width < side.entry.size[0])
    .map(side => `${side.entry.width} of ${side.entry.size[0]}`);
  at("shown-note").hidden = smaller.length === 0;
  at("shown-note").textContent = `This page holds them at ${[...new Set(smaller)].join(" and ")} pixels of width.`;
}

function showPictures(pictures, pair) {
  for (const side of ["left", "right"]) {
    const show = () => {
      showSide(side, pictures.find(p => p.id === at(side).value));
      zoomStage();
    };
    fillSelect(at(side), pictures, pair[side]);
    at(side).onchange = show;
    show();
  }
}

/// The seed of a configuration that has a picture.
function pictureOf(configuration) {
  return configuration.cells.find(cell => entriesOf(cell.picture).length > 0);
}

/// Puts the picture of a cell beside its reference.
function lookAt(cell) {
  const pictures = picturesOf(scenes.find(s => s.name === state.scene) ?? {}, sceneCells());
  const right = pictures.find(p => p.cell === cell);
  showPictures(pictures, {left: (referencePictureOf(pictures, right) ?? right).id, right: right.id});
  at("pictures-section").scrollIntoView();
  at("handle").focus({preventScroll: true});
}

function lookButton(configuration) {
  const cell = pictureOf(configuration);
  if (!cell) return kNone;
  const button = element("button", {type: "button", className: "small", textContent: "look"});
  button.setAttribute("aria-label", `Look at ${configuration.series}, ${configuration.point}`);
  button.addEventListener("click", () => lookAt(cell));
  return button;
}
