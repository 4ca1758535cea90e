"use strict";
// Starts the page; the pointer and the keyboard.

const frame = document.getElementById("frame");

/** The point under a place in the picture; null for the background, or where there is no picture yet. */
async function pixelAt(place) {
  try {
    return await (await ask("pixel", place)).json();
  } catch {
    return null;
  }
}

async function frameObject(place) {
  const pixel = place && await pixelAt(place);
  if (pixel && pixel.center) camera.frame(pixel.center, pixel.radius);
}

async function focusOn(place) {
  aim.active = false;
  frame.classList.remove("aims");
  const pixel = await pixelAt(place);
  if (!pixel || !pixel.position) return;
  const ahead = vector.dot(vector.subtract(pixel.position, camera.eye), camera.forward());
  if (ahead > 0) changes.send({focus: String(Number(ahead.toPrecision(5)))});
}

/** Drags turn around the point that the middle of the first whole picture shows. */
async function findTarget() {
  const before = camera.eye, middle = await pixelAt({x: 0.5, y: 0.5});
  if (!middle || !middle.position || camera.eye !== before) return;
  const ahead = vector.dot(vector.subtract(middle.position, camera.eye), camera.forward());
  if (ahead > 0) camera.target = vector.add(camera.eye, vector.times(camera.forward(), ahead));
  camera.aimed = true;
}

/** The first picture of a view tells where it is, and so do pictures of another tab's drags. */
function followView(scene, description) {
  const own = changes.busy || changes.waiting || description.revision <= changes.revision;
  if (!camera.taken || !own) {
    if (!camera.take(description, camera.eye ? camera.distance() : scene.radius)) return;
    camera.taken = true;
    camera.aimed = false;
  }
  if (!camera.aimed && description.stage !== "draft" && !drags.size) findTarget();
}

const drags = new Map();

function takePointer() {
  let spread = 0;
  frame.addEventListener("pointerdown", event => {
    frame.setPointerCapture(event.pointerId);
    drags.set(event.pointerId, {x: event.clientX, y: event.clientY, moves: event.button !== 0 || event.shiftKey, looks: event.altKey || event.ctrlKey, far: 0});
    frame.classList.add("dragged");
  });
  frame.addEventListener("pointermove", event => {
    pointer.place = picture.place(event);
    const drag = drags.get(event.pointerId);
    if (!drag) return pointer.read();
    const x = event.clientX - drag.x, y = event.clientY - drag.y;
    Object.assign(drag, {x: event.clientX, y: event.clientY, far: drag.far + Math.abs(x) + Math.abs(y)});
    if (!camera.eye || (x === 0 && y === 0)) return;
    const height = picture.box().height;
    if (drags.size > 1) {
      const [a, b] = [...drags.values()], apart = Math.hypot(a.x - b.x, a.y - b.y);
      if (spread > 0 && apart > 0) camera.dolly(spread / apart);
      spread = apart;
      camera.pan(x / height / 2, y / height / 2);
    } else if (drag.moves) {
      camera.pan(x / height, y / height);
    } else if (drag.looks) {
      camera.look(-x / height, -y / height);
    } else {
      camera.orbit(-2.5 * x / height, -2.5 * y / height);
    }
  });
  const end = event => {
    const drag = drags.get(event.pointerId);
    drags.delete(event.pointerId);
    spread = 0;
    frame.classList.toggle("dragged", drags.size > 0);
    const place = picture.place(event);
    if (event.type === "pointerup" && drag && drag.far < 4 && aim.active && place) focusOn(place);
  };
  frame.addEventListener("pointerup", end);
  frame.addEventListener("pointercancel", end);
  frame.addEventListener("contextmenu", event => event.preventDefault());
  frame.addEventListener("dblclick", event => frameObject(picture.place(event)));
  frame.addEventListener("wheel", event => {
    event.preventDefault();
    if (camera.eye) camera.dolly(Math.exp(Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 100) / 600));
  }, {passive: false});
}

function takeKeys(display, layers, time) {
  const turn = 0.08, step = 0.05;
  const keys = {
    ArrowLeft: () => camera.orbit(-turn, 0), ArrowRight: () => camera.orbit(turn, 0),
    ArrowUp: () => camera.orbit(0, -turn), ArrowDown: () => camera.orbit(0, turn),
    "+": () => camera.dolly(0.9), "=": () => camera.dolly(0.9), "-": () => camera.dolly(1 / 0.9),
    w: () => camera.fly(0, 0, step), s: () => camera.fly(0, 0, -step), a: () => camera.fly(-step, 0, 0),
    d: () => camera.fly(step, 0, 0), q: () => camera.fly(0, -step, 0), e: () => camera.fly(0, step, 0),
    f: () => frameObject(pointer.place || {x: 0.5, y: 0.5}), Home: () => camera.back(),
    "[": () => display.step(-0.5), "]": () => display.step(0.5), " ": () => time.toggle(), k: () => picture.keep(),
    "?": () => document.getElementById("help").showModal(),
  };
  layers.forEach((input, i) => { keys[String(i + 1)] = () => input.click(); });
  document.addEventListener("keydown", event => {
    const inField = event.target.closest("input, select, button, summary, dialog, textarea");
    const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act || inField || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    if (camera.eye) act();
  });
}

async function start() {
  let scene = null;
  while (!scene) {
    try {
      scene = await (await ask("scene")).json();
      showLost(null);
    } catch (error) {
      showLost(error);
      await pause(1000);
    }
  }
  document.getElementById("title").textContent = document.title = scene.file.split("/").pop();
  const display = makeDisplayControls(scene), layers = makeLayerControls(scene), time = makeTimeControls(scene);
  if (!scene.cameras) {
    for (const id of ["camera-controls", "light-controls", "sky-controls"]) document.getElementById(id).parentElement.hidden = true;
  } else {
    document.addEventListener("picture", event => followView(scene, event.detail));
    makeCameraControls(scene);
    makeLightControls(scene);
    makeSkyControls(scene);
  }
  makeCompareControls();
  makeSaveControls();
  document.getElementById("help-button").addEventListener("click", () => document.getElementById("help").showModal());
  addEventListener("resize", () => { if (!picture.kept.hidden) picture.setWipe(picture.share); });
  addEventListener("hashchange", () => location.reload());
  takePointer();
  takeKeys(display, layers, time);
  picture.watch();
  watchStatus();
}

start();
