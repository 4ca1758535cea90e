"use strict";
// Lights, the sky and the environment.

function makeLightControls(scene) {
  const parent = document.getElementById("light-controls");
  const factors = new Map();
  for (const part of flagOf(scene, "lights").split(";")) {
    const at = part.lastIndexOf("=");
    if (at > 0) factors.set(part.slice(0, at), part.slice(at + 1));
  }
  const send = () => {
    const text = [...factors].map(([name, factor]) => `${name}=${factor}`).join(";");
    changes.send({lights: text || null});
  };
  const names = [...new Set([...scene.lights, ...scene.glowing])].filter(name => name && !name.includes(";") && !name.endsWith("*"));
  for (const name of names.slice(0, 60)) {
    const factor = factors.get(name), start = factor === "off" ? -8.1 : factor ? Math.log2(Number(factor)) || 0 : 0;
    slider(parent, name, {min: -8.1, max: 8, step: 0.1, value: start, text: x => x < -8 ? "off" : `${signed(x)} EV`, changed: value => {
      if (value === 0) factors.delete(name);
      else factors.set(name, value < -8 ? "off" : String(Number((2 ** value).toPrecision(6))));
      send();
    }});
  }
  if (!names.length) parent.append(element("p", {className: "note", textContent: "The file has no lights with names."}));
}

function makeSkyControls(scene) {
  const parent = document.getElementById("sky-controls");
  const given = flagOf(scene, "sky") ? "sky" : flagOf(scene, "environment") === "none" ? "none" : "file";
  const sun = {azimuth: 135, elevation: 40, turbidity: 3, intensity: 1, date: "2026-06-21", time: "12:00", place: "48.1,11.6", zone: "+2"};
  let kind = given;
  const send = () => {
    const text = {
      sky: () => `sun=${sun.azimuth},${sun.elevation},turbidity=${sun.turbidity},intensity=${sun.intensity}`,
      date: () => `date=${sun.date},time=${sun.time},place=${sun.place},zone=${sun.zone},turbidity=${sun.turbidity},intensity=${sun.intensity}`,
    }[kind];
    changes.send({sky: text ? text() : null, environment: kind === "none" ? "none" : null});
    position.hidden = kind !== "sky";
    moment.hidden = kind !== "date";
    both.hidden = !text;
  };
  chooser(parent, "Light around", [["file", "as given"], ["none", "none"], ["sky", "sky, by the sun"], ["date", "sky, by the date"]], kind, value => {
    kind = value;
    send();
  });
  const position = element("div"), moment = element("div"), both = element("div");
  parent.append(position, moment, both);
  const part = (into, name, key, min, max, step, text) =>
    slider(into, name, {min, max, step, value: sun[key], text, changed: value => { sun[key] = value; send(); }});
  part(position, "Sun, from north", "azimuth", 0, 360, 1, x => `${x}°`);
  part(position, "Sun, height", "elevation", -10, 90, 0.5, x => `${x}°`);
  const said = (name, type, key) => field(moment, name, type, sun[key], value => { sun[key] = value; send(); });
  said("Date", "date", "date");
  said("Clock", "time", "time");
  said("Latitude, longitude", "text", "place");
  said("Hours ahead of UTC", "text", "zone");
  part(both, "Haze", "turbidity", 1, 10, 0.1, x => x.toFixed(1));
  part(both, "Brightness", "intensity", 0, 4, 0.05, x => x.toFixed(2));
  slider(parent, "Turned", {min: 0, max: 360, step: 1, value: Number(flagOf(scene, "environment-rotation", 0)), text: x => `${x}°`, changed: value => {
    changes.send({"environment-rotation": String(value)});
  }});
  slider(parent, "Scaled", {min: -6, max: 6, step: 0.1, value: Math.log2(Number(flagOf(scene, "environment-scale", 1))), text: x => `${signed(x)} EV`, changed: value => {
    changes.send({"environment-scale": String(2 ** value)});
  }});
  position.hidden = kind !== "sky";
  moment.hidden = both.hidden = true;
}
