// @ts-check
"use strict";
/* Unpacks what pages/viewer/packing.py and pages/viewer/layers.py pack. */

const LEAST = 1e-5, MOST = 10, LEVELS = 254, ANGLES = 255, STEP_M = 0.001, PX = 0.01;
const SAME_S = 1e-4; // apart, at most, of times that are one: they are rounded
const LONGEST_STEP_S = 0.045; // or 1.5 usual steps: without a gap, as in video/glance.py

/** Base64 of a zlib stream -> Int16Array of rows of `length` numbers, given by their changes. */
async function integers(text, length) {
  const letters = atob(text);
  const packed = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i++) packed[i] = letters.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const n = planes.length / 2;
  const values = new Int16Array(n);
  for (let row = 0; row < n; row += length) {
    let sum = 0;
    for (let i = row; i < row + length; i++) {
      sum += planes[i] | (planes[n + i] << 8);
      values[i] = sum; // an Int16Array keeps the low 16 bits: the changes are modulo 2^16
    }
  }
  return values;
}

/** A level of the logarithmic scale -> the number, NaN where unknown. */
function sizeOf(level) {
  return level > 0 ? LEAST * (MOST / LEAST) ** ((level - 1) / LEVELS) : NaN;
}

/** One method's skeletons over time. */
class Layer {
  /** @type {string} */ name;
  /** @type {string[]} */ joints;
  /** @type {string[]} */ persons;
  /** @type {number[]} */ time_s;
  /** @type {number} number of frames */ length;
  /** @type {number} place among the layers of the page */ index;
  /** @type {number[]} the point, metres, that places are packed about */ middle;
  /** @type {Int16Array} */ xyz;
  /** @type {Int16Array} 1 where the joint is known */ known;
  /** @type {Int16Array} */ reason;
  /** @type {Int16Array | undefined} */ ellipsoid;
  /** @type {Int16Array | undefined} */ error_px;
  /** @type {Int16Array | undefined} */ n_views;

  static async unpack(content, middle, index) {
    const layer = new Layer();
    Object.assign(layer, content, { middle, index, length: content.time_s.length });
    const keys = ["xyz", "known", "reason", "ellipsoid", "error_px", "n_views"].filter((key) => content[key]);
    const arrays = await Promise.all(keys.map((key) => integers(content[key], layer.length)));
    keys.forEach((key, at) => { layer[key] = arrays[at]; });
    return layer;
  }

  /** Indices of the frames before and after a time; of the first or last two beyond the ends. */
  around(time_s) {
    const times = this.time_s;
    let low = 0, high = times.length - 1;
    while (high - low > 1) {
      const half = (low + high) >> 1;
      if (times[half] <= time_s) low = half; else high = half;
    }
    return [low, high];
  }

  /** Mean time between two frames, s. */
  get step_s() {
    const times = this.time_s;
    return times.length > 1 ? (times[times.length - 1] - times[0]) / (times.length - 1) : 0.1;
  }

  /** Index of the frame nearest to a time; -1 where none is near enough to stand for it. */
  frameAt(time_s) {
    const times = this.time_s;
    const [low, high] = this.around(time_s);
    const at = time_s - times[low] <= times[high] - time_s ? low : high;
    return Math.abs(times[at] - time_s) <= Math.max(this.step_s, 0.02) ? at : -1;
  }

  /** Time of the first frame that shows a joint; of the first frame if none does. */
  get firstShown_s() {
    const { length, known } = this;
    let first = length;
    for (let row = 0; row < known.length; row += length) {
      for (let frame = 0; frame < first; frame++) if (known[row + frame]) first = frame;
    }
    return this.time_s[first < length ? first : 0];
  }

  at(person, joint, frame) { return (person * this.joints.length + joint) * this.length + frame; }

  /** Metres, or null where the joint is missing. */
  position(person, joint, frame) {
    if (frame < 0 || !this.known[this.at(person, joint, frame)]) return null;
    const row = (person * this.joints.length + joint) * 3;
    return [0, 1, 2].map((axis) => this.middle[axis] + STEP_M * this.xyz[(row + axis) * this.length + frame]);
  }

  /** Metres at a time, between the frames around it; null where one is missing or there is a gap. */
  positionAt(person, joint, time_s) {
    const [low, high] = this.around(time_s);
    const span = this.time_s[high] - this.time_s[low];
    const share = span > 0 ? (time_s - this.time_s[low]) / span : 0;
    const nearest = share > 0.5 ? high : low;
    if (Math.abs(time_s - this.time_s[nearest]) <= SAME_S) return this.position(person, joint, nearest);
    if (share < 0 || share > 1 || span > Math.max(1.5 * this.step_s, LONGEST_STEP_S)) return null;
    const [before, after] = [this.position(person, joint, low), this.position(person, joint, high)];
    return before && after ? before.map((value, axis) => value + share * (after[axis] - value)) : null;
  }

  level(key, depth, person, joint, frame) {
    const row = (person * this.joints.length + joint) * 6 + depth;
    return this[key][row * this.length + frame];
  }

  /** Lower triangular factor of the covariance (3 rows, metres), null where unknown. */
  factor(person, joint, frame) {
    if (!this.ellipsoid || frame < 0 || !this.known[this.at(person, joint, frame)]) return null;
    const [x, y, z, a, b, c] = [0, 1, 2, 3, 4, 5].map((depth) => this.level("ellipsoid", depth, person, joint, frame));
    if (!x) return null;
    const [sx, sy, sz] = [x, y, z].map(sizeOf);
    const [ra, rb, rc] = [a, b, c].map((level) => level * Math.PI / ANGLES);
    return [
      [sx, 0, 0],
      [sy * Math.cos(ra), sy * Math.sin(ra), 0],
      [sz * Math.cos(rb), sz * Math.sin(rb) * Math.cos(rc), sz * Math.sin(rb) * Math.sin(rc)],
    ];
  }

  /** Standard deviations along x, y, z, metres; null where unknown. */
  sigmas(person, joint, frame) {
    if (!this.ellipsoid || frame < 0 || !this.known[this.at(person, joint, frame)]) return null;
    const found = [0, 1, 2].map((depth) => sizeOf(this.level("ellipsoid", depth, person, joint, frame)));
    return Number.isFinite(found[0]) ? found : null;
  }

  /** Root of the mean squared distance to be expected from the true place, mm. */
  sigmaMm(person, joint, frame) {
    const found = this.sigmas(person, joint, frame);
    return found ? 1000 * Math.hypot(...found) : NaN;
  }

  reprojectionPx(person, joint, frame) {
    if (!this.error_px || frame < 0 || !this.known[this.at(person, joint, frame)]) return NaN;
    return sizeOf(this.error_px[this.at(person, joint, frame)]) / PX;
  }

  /** Distance to the same joint of the same person in another layer at the same time, mm. */
  distanceMm(other, person, joint, frame) {
    const here = this.position(person, joint, frame);
    const p = other.persons.indexOf(this.persons[person]);
    const j = other.joints.indexOf(this.joints[joint]);
    if (!here || p < 0 || j < 0) return NaN;
    const there = other.positionAt(p, j, this.time_s[frame]);
    return there ? 1000 * Math.hypot(here[0] - there[0], here[1] - there[1], here[2] - there[2]) : NaN;
  }
}
