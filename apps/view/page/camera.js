"use strict";
// The view: a place, a point to look at, and a field of view.

const vector = {
  add: (a, b) => a.map((x, i) => x + b[i]),
  subtract: (a, b) => a.map((x, i) => x - b[i]),
  times: (a, s) => a.map(x => x * s),
  dot: (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0),
  cross: (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],
  length: a => Math.hypot(...a),
  unit: a => vector.times(a, 1 / (vector.length(a) || 1)),
};

const camera = {
  eye: null, target: null, up: [0, 1, 0], fov: 45, height: 0, first: null, revision: 0,

  /** Takes the view of a picture's matrices, which are column after column. Orthographic ones have a height. */
  take(description, distance) {
    const m = description.world_to_camera, n = description.world_to_ndc;
    if (!m) return false;
    const row = (matrix, i) => [matrix[i], matrix[4 + i], matrix[8 + i]];
    const axes = [row(m, 0), row(m, 1), row(m, 2)], shift = [m[12], m[13], m[14]];
    this.eye = [0, 1, 2].map(i => -(axes[0][i] * shift[0] + axes[1][i] * shift[1] + axes[2][i] * shift[2]));
    const scale = row(n, 3), up = vector.subtract(row(n, 1), vector.times(scale, 0.5));
    const flat = vector.length(scale) < 1e-9;
    this.height = flat ? 1 / vector.length(row(n, 1)) : 0;
    if (!flat) this.fov = 2 * Math.atan(vector.length(scale) / (2 * vector.length(up))) * 180 / Math.PI;
    this.target = vector.add(this.eye, vector.times(axes[2], distance));
    this.up = Math.abs(axes[0][1]) < 0.01 ? [0, 1, 0] : axes[1];
    if (!this.first) this.first = this.state();
    return true;
  },

  state() { return {eye: [...this.eye], target: [...this.target], up: [...this.up], fov: this.fov, height: this.height}; },

  distance() { return vector.length(vector.subtract(this.target, this.eye)); },
  forward() { return vector.unit(vector.subtract(this.target, this.eye)); },
  right() { return vector.unit(vector.cross(this.forward(), this.up)); },
  upward() { return vector.cross(this.right(), this.forward()); },
  /** Metres at the target, for the picture's height. */
  reach() { return this.height || 2 * this.distance() * Math.tan(this.fov * Math.PI / 360); },

  /** A point after a turn around another one, by angles in radians. */
  turned(point, around, across, along) {
    const from = vector.subtract(point, around), radius = vector.length(from);
    const axis = vector.unit(this.up), height = vector.dot(from, axis) / radius;
    const polar = Math.min(Math.max(Math.acos(height) + along, 0.02), Math.PI - 0.02);
    const flat = vector.unit(vector.subtract(from, vector.times(axis, height * radius)));
    const side = vector.cross(axis, flat);
    const aside = vector.add(vector.times(flat, Math.cos(across)), vector.times(side, Math.sin(across)));
    const direction = vector.add(vector.times(aside, Math.sin(polar)), vector.times(axis, Math.cos(polar)));
    return vector.add(around, vector.times(direction, radius));
  },

  /** Goes around the target. */
  orbit(across, along) {
    this.eye = this.turned(this.eye, this.target, across, along);
    this.send();
  },

  /** Turns where it stands. */
  look(across, along) {
    this.target = this.turned(this.target, this.eye, across, along);
    this.send();
  },

  move(step) {
    this.eye = vector.add(this.eye, step);
    this.target = vector.add(this.target, step);
    this.send();
  },

  /** By shares of the picture's height. */
  pan(x, y) {
    const reach = this.reach();
    this.move(vector.add(vector.times(this.right(), -x * reach), vector.times(this.upward(), y * reach)));
  },

  /** Right, up and forward, in shares of the distance to the target. */
  fly(x, y, z) {
    const step = [[this.right(), x], [this.upward(), y], [this.forward(), z]];
    this.move(vector.times(step.reduce((sum, [axis, s]) => vector.add(sum, vector.times(axis, s)), [0, 0, 0]), this.distance()));
  },

  dolly(factor) {
    if (this.height) this.height *= factor;
    this.eye = vector.add(this.target, vector.times(vector.subtract(this.eye, this.target), factor));
    this.send();
  },

  /** Shows a ball whole. */
  frame(center, radius) {
    const forward = this.forward();
    if (this.height) this.height = 2.2 * radius;
    const away = 1.1 * Math.max(radius, 1e-4) / Math.sin(Math.min(this.fov, 120) * Math.PI / 360);
    this.target = center;
    this.eye = vector.subtract(center, vector.times(forward, away));
    this.send();
  },

  back() {
    if (!this.first) return;
    Object.assign(this, structuredClone(this.first));
    this.send();
  },

  send() {
    if (!this.eye) return;
    const text = a => a.map(x => Number(x.toPrecision(7))).join(",");
    const flags = {eye: text(this.eye), target: text(this.target), up: text(this.up)};
    if (this.height) Object.assign(flags, {projection: "orthographic", "view-height": String(this.height)});
    else flags.fov = String(Number(this.fov.toPrecision(6)));
    this.changed = performance.now();
    changes.send(flags);
    document.dispatchEvent(new Event("camera"));
  },
};
