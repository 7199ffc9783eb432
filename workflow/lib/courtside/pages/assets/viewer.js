// @ts-check
"use strict";
/* The 3D viewer: what is shown, when, and how keys, hand and clock change it. */

/** The eight corners of a box. */
function corners(low, high) {
  return [0, 1, 2, 3, 4, 5, 6, 7].map((at) => [0, 1, 2].map((axis) => ((at >> axis) & 1 ? high : low)[axis]));
}

class Viewer {
  constructor(scene, layers) {
    const starts = layers.map((layer) => layer.time_s[0]);
    const stops = layers.map((layer) => layer.time_s[layer.length - 1]);
    const main = layers[0];
    this.step_s = main.length > 1 ? (main.time_s[main.length - 1] - main.time_s[0]) / (main.length - 1) : 1 / 30;
    // Frames of the first layer, going on before and after it where others are longer.
    const before = Math.ceil((main.time_s[0] - Math.min(...starts)) / this.step_s - 1e-6);
    this.start_s = main.time_s[0] - Math.max(0, before) * this.step_s;
    this.n_frames = Math.max(1, 1 + Math.round((Math.max(...stops) - this.start_s) / this.step_s));
    this.scene = { ...scene, circles: sphereCircles() };
    const wrists = layers.flatMap((layer) => layer.joints).filter((joint) => joint.endsWith("_wrist"));
    const shown = layers.filter((layer) => layer.shown).length;
    this.view = {
      layers, time_s: main.firstShown_s, cameras: true, names: true, person: main.persons[0], picked: null, magnified: 1, trail_s: 1,
      trails: new Set(wrists), colour: shown > 1 ? "layer" : "side", against: main, end: {},
      layerColour: (layer) => scene.colours.layers[layer.index % scene.colours.layers.length],
      jointColour: (layer, ...where) => this.jointColour(layer, ...where),
      boneColour: (layer, ...where) => this.boneColour(layer, ...where),
      trailColour: (layer, joint) => (this.view.colour === "side" ? this.sideColour(joint) : this.view.layerColour(layer)),
    };
    this.playing = false;
    this.speed = 1;
    this.stale = true;
    this.eye = new Eye();
    this.painter = new Painter(courtside.byId("canvas"), this.eye, this.scene);
    this.eye.fit(this.around());
  }

  /** Corners of the box that the first view shows: all movement and the floor below. */
  around() {
    const { low, high } = this.scene;
    return corners([low[0], low[1], Math.min(low[2], 0)], high);
  }

  /** Cameras, court and all movement. */
  whole() {
    const { court, cameras } = this.scene;
    return [...this.around(), ...cameras.map((camera) => camera.centre), ...(court ? court.floor : [])];
  }

  sideColour(joint) {
    const { left, right, middle } = this.scene.colours;
    return joint.startsWith("left_") ? left : joint.startsWith("right_") ? right : middle;
  }

  measured(layer, person, joint, frame) {
    layer.against = this.view.against;
    return MEASURES[this.view.colour].of(layer, person, joint, frame);
  }

  jointColour(layer, person, joint, frame) {
    if (this.view.colour === "side") return this.sideColour(layer.joints[joint]);
    if (this.view.colour === "layer") return this.view.layerColour(layer);
    return shade(this.measured(layer, person, joint, frame), this.view.end[this.view.colour]);
  }

  boneColour(layer, person, bone, frame, colours) {
    if (!MEASURES[this.view.colour]) {
      return colours[bone[0]] === colours[bone[1]] ? colours[bone[0]] : this.scene.colours.middle;
    }
    const ends = bone.map((joint) => this.measured(layer, person, joint, frame));
    return shade((ends[0] + ends[1]) / 2, this.view.end[this.view.colour]);
  }

  /** Show a layer or not; two in the colours of the body's sides could not be told apart. */
  switchLayer(layer, on) {
    layer.shown = on;
    if (on && this.view.colour === "side" && this.view.layers.filter((one) => one.shown).length > 1) {
      courtside.byId("colour").value = "layer";
      this.chooseColour("layer");
    }
    this.changed();
  }

  chooseColour(colour) {
    this.view.colour = colour;
    const measure = MEASURES[colour];
    if (measure) {
      this.view.layers.forEach((layer) => { layer.against = this.view.against; });
      const others = this.view.layers.filter((layer) => colour !== "distance" || layer !== this.view.against);
      this.view.end[colour] = scaleEnd(others, measure.of);
    }
    this.changed();
  }

  get frame() { return Math.round((this.view.time_s - this.start_s) / this.step_s); }

  seek(time_s) {
    const last = this.start_s + (this.n_frames - 1) * this.step_s;
    this.view.time_s = Math.max(this.start_s, Math.min(last, time_s));
    this.stale = true;
    this.ask();
  }

  goTo(frame) { this.seek(this.start_s + frame * this.step_s); }

  play() {
    if (this.frame >= this.n_frames - 1) this.goTo(0);
    this.playing = true;
    this.before_ms = null;
    this.ask();
  }

  pause() {
    this.playing = false;
    this.goTo(this.frame);
  }

  changed() { this.stale = true; this.relabel = true; this.ask(); }

  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame((now_ms) => { this.asked = false; this.tick(now_ms); });
  }

  tick(now_ms) {
    if (this.playing) {
      const passed_s = this.before_ms === null ? 0 : (now_ms - this.before_ms) / 1000;
      this.before_ms = now_ms;
      this.seek(this.view.time_s + passed_s * this.speed);
      if (this.frame >= this.n_frames - 1) this.playing = false;
    }
    if (this.stale) this.show();
    if (this.playing) this.ask();
  }

  show() {
    this.stale = false;
    if (this.view.follow) this.follow();
    this.painter.frame(this.view);
    const by = courtside.byId;
    by("slider").value = this.frame;
    by("slider").setAttribute("aria-valuetext", `${this.view.time_s.toFixed(2)} seconds`);
    by("clock").textContent = `${this.view.time_s.toFixed(3)} s`;
    by("play").textContent = this.playing ? "Pause" : "Play";
    by("play").setAttribute("aria-pressed", String(this.playing));
    by("readout").replaceChildren(...readout(this.view));
    if (this.relabel) {
      by("legend").replaceChildren(...legend(this.view, this.scene));
      by("layers").classList.toggle("unpainted", this.view.colour === "side");
    }
    this.relabel = false;
  }

  /** Keep the middle of the chosen person, or of the first, in the middle of the picture. */
  follow() {
    const layer = this.view.layers.find((one) => one.shown);
    if (!layer) return;
    const person = Math.max(0, layer.persons.indexOf(this.view.person));
    const frame = layer.frameAt(this.view.time_s);
    const places = layer.joints.map((_, joint) => layer.position(person, joint, frame)).filter(Boolean);
    if (!places.length) return;
    this.eye.target = [0, 1, 2].map((axis) => {
      const values = places.map((place) => place[axis]);
      return (Math.min(...values) + Math.max(...values)) / 2;
    });
    this.eye.update();
  }

  /** Pick the joint nearest to a place in the canvas, px; none within 14 px leaves what was picked. */
  pick(x, y) {
    let best = null, least = 14;
    for (const one of this.painter.drawn) {
      const distance = Math.hypot(one.x - x, one.y - y);
      if (distance < least) [best, least] = [one, distance];
    }
    if (best) this.choose(best.layer.persons[best.person], best.layer.joints[best.joint]);
  }

  choose(person, joint) {
    this.view.person = person;
    this.view.picked = joint ? { person, joint } : null;
    courtside.byId("person").value = person;
    courtside.byId("joint").value = joint;
    this.changed();
  }

  look(name) {
    const { cameras, middle } = this.scene;
    const camera = cameras.find((one) => `camera ${one.name}` === name);
    if (camera) this.eye.through(camera, middle);
    else if (name !== "free") {
      const [azimuth, elevation] = { all: [-1.0, 0.35], above: [-Math.PI / 2, 1.5707], x: [-Math.PI / 2, 0.02], y: [0, 0.02], hall: [-1.0, 0.45] }[name];
      Object.assign(this.eye, { azimuth, elevation });
      this.eye.fit(name === "hall" ? this.whole() : this.around());
    }
    this.changed();
  }
}

function wireTime(viewer) {
  const by = courtside.byId;
  by("slider").max = viewer.n_frames - 1;
  by("slider").addEventListener("input", () => { viewer.playing = false; viewer.goTo(Number(by("slider").value)); });
  by("play").addEventListener("click", () => (viewer.playing ? viewer.pause() : viewer.play()));
  by("back").addEventListener("click", () => { viewer.pause(); viewer.goTo(viewer.frame - 1); });
  by("next").addEventListener("click", () => { viewer.pause(); viewer.goTo(viewer.frame + 1); });
  by("speed").addEventListener("change", () => { viewer.speed = Number(by("speed").value); });
}

function wirePanel(viewer) {
  const { view, scene } = viewer;
  const by = courtside.byId;
  const set = (key) => (value) => { view[key] = value; viewer.changed(); };
  by("layers").replaceChildren(...view.layers.map((layer) =>
    box(layer.name, layer.shown, (on) => viewer.switchLayer(layer, on), view.layerColour(layer))));
  const colours = [["side", "body side"], ["layer", "method"]];
  if (view.layers.some((layer) => layer.ellipsoid)) colours.push(["sigma", "expected error σ (mm)"]);
  if (view.layers.some((layer) => layer.error_px)) colours.push(["reprojection", "reprojection error (px)"]);
  if (view.layers.length > 1) colours.push(["distance", "distance (mm)"]);
  options(by("colour"), colours, view.colour);
  options(by("against"), view.layers.map((layer, at) => [at, layer.name]), 0);
  by("colour").addEventListener("change", () => {
    by("against-label").hidden = by("colour").value !== "distance";
    viewer.chooseColour(by("colour").value);
  });
  by("against").addEventListener("change", () => {
    view.against = view.layers[Number(by("against").value)];
    viewer.chooseColour("distance");
  });
  const views = [["all", "all movement"], ["hall", "the whole hall"], ["above", "from above"], ["x", "along y"], ["y", "along x"]];
  options(by("view"), [["free", "free"], ...views, ...scene.cameras.map(({ name }) => [`camera ${name}`, `camera ${name}`])], "all");
  by("view").addEventListener("change", () => viewer.look(by("view").value));
  by("cameras").addEventListener("change", () => set("cameras")(by("cameras").checked));
  by("follow").addEventListener("change", () => {
    view.follow = by("follow").checked;
    if (view.follow) Object.assign(viewer.eye, { distance: 4.5, focal: 1.3 });
    viewer.changed();
  });
  by("names").addEventListener("change", () => set("names")(by("names").checked));
  by("magnified").addEventListener("change", () => set("magnified")(Number(by("magnified").value)));
  by("trail").addEventListener("change", () => set("trail_s")(Number(by("trail").value)));
  by("notes").replaceChildren(...scene.notes.map((note) => element("li", { textContent: note })));
}

function wireJoints(viewer) {
  const { view } = viewer;
  const by = courtside.byId;
  const joints = [...new Set(view.layers.flatMap((layer) => layer.joints))];
  const persons = [...new Set(view.layers.flatMap((layer) => layer.persons))];
  options(by("person"), persons.map((name) => [name, name]), view.person);
  options(by("joint"), [["", "none"], ...joints.map((name) => [name, name.replaceAll("_", " ")])], "");
  for (const id of ["person", "joint"]) {
    by(id).addEventListener("change", () => viewer.choose(by("person").value, by("joint").value));
  }
  by("trails").replaceChildren(...joints.map((joint) => box(joint.replaceAll("_", " "), view.trails.has(joint), (on) => {
    if (on) view.trails.add(joint);
    else view.trails.delete(joint);
    viewer.changed();
  })));
}

function wireKeys(viewer) {
  const { eye, view } = viewer;
  const second = () => Math.max(1, Math.round(1 / viewer.step_s));
  const moved = (act) => () => { act(); courtside.byId("view").value = "free"; viewer.changed(); };
  const step = (count) => { viewer.pause(); viewer.goTo(viewer.frame + count); };
  const keys = {
    " ": () => (viewer.playing ? viewer.pause() : viewer.play()),
    ArrowLeft: (event) => step(event.shiftKey ? -second() : -1),
    ArrowRight: (event) => step(event.shiftKey ? second() : 1),
    Home: () => viewer.goTo(0),
    End: () => viewer.goTo(viewer.n_frames - 1),
    a: moved(() => eye.turn(0.1, 0)), d: moved(() => eye.turn(-0.1, 0)),
    w: moved(() => eye.turn(0, 0.07)), s: moved(() => eye.turn(0, -0.07)),
    "+": moved(() => eye.zoom(0.87)), "-": moved(() => eye.zoom(1.15)), f: () => viewer.look("all"),
  };
  /** @returns {NodeListOf<HTMLInputElement>} */
  const switches = () => document.querySelectorAll("#layers input");
  document.addEventListener("keydown", (event) => {
    const target = /** @type {Element} */ (event.target);
    const own = target.closest("select, textarea, input:not([type=range], [type=checkbox])");
    const presses = event.key === " " && target.closest("button, input[type=checkbox]");
    if (own || presses || event.ctrlKey || event.metaKey || event.altKey) return;
    const layer = view.layers[Number(event.key) - 1];
    const act = keys[event.key] || keys[event.key.toLowerCase()];
    if (act) act(event);
    else if (event.key >= "1" && event.key <= "9" && layer) switches()[layer.index].click();
    else return;
    event.preventDefault();
  });
}

function wireHand(viewer) {
  const { eye, painter } = viewer;
  const canvas = painter.canvas;
  const fingers = new Map();
  let travelled = 0;
  const moved = () => { courtside.byId("view").value = "free"; viewer.changed(); };
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    if (fingers.size === 1) travelled = 0;
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const now = [event.offsetX, event.offsetY];
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    travelled += Math.hypot(dx, dy);
    if (fingers.size > 1) {
      const other = [...fingers].find(([id]) => id !== event.pointerId)[1];
      const [was, is] = [before, now].map((place) => Math.hypot(place[0] - other[0], place[1] - other[1]));
      eye.zoom(was / Math.max(is, 1));
      eye.pan(dx / 2, dy / 2);
    } else if (event.shiftKey || event.buttons & 2) eye.pan(dx, dy);
    else eye.turn(dx * 0.008, dy * 0.008);
    fingers.set(event.pointerId, now);
    moved();
  });
  for (const name of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(name, (event) => {
      fingers.delete(event.pointerId);
      if (name === "pointerup" && travelled < 4) viewer.pick(event.offsetX, event.offsetY);
    });
  }
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    eye.zoom(Math.exp(event.deltaY * 0.0012));
    moved();
  }, { passive: false });
}

/** What `courtside.viewer` offers; pages/viewer/viewer.py says it in words. */
function hook(viewer) {
  const { view } = viewer;
  const find = (name) => view.layers.find((layer) => layer.name === name);
  const where = (layer, person, joint, frame) => [layer.persons.indexOf(person), layer.joints.indexOf(joint), frame];
  return {
    opened_ms: performance.now(),
    state: () => ({
      time_s: view.time_s, frame: viewer.frame, n_frames: viewer.n_frames, playing: viewer.playing, speed: viewer.speed,
      colour: view.colour, scale_end: view.end[view.colour] || null, picked: view.picked,
      layers: view.layers.map(({ name, shown }) => ({ name, shown })),
    }),
    seek: (time_s) => { viewer.seek(time_s); viewer.show(); },
    play: () => viewer.play(),
    pause: () => viewer.pause(),
    position: (name, person, joint, frame) => find(name).position(...where(find(name), person, joint, frame)),
    covariance: (name, person, joint, frame) => {
      const rows = find(name).factor(...where(find(name), person, joint, frame));
      return rows && rows.map((a) => rows.map((b) => a.reduce((sum, value, at) => sum + value * b[at], 0)));
    },
    reprojection_px: (name, person, joint, frame) => find(name).reprojectionPx(...where(find(name), person, joint, frame)),
    drawn: () => viewer.painter.drawn.map(({ layer, person, joint, x, y }) =>
      ({ layer: layer.name, person: layer.persons[person], joint: layer.joints[joint], x, y })),
  };
}

async function start() {
  if (typeof DecompressionStream === "undefined") {
    throw new Error("This browser is too old for this page: it needs Chrome 80, Edge 80, Safari 16.4, Firefox 113 or later.");
  }
  const scene = courtside.data("scene");
  const layers = await Promise.all(courtside.data("layers").map((layer, index) => Layer.unpack(layer, scene.middle, index)));
  const viewer = new Viewer(scene, layers);
  [wireTime, wirePanel, wireJoints, wireKeys, wireHand].forEach((wire) => wire(viewer));
  const adapt = () => { viewer.painter.adapt(); viewer.changed(); };
  new ResizeObserver(adapt).observe(viewer.painter.canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", adapt);
  // Paper has another size and is light; it does not wait for the next frame.
  matchMedia("print").addEventListener("change", () => { adapt(); viewer.show(); });
  viewer.relabel = true;
  viewer.show();
  Object.assign(courtside.viewer, hook(viewer));
}

courtside.viewer = {};
courtside.viewer.ready = start().catch((fault) => {
  const message = courtside.byId("message");
  message.textContent = fault.message;
  message.hidden = false;
  console.error(fault);
});
