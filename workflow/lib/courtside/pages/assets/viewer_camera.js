// @ts-check
"use strict";
/* The eye that looks at the scene: it circles about a target, z stays up. */

const NEAR_M = 0.05;
const MARGIN = 0.82; // of the canvas that a fitted scene takes up
const LOWEST = -0.2; // elevation of an eye that is turned by hand, radians: just below the floor

class Eye {
  constructor() {
    this.target = [0, 0, 1];
    this.azimuth = -1.0; // from where it looks, radians, 0 = from +x
    this.elevation = 0.35;
    this.lowest = LOWEST;
    this.distance = 8;
    this.focal = 1.3; // of the canvas's shorter side
    this.size = [1, 1];
    this.update();
  }

  update() {
    this.elevation = Math.max(this.lowest, Math.min(Math.PI / 2 - 1e-3, this.elevation));
    this.distance = Math.max(0.3, Math.min(200, this.distance));
    const [ca, sa] = [Math.cos(this.azimuth), Math.sin(this.azimuth)];
    const [ce, se] = [Math.cos(this.elevation), Math.sin(this.elevation)];
    this.forward = [-ce * ca, -ce * sa, -se];
    this.right = [-sa, ca, 0];
    this.up = [-se * ca, -se * sa, ce];
    this.place = this.target.map((value, axis) => value - this.distance * this.forward[axis]);
    this.scale = this.focal * Math.min(...this.size);
  }

  /** Metres in the world -> right, down, depth in metres as the eye has them. */
  seen(point) {
    const [x, y, z] = [point[0] - this.place[0], point[1] - this.place[1], point[2] - this.place[2]];
    return [
      x * this.right[0] + y * this.right[1] + z * this.right[2],
      -(x * this.up[0] + y * this.up[1] + z * this.up[2]),
      x * this.forward[0] + y * this.forward[1] + z * this.forward[2],
    ];
  }

  onCanvas(seen) {
    const factor = this.scale / seen[2];
    return [this.size[0] / 2 + factor * seen[0], this.size[1] / 2 + factor * seen[1]];
  }

  /** Metres -> [x px, y px, depth m], null behind the eye. */
  project(point) {
    const seen = this.seen(point);
    return seen[2] > NEAR_M ? [...this.onCanvas(seen), seen[2]] : null;
  }

  /** The part of a polygon (or of a line, closed = false) that lies before the eye, px. */
  clipped(points, closed) {
    const seen = points.map((point) => this.seen(point));
    const kept = [];
    const last = closed ? seen.length : seen.length - 1;
    if (!closed && seen[0][2] > NEAR_M) kept.push(seen[0]);
    for (let i = 0; i < last; i++) {
      const [a, b] = [seen[i], seen[(i + 1) % seen.length]];
      if ((a[2] > NEAR_M) !== (b[2] > NEAR_M)) {
        const share = (NEAR_M * 1.001 - a[2]) / (b[2] - a[2]);
        kept.push(a.map((value, axis) => value + share * (b[axis] - value)));
      }
      if (b[2] > NEAR_M) kept.push(b);
    }
    return kept.map((one) => this.onCanvas(one));
  }

  turn(dx, dy) {
    this.azimuth -= dx;
    this.elevation += dy;
    this.update();
  }

  /** Move the target with the hand: px. */
  pan(dx, dy) {
    const metres = this.distance / this.scale;
    this.target = this.target.map((value, axis) =>
      value - metres * (dx * this.right[axis] - dy * this.up[axis]));
    this.update();
  }

  zoom(factor) {
    this.distance *= factor;
    this.update();
  }

  /** Move back until points, metres, just fill the canvas, seen from the same side. */
  fit(points) {
    this.focal = 1.3;
    this.lowest = LOWEST;
    const low = [0, 1, 2].map((axis) => Math.min(...points.map((point) => point[axis])));
    const high = [0, 1, 2].map((axis) => Math.max(...points.map((point) => point[axis])));
    this.target = low.map((value, axis) => (value + high[axis]) / 2);
    this.distance = 2 * Math.hypot(...low.map((value, axis) => high[axis] - value)) + 1;
    for (let round = 0; round < 12; round++) {
      this.update();
      const on = points.map((point) => this.project(point)).filter(Boolean);
      const [left, top] = [0, 1].map((axis) => Math.min(...on.map((spot) => spot[axis])));
      const [right, bottom] = [0, 1].map((axis) => Math.max(...on.map((spot) => spot[axis])));
      this.pan(this.size[0] / 2 - (left + right) / 2, this.size[1] / 2 - (top + bottom) / 2);
      const filled = Math.max((right - left) / this.size[0], (bottom - top) / this.size[1]) / MARGIN;
      this.distance *= Math.max(0.6, Math.min(1.6, filled));
    }
    this.update();
  }

  /** Look from where a camera stands, along its axis; the picture's tilt to the side is left out. */
  through(camera, middle) {
    const reach = Math.hypot(...middle.map((value, axis) => value - camera.centre[axis]));
    this.distance = Math.max(1, reach);
    const [x, y, z] = camera.forward;
    this.elevation = Math.asin(-z);
    this.lowest = Math.min(LOWEST, this.elevation); // a low camera looks up
    this.azimuth = Math.atan2(-y, -x);
    this.target = camera.centre.map((value, axis) => value + this.distance * camera.forward[axis]);
    this.focal = camera.focal;
    this.update();
  }
}
