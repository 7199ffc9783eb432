// @ts-check
"use strict";
/* Draws the scene on a 2D canvas: no graphics processor is asked for anything. */

const CONFIDENT = 2.795; // standard deviations: 95 % of a normal distribution in space lie inside
const SCALE = [[52, 72, 165], [150, 62, 150], [222, 98, 78], [240, 180, 50]]; // lighter from each to the next
const UNKNOWN = "#999999";
const HIDDEN_M = 0.3;
const BONE_M = 0.028, JOINT_M = 0.022;

/** A colour for a value between 0 and most. */
function shade(value, most) {
  if (!Number.isFinite(value)) return UNKNOWN;
  const place = Math.max(0, Math.min(1, value / most)) * (SCALE.length - 1);
  const at = Math.min(SCALE.length - 2, Math.floor(place));
  const rgb = SCALE[at].map((low, band) => Math.round(low + (place - at) * (SCALE[at + 1][band] - low)));
  return `rgb(${rgb.join(",")})`;
}

class Painter {
  constructor(canvas, eye, scene) {
    /** @type {HTMLCanvasElement} */
    this.canvas = canvas;
    /** @type {Eye} */
    this.eye = eye;
    this.scene = scene;
    this.context = canvas.getContext("2d");
    this.drawn = [];
    this.adapt();
  }

  /** Take size and colours from the page. */
  adapt() {
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const [width, height] = [this.canvas.clientWidth || 300, this.canvas.clientHeight || 200];
    [this.canvas.width, this.canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.eye.size = [width, height];
    this.eye.update();
    const look = getComputedStyle(this.canvas);
    this.ink = look.getPropertyValue("--ink").trim() || "#222222";
    this.floor = look.getPropertyValue("--court-floor").trim() || "#eeeeee";
    this.paint = look.getPropertyValue("--court-line").trim() || "#aaaaaa";
    this.halo = look.getPropertyValue("--ground").trim() || "#ffffff";
  }

  line(points, colour, width = 1, { closed = false, fill = null, alpha = 1 } = {}) {
    const on = this.eye.clipped(points, closed);
    if (on.length < 2) return;
    const to = this.context;
    to.globalAlpha = alpha;
    to.beginPath();
    on.forEach(([x, y], at) => (at ? to.lineTo(x, y) : to.moveTo(x, y)));
    if (closed) to.closePath();
    if (fill) { to.fillStyle = fill; to.fill(); }
    if (colour) { to.strokeStyle = colour; to.lineWidth = width; to.stroke(); }
    to.globalAlpha = 1;
  }

  text(words, point, dx = 6, dy = -6) {
    const on = this.eye.project(point);
    if (!on) return;
    const to = this.context;
    to.font = "12px system-ui, sans-serif";
    to.lineJoin = "round";
    to.lineWidth = 3;
    to.strokeStyle = this.halo;
    to.strokeText(words, on[0] + dx, on[1] + dy);
    to.fillStyle = this.ink;
    to.fillText(words, on[0] + dx, on[1] + dy);
  }

  frame(view) {
    const to = this.context;
    to.clearRect(0, 0, ...this.eye.size);
    to.lineCap = to.lineJoin = "round";
    this.ground();
    if (view.cameras) this.cameras();
    this.drawn = [];
    const shown = view.layers.filter((layer) => layer.shown);
    shown.forEach((layer) => this.trails(layer, view));
    shown.forEach((layer, order) => this.skeletons(layer, order, view));
    if (view.picked) shown.forEach((layer) => this.ellipsoid(layer, view));
    if (view.names && shown.length) this.names(shown[0], view);
    this.axes();
  }

  ground() {
    const { court, grid } = this.scene;
    for (const line of grid) this.line(line, this.paint, 0.6, { alpha: 0.5 });
    if (!court) return;
    this.line(court.floor, null, 0, { closed: true, fill: this.floor });
    for (const line of court.lines) this.line(line, this.paint, 0.8, { closed: true, fill: this.paint });
    court.net.forEach(({ points, width, alpha }) => this.line(points, this.ink, width, { alpha }));
  }

  cameras() {
    for (const camera of this.scene.cameras) {
      const away = Math.hypot(...camera.centre.map((value, axis) => value - this.eye.place[axis]));
      if (away < HIDDEN_M) continue; // the view is through this camera
      const corners = camera.corners;
      corners.forEach((corner) => this.line([camera.centre, corner], this.ink, 1, { alpha: 0.65 }));
      this.line(corners, this.ink, 1, { closed: true, fill: this.ink + "18", alpha: 0.65 });
      this.text(camera.name, camera.centre);
    }
  }

  /** Arrows along x, y, z at the world's origin, 0.5 m long. */
  axes() {
    [["x", [0.5, 0, 0]], ["y", [0, 0.5, 0]], ["z", [0, 0, 0.5]]].forEach(([name, tip]) => {
      this.line([[0, 0, 0], tip], this.ink, 1.5, { alpha: 0.7 });
      this.text(name, tip, 3, -3);
    });
  }

  trails(layer, view) {
    if (!view.trail_s || !view.trails.size) return;
    const last = layer.frameAt(Math.min(view.time_s, layer.time_s[layer.length - 1]));
    const whole = !Number.isFinite(view.trail_s);
    const stop = whole ? layer.length - 1 : last;
    const first = whole ? 0 : layer.time_s.findIndex((time) => time >= view.time_s - view.trail_s);
    if (first < 0 || stop < first) return;
    const stride = Math.max(1, Math.ceil((stop - first) / 900));
    this.context.setLineDash([]);
    layer.joints.forEach((joint, j) => {
      if (!view.trails.has(joint)) return;
      for (let person = 0; person < layer.persons.length; person++) {
        let piece = [];
        const flush = () => {
          if (piece.length > 1) this.line(piece, view.trailColour(layer, joint), 1.2, { alpha: 0.75 });
          piece = [];
        };
        for (let frame = first; frame <= stop; frame += stride) {
          const place = layer.position(person, j, frame);
          if (place) piece.push(place); else flush();
        }
        flush();
      }
    });
  }

  skeletons(layer, order, view) {
    const frame = layer.frameAt(view.time_s);
    const parts = [];
    for (let person = 0; person < layer.persons.length; person++) {
      const places = layer.joints.map((_, joint) => layer.position(person, joint, frame));
      const on = places.map((place) => place && this.eye.project(place));
      const colours = layer.joints.map((_, joint) => view.jointColour(layer, person, joint, frame));
      on.forEach((spot, joint) => {
        if (!spot) return;
        parts.push({ depth: spot[2] - 0.01, spot, colour: colours[joint] });
        this.drawn.push({ layer, person, joint, x: spot[0], y: spot[1] });
      });
      layer.bones.forEach((bone, at) => {
        const [a, b] = bone.map((joint) => on[joint]);
        if (!a || !b) return;
        const colour = view.boneColour(layer, person, bone, frame, colours);
        parts.push({ depth: (a[2] + b[2]) / 2, ends: [a, b], colour, at });
      });
    }
    parts.sort((a, b) => b.depth - a.depth);
    parts.forEach((part) => this.part(part, order));
  }

  part({ depth, spot, ends, colour }, order) {
    const to = this.context;
    const thick = Math.max(1.6, Math.min(9, BONE_M * this.eye.scale / depth)) * (order ? 0.6 : 1);
    if (spot) {
      to.fillStyle = colour;
      to.beginPath();
      to.arc(spot[0], spot[1], Math.max(1.6, Math.min(8, JOINT_M * this.eye.scale / depth)) * (order ? 0.75 : 1), 0, 7);
      to.fill();
      return;
    }
    to.setLineDash(order % 2 ? [2 * thick + 2, 1.5 * thick + 2] : []);
    to.strokeStyle = colour;
    to.lineWidth = thick;
    to.beginPath();
    to.moveTo(ends[0][0], ends[0][1]);
    to.lineTo(ends[1][0], ends[1][1]);
    to.stroke();
    to.setLineDash([]);
  }

  names(layer, view) {
    const frame = layer.frameAt(view.time_s);
    layer.persons.forEach((name, person) => {
      const places = layer.joints.map((_, joint) => layer.position(person, joint, frame)).filter(Boolean);
      if (!places.length) return;
      const top = places.reduce((a, b) => (b[2] > a[2] ? b : a));
      this.text(name, [top[0], top[1], top[2] + 0.15], -6, 0);
    });
  }

  /** The picked joint: a ring, and where it is to be expected. */
  ellipsoid(layer, view) {
    const person = layer.persons.indexOf(view.picked.person);
    const joint = layer.joints.indexOf(view.picked.joint);
    if (person < 0 || joint < 0) return;
    const frame = layer.frameAt(view.time_s);
    const place = layer.position(person, joint, frame);
    const on = place && this.eye.project(place);
    if (!on) return;
    const to = this.context;
    to.strokeStyle = this.ink;
    to.lineWidth = 1.5;
    to.beginPath();
    to.arc(on[0], on[1], 9, 0, 7);
    to.stroke();
    const factor = layer.factor(person, joint, frame);
    if (!factor || !view.magnified) return;
    const reach = CONFIDENT * view.magnified;
    const colour = view.layerColour(layer);
    const mapped = (u) => place.map((value, row) =>
      value + reach * (factor[row][0] * u[0] + factor[row][1] * u[1] + factor[row][2] * u[2]));
    for (const circle of this.scene.circles) this.line(circle.map(mapped), colour, 1, { closed: true, alpha: 0.8 });
  }
}

/** Circles on the unit sphere: parallels and meridians. */
function sphereCircles() {
  const turns = [...Array(36).keys()].map((step) => step * Math.PI / 18);
  const parallels = [-0.87, -0.5, 0, 0.5, 0.87].map((z) =>
    turns.map((turn) => [Math.sqrt(1 - z * z) * Math.cos(turn), Math.sqrt(1 - z * z) * Math.sin(turn), z]));
  const meridians = [0, 1, 2, 3].map((quarter) => turns.map((turn) => [
    Math.cos(turn) * Math.cos(quarter * Math.PI / 4), Math.cos(turn) * Math.sin(quarter * Math.PI / 4), Math.sin(turn)]));
  return [...parallels, ...meridians];
}
