"use strict";
// Parts of the panel: rows with a name, a control and its value.

function element(name, properties = {}, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}

/** A slider. `text` describes its value; `changed` is called while it moves. */
function slider(parent, name, {min, max, step, value, text = String, changed}) {
  const output = element("output", {textContent: text(value)});
  const input = element("input", {type: "range", min, max, step, value});
  input.addEventListener("input", () => {
    output.textContent = text(Number(input.value));
    changed(Number(input.value));
  });
  input.set = to => {
    input.value = to;
    output.textContent = text(Number(to));
  };
  parent.append(element("label", {className: "row"}, element("span", {textContent: name, title: name}), input, output));
  return input;
}

function chooser(parent, name, choices, value, changed) {
  const select = element("select", {}, ...choices.map(([key, label]) => element("option", {value: key, textContent: label})));
  select.value = value;
  select.addEventListener("change", () => changed(select.value));
  parent.append(element("label", {className: "row wide"}, element("span", {textContent: name}), select));
  return select;
}

function field(parent, name, type, value, changed) {
  const input = element("input", {type, value});
  input.addEventListener("change", () => changed(input.value));
  parent.append(element("label", {className: "row wide"}, element("span", {textContent: name}), input));
  return input;
}

function button(parent, name, pressed) {
  const made = element("button", {type: "button", textContent: name});
  made.addEventListener("click", pressed);
  parent.append(made);
  return made;
}

const signed = (x, digits = 1) => (x > 0 ? "+" : "") + x.toFixed(digits);

/** The value of a flag: the one that was set here, or on the command line. */
const flagOf = (scene, name, otherwise = "") => scene.flags[name] ?? scene.given[name] ?? otherwise;

const aim = {active: false};  // the next click chooses what is sharp

function makeCameraControls(scene) {
  const parent = document.getElementById("camera-controls");
  if (scene.cameras.length) {
    const names = scene.cameras.map((c, i) => [String(i), c.name || `camera ${i}`]);
    const select = chooser(parent, "Of the file", [["", "free"], ...names], scene.flags.eye ? "" : flagOf(scene, "camera", "0"), value => {
      if (value === "") return;
      camera.revision = changes.revision + 1;
      changes.send({camera: value, eye: null, target: null, up: null, fov: null, projection: null, "view-height": null});
      camera.taken = false;
    });
    document.addEventListener("camera", () => { select.value = ""; });
  }
  const fov = slider(parent, "Field of view", {min: 5, max: 120, step: 1, value: 45, text: x => `${x.toFixed(0)}°`, changed: value => {
    camera.fov = value;
    camera.send();
  }});
  document.addEventListener("picture", () => { if (document.activeElement !== fov) fov.set(camera.fov); });
  const lens = Number(flagOf(scene, "aperture", 0));
  slider(parent, "Aperture", {min: 0, max: 100, step: 1, value: Math.round(lens * 1000), text: x => x ? `${x} mm` : "pinhole", changed: value => {
    changes.send({aperture: value ? String(value / 1000) : null});
  }});
  const row = element("div", {className: "buttons"});
  parent.append(row);
  button(row, "Focus by click", () => {
    aim.active = !aim.active;
    document.getElementById("frame").classList.toggle("aims", aim.active);
  });
  button(row, "Frame all", () => camera.frame(scene.center, scene.radius));
  button(row, "First view", () => camera.back());
  if (viewer === "shared") button(row, "Own camera in a new tab", () => open(`#own-${Math.random().toString(36).slice(2, 10)}`, "_blank"));
}

function makeDisplayControls(scene) {
  const parent = document.getElementById("display-controls");
  const given = flagOf(scene, "exposure", "auto");
  const automatic = element("input", {type: "checkbox", checked: given === "auto"});
  const exposure = slider(parent, "Exposure", {min: -10, max: 10, step: 0.1, value: Number(given) || 0, text: x => `${signed(x)} EV`, changed: value => {
    automatic.checked = false;
    changes.send({exposure: String(value)});
  }});
  automatic.addEventListener("change", () => changes.send({exposure: automatic.checked ? "auto" : exposure.value}));
  parent.append(element("label", {className: "row wide"}, element("span", {textContent: "by itself"}), automatic));
  document.addEventListener("picture", event => { if (automatic.checked) exposure.set(event.detail.exposure); });
  chooser(parent, "Curve", scene.curves.map(name => [name, name]), flagOf(scene, "tonemap", "agx"), value => changes.send({tonemap: value}));
  slider(parent, "White balance", {min: 2000, max: 12000, step: 50, value: Number(flagOf(scene, "white-balance", 6504)), text: x => `${x} K`, changed: value => {
    changes.send({"white-balance": String(value)});
  }});
  return {step: by => { exposure.set(Number(exposure.value) + by); exposure.dispatchEvent(new Event("input")); }};
}

function makeLayerControls(scene) {
  const groups = flagOf(scene, "light-groups").split(";").map(text => text.split("=")[0].trim()).filter(Boolean);
  const layers = [...scene.layers, ...groups.map(name => ({name: `light-${name}`, label: `light: ${name}`}))];
  const parent = element("div", {className: "choices", role: "radiogroup"});
  document.getElementById("layer-controls").append(parent);
  return layers.map(({name, label, needs = "nothing"}, i) => {
    const input = element("input", {type: "radio", name: "layer", value: name, checked: i === 0});
    input.addEventListener("change", () => picture.setLayer(name));
    parent.append(element("label", {title: needs === "nothing" ? "" : `needs ${needs}`}, input, ` ${label}`));
    return input;
  });
}

function makeTimeControls(scene) {
  if (!scene.animations || !scene.animations.length) return {toggle() {}};
  document.getElementById("time-section").hidden = false;
  const parent = document.getElementById("time-controls");
  const end = Math.max(...scene.animations.map(a => a.seconds), 0.001);
  let playing = false, revision = 0, started = 0, from = 0;
  const time = slider(parent, "Seconds", {min: 0, max: end, step: 0.001, value: Number(flagOf(scene, "time", 0)), text: x => x.toFixed(2), changed: value => changes.send({time: String(value)})});
  const advance = () => {
    const now = (from + (performance.now() - started) / 1000) % end;
    time.set(now);
    changes.send({time: String(now)});
  };
  const row = element("div", {className: "buttons"});
  parent.append(row);
  const play = button(row, "Play", () => {
    playing = !playing;
    play.textContent = playing ? "Pause" : "Play";
    started = performance.now();
    from = Number(time.value);
    if (playing) advance();
  });
  document.addEventListener("picture", event => {
    if (!playing || event.detail.revision === revision) return;
    revision = event.detail.revision;
    advance();
  });
  return {toggle: () => play.click()};
}

function makeCompareControls() {
  const parent = document.getElementById("compare-controls");
  const row = element("div", {className: "buttons"});
  parent.append(row);
  button(row, "Keep this picture", () => picture.keep());
  button(row, "Forget it", () => picture.drop());
  slider(parent, "Kept, left of", {min: 0, max: 100, step: 1, value: 50, text: x => `${x} %`, changed: value => picture.setWipe(value / 100)});
}

function makeSaveControls() {
  const parent = document.getElementById("save-controls");
  const row = element("div", {className: "buttons"});
  parent.append(row);
  for (const format of ["exr", "png"]) {
    button(row, `Save ${format.toUpperCase()}`, async () => {
      try {
        const blob = await (await ask("save", {format})).blob();
        const link = element("a", {href: URL.createObjectURL(blob), download: `gatelight.${format}`});
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 10000);
      } catch (error) {
        showError(error.message);
      }
    });
  }
  const command = element("pre", {id: "command"});
  button(row, "Copy command", async () => {
    try {
      await navigator.clipboard.writeText(command.textContent);
    } catch {
      getSelection().selectAllChildren(command);
    }
  });
  parent.append(element("p", {className: "note", textContent: "The last complete picture is saved. This command renders the same one:"}), command);
}
