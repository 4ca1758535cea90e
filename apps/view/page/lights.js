"use strict";
// Lights, the sky and the environment.

const kMostLights = 60;

/** Lights that a slider changes together: those of --light-groups, and names that differ in their numbers alone. */
function groupsOfLights(scene, names) {
  const groups = flagOf(scene, "light-groups").split(";").map(text => text.split("="))
    .map(([name, lights]) => [name.trim(), (lights || "").split(",").map(light => light.trim())])
    .map(([name, lights]) => [name, lights.filter(light => light && light !== "environment")]);
  const alike = new Map();
  for (const name of names) {
    const stem = name.replace(/[\s._:-]*\d+$/, "");
    alike.set(stem, (alike.get(stem) || 0) + 1);
  }
  for (const [stem, count] of alike) {
    if (stem && count > 1) groups.push([`${stem}*`, [`${stem}*`]]);
  }
  return groups.filter(([, lights]) => lights.length > 0);
}

function makeLightControls(scene) {
  const parent = document.getElementById("light-controls");
  const of = {groups: new Map(), names: new Map()};
  for (const part of flagOf(scene, "lights").split(";")) {
    const at = part.lastIndexOf("="), name = part.slice(0, at).trim();
    if (at > 0) (name.endsWith("*") ? of.groups : of.names).set(name, part.slice(at + 1).trim());
  }
  const send = () => {
    // The last entry that names a light counts, so that a light's own slider overrides its group's.
    const text = [...of.groups, ...of.names].map(([name, factor]) => `${name}=${factor}`).join(";");
    changes.send({lights: text || null});
  };
  const stops = (into, label, lights, factors) => {
    const factor = factors.get(lights[0]), start = factor === "off" ? -8.1 : factor ? Math.log2(Number(factor)) || 0 : 0;
    slider(into, label, {min: -8.1, max: 8, step: 0.1, value: start, text: x => x < -8 ? "off" : `${signed(x)} EV`, changed: value => {
      for (const light of lights) {
        if (value === 0) factors.delete(light);
        else factors.set(light, value < -8 ? "off" : String(Number((2 ** value).toPrecision(6))));
      }
      send();
    }});
  };
  const names = [...new Set([...scene.lights, ...scene.glowing])].filter(name => name && !/[;=*]/.test(name));
  const groups = groupsOfLights(scene, names);
  for (const [label, lights] of groups) stops(parent, label, lights, of.groups);
  const single = groups.length ? element("details", {}, element("summary", {textContent: "One by one"})) : parent;
  if (single !== parent) parent.append(single);
  for (const name of names.slice(0, kMostLights)) stops(single, name, [name], of.names);
  if (names.length > kMostLights) single.append(element("p", {className: "note", textContent: `and ${names.length - kMostLights} more`}));
  if (!names.length) parent.append(element("p", {className: "note", textContent: "The file has no named lights."}));
}

function makeSkyControls(scene) {
  const parent = document.getElementById("sky-controls");
  const set = flagOf(scene, "sky");
  const given = set ? (/date\s*=/.test(set) ? "date" : "sky") : flagOf(scene, "environment") === "none" ? "none" : "file";
  const sun = {azimuth: 135, elevation: 40, turbidity: 3, intensity: 1, date: "2026-06-21", time: "12:00", place: "48.1,11.6", zone: "+2"};
  for (const [, key, value] of set.matchAll(/(\w+)\s*=\s*([^=]*?)\s*(?=,\s*\w+\s*=|$)/g)) {
    if (key === "sun") [sun.azimuth, sun.elevation] = value.split(",").map(Number);
    else sun[key] = typeof sun[key] === "number" ? Number(value) : value;
  }
  let kind = given;
  const show = () => {
    position.hidden = kind !== "sky";
    moment.hidden = kind !== "date";
    both.hidden = kind !== "sky" && kind !== "date";
  };
  const send = () => {
    const said = {sky: [`sun=${sun.azimuth},${sun.elevation}`], date: ["date", "time", "place", "zone"].map(key => `${key}=${sun[key]}`)}[kind];
    const common = ["turbidity", "intensity", "ground", "size"].filter(key => key in sun).map(key => `${key}=${sun[key]}`);
    changes.send({sky: said ? [...said, ...common].join(",") : null, environment: kind === "none" ? "none" : null});
    show();
  };
  chooser(parent, "Environment", [["file", "as given"], ["none", "none"], ["sky", "sky, by the sun"], ["date", "sky, by the date"]], kind, value => {
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
  slider(parent, "Rotation", {min: 0, max: 360, step: 1, value: Number(flagOf(scene, "environment-rotation", 0)), text: x => `${x}°`, changed: value => {
    changes.send({"environment-rotation": String(value)});
  }});
  slider(parent, "Brightness", {min: -6, max: 6, step: 0.1, value: Math.log2(Number(flagOf(scene, "environment-scale", 1))), text: x => `${signed(x)} EV`, changed: value => {
    changes.send({"environment-scale": String(2 ** value)});
  }});
  const noFog = -12;  // the logarithm of its density
  const [density, ...scattering] = flagOf(scene, "fog", "none").split(",");
  slider(parent, "Fog", {min: noFog, max: 4, step: 0.25, value: density === "none" ? noFog : Math.log2(Number(density)), text: x => x > noFog ? `${(2 ** x).toPrecision(2)} /m` : "none", changed: value => {
    changes.send({fog: value > noFog ? [2 ** value, ...scattering].join(",") : null});
  }});
  show();
}
