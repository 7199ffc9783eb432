// @ts-check
"use strict";
// How well the clicks of one picture fit the court: a homography of floor points, or a camera with a lens.
const clickFit = (() => {
  const LENS_FROM = 7; // points, from which a camera is fitted: pose, focal length and k1 are 8 numbers
  const FLOOR_FROM = 4; // of them at least so many on the floor, for the start
  const STEPS = 40;

  const onFloor = (point) => Math.abs(point.xyz[2]) < 1e-9;

  // ---- small linear algebra ----
  function solve(matrix, right) {
    const n = right.length;
    const a = matrix.map((row, at) => [...row, right[at]]);
    for (let col = 0; col < n; col += 1) {
      let best = col;
      for (let row = col + 1; row < n; row += 1) if (Math.abs(a[row][col]) > Math.abs(a[best][col])) best = row;
      if (Math.abs(a[best][col]) < 1e-300) return null;
      [a[col], a[best]] = [a[best], a[col]];
      for (let row = col + 1; row < n; row += 1) {
        const factor = a[row][col] / a[col][col];
        for (let at = col; at <= n; at += 1) a[row][at] -= factor * a[col][at];
      }
    }
    const x = new Array(n).fill(0);
    for (let row = n - 1; row >= 0; row -= 1) {
      let sum = a[row][n];
      for (let at = row + 1; at < n; at += 1) sum -= a[row][at] * x[at];
      x[row] = sum / a[row][row];
    }
    return x;
  }

  // Least squares by Levenberg and Marquardt with numerical derivatives; `far` gives the residuals of parameters.
  function descend(start, far, scale) {
    const square = (r) => r.reduce((sum, value) => sum + value * value, 0);
    let p = [...start], r = far(p), cost = square(r), damping = 1e-3;
    for (let step = 0; step < STEPS && Number.isFinite(cost); step += 1) {
      const columns = p.map((value, at) => {
        const moved = [...p];
        moved[at] = value + scale[at];
        return far(moved).map((residual, row) => (residual - r[row]) / scale[at]);
      });
      const normal = columns.map((a) => columns.map((b) => a.reduce((sum, value, row) => sum + value * b[row], 0)));
      const gradient = columns.map((a) => -a.reduce((sum, value, row) => sum + value * r[row], 0));
      let better = false;
      while (!better && damping < 1e9) {
        const damped = normal.map((row, i) => row.map((value, j) => (i === j ? value * (1 + damping) + 1e-12 : value)));
        const move = solve(damped, gradient);
        const next = move && p.map((value, at) => value + move[at]);
        const residual = next && far(next);
        const nextCost = residual ? square(residual) : Infinity;
        if (nextCost < cost) {
          better = true;
          const gain = (cost - nextCost) / (cost + 1e-12);
          [p, r, cost] = [next, residual, nextCost];
          damping = Math.max(damping / 10, 1e-9);
          if (gain < 1e-9) return { p, r, cost };
        } else damping *= 10;
      }
      if (!better) break;
    }
    return { p, r, cost };
  }

  // ---- homography of the floor ----
  function normaliser(values) {
    const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
    const spread = Math.sqrt(values.reduce((sum, value) => sum + (value - mean) ** 2, 0) / values.length) || 1;
    return [mean, spread];
  }

  function homography(points) {
    const floor = points.filter(onFloor);
    if (floor.length < FLOOR_FROM) return null;
    const [mx, sx] = normaliser(floor.map((p) => p.xyz[0]));
    const [my, sy] = normaliser(floor.map((p) => p.xyz[1]));
    const [mu, su] = normaliser(floor.map((p) => p.xy[0]));
    const [mv, sv] = normaliser(floor.map((p) => p.xy[1]));
    const mapped = (h, xyz) => {
      const x = (xyz[0] - mx) / sx, y = (xyz[1] - my) / sy, w = h[6] * x + h[7] * y + 1;
      return w > 1e-9 ? [mu + su * (h[0] * x + h[1] * y + h[2]) / w, mv + sv * (h[3] * x + h[4] * y + h[5]) / w] : null;
    };
    // Linear start: the origin of the normalised plane is in the picture, so the last element is not 0.
    const rows = [], right = [];
    for (const { xyz, xy } of floor) {
      const x = (xyz[0] - mx) / sx, y = (xyz[1] - my) / sy, u = (xy[0] - mu) / su, v = (xy[1] - mv) / sv;
      rows.push([x, y, 1, 0, 0, 0, -u * x, -u * y], [0, 0, 0, x, y, 1, -v * x, -v * y]);
      right.push(u, v);
    }
    const normal = rows[0].map((_, i) => rows[0].map((__, j) => rows.reduce((sum, row) => sum + row[i] * row[j], 0)));
    const start = solve(normal, rows[0].map((_, i) => rows.reduce((sum, row, at) => sum + row[i] * right[at], 0)));
    if (!start || !start.every(Number.isFinite)) return null;
    const far = (h) => floor.flatMap(({ xyz, xy }) => {
      const at = mapped(h, xyz);
      return at ? [at[0] - xy[0], at[1] - xy[1]] : [1e4, 1e4];
    });
    const best = descend(start, far, new Array(8).fill(1e-6));
    return {
      kind: "floor", used: floor, cost: best.cost, parameters: 8,
      project: (xyz) => (Math.abs(xyz[2]) < 1e-9 ? mapped(best.p, xyz) : null),
      // Columns of the matrix from metres to pixels.
      columns: () => {
        const [a, b, c, d, e, f, g, h] = best.p;
        const row = (s, m, p0, p1, p2) => [(s * p0 + m * g) / sx, (s * p1 + m * h) / sy, s * p2 + m];
        const r0 = row(su, mu, a, b, c), r1 = row(sv, mv, d, e, f), r2 = [g / sx, h / sy, 1];
        const shift = (r) => r[2] - r[0] * mx - r[1] * my;
        return [[r0[0], r1[0], r2[0]], [r0[1], r1[1], r2[1]], [shift(r0), shift(r1), shift(r2)]];
      },
    };
  }

  // ---- camera: pose, focal length, k1; principal point in the picture's middle ----
  function rotation([x, y, z]) {
    const angle = Math.hypot(x, y, z);
    const a = angle < 1e-12 ? 1 : Math.sin(angle) / angle;
    const b = angle < 1e-6 ? 0.5 : (1 - Math.cos(angle)) / (angle * angle);
    const c = Math.cos(angle);
    return [
      [c + b * x * x, b * x * y - a * z, b * x * z + a * y],
      [b * x * y + a * z, c + b * y * y, b * y * z - a * x],
      [b * x * z - a * y, b * y * z + a * x, c + b * z * z],
    ];
  }

  function through(camera, xyz) {
    const [x, y, z] = camera.R.map((row, at) => row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2] + camera.t[at]);
    if (z <= 1e-6) return null;
    const u = x / z, v = y / z, lens = 1 + camera.k1 * (u * u + v * v);
    return [camera.c[0] + camera.f * lens * u, camera.c[1] + camera.f * lens * v];
  }

  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const times = (m, n) => m.map((row) => [0, 1, 2].map((j) => row[0] * n[0][j] + row[1] * n[1][j] + row[2] * n[2][j]));

  function posed(plane, f, c) {
    const columns = plane.columns().map((col) => [(col[0] - c[0] * col[2]) / f, (col[1] - c[1] * col[2]) / f, col[2]]);
    const scale = Math.sqrt(Math.sqrt(dot(columns[0], columns[0]) * dot(columns[1], columns[1])));
    // Depths of the points are positive; that of the court's origin need not be.
    let [a, b, t] = columns.map((col) => col.map((value) => value / scale));
    const unit = (v) => { const n = Math.hypot(...v); return v.map((value) => value / n); };
    a = unit(a);
    b = unit(b.map((value, at) => value - dot(a, b) * a[at]));
    const n = cross(a, b);
    return { R: [0, 1, 2].map((at) => [a[at], b[at], n[at]]), t, f, k1: 0, c };
  }

  function refined(start, points, size) {
    const at = (p) => ({
      R: times(rotation(p), start.R), t: start.t.map((value, i) => value + p[3 + i]),
      f: start.f * Math.exp(p[6]), k1: start.k1 + p[7], c: start.c,
    });
    const far = (p) => {
      const camera = at(p);
      const off = points.flatMap(({ xyz, xy }) => {
        const seen = through(camera, xyz);
        return seen ? [seen[0] - xy[0], seen[1] - xy[1]] : [1e4, 1e4];
      });
      // Weak knowledge, so that few points on a plane cannot ask for an absurd lens.
      off.push(0.3 * Math.log(camera.f / size[0]), camera.k1 / 0.3);
      return off;
    };
    const found = descend(new Array(8).fill(0), far, [1e-6, 1e-6, 1e-6, 1e-5, 1e-5, 1e-5, 1e-6, 1e-6]);
    return { camera: at(found.p), cost: found.r.slice(0, -2).reduce((sum, value) => sum + value * value, 0) };
  }

  function camera(points, size, from) {
    let start = from;
    if (!start) {
      const plane = homography(points);
      if (!plane) return null;
      const c = [(size[0] - 1) / 2, (size[1] - 1) / 2];
      const cost = (tried) => points.reduce((sum, { xyz, xy }) => {
        const seen = through(tried, xyz);
        return sum + (seen ? Math.min((seen[0] - xy[0]) ** 2 + (seen[1] - xy[1]) ** 2, 1e6) : 1e6);
      }, 0);
      const tried = [0.5, 0.65, 0.8, 0.95, 1.1, 1.3, 1.6, 2, 2.6].map((share) => posed(plane, share * size[0], c));
      start = tried.reduce((best, next) => (cost(next) < cost(best) ? next : best));
    }
    const found = refined(start, points, size);
    if (!Number.isFinite(found.cost)) return null;
    return {
      kind: "camera", used: points, cost: found.cost, parameters: 8, found: found.camera,
      project: (xyz) => through(found.camera, xyz),
    };
  }

  function model(points, size, from) {
    if (points.length >= LENS_FROM && points.filter(onFloor).length >= FLOOR_FROM) {
      const found = camera(points, size, from);
      if (found) return found;
    }
    return homography(points);
  }

  const distance = (a, b) => (a && b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : NaN);

  // Returns {kind, project, residual by name, rms, worst}; null where too few points are known.
  function fit(points, size) {
    const found = model(points, size);
    if (!found) return null;
    const residual = Object.fromEntries(found.used.map((p) => [p.name, distance(found.project(p.xyz), p.xy)]));
    const n = found.used.length, spare = 2 * n - found.parameters;
    const values = Object.values(residual);
    const rms = Math.sqrt(values.reduce((sum, value) => sum + value * value, 0) / n);
    return { kind: found.kind, project: found.project, residual, n, spare, rms, worst: spare >= 4 ? worst(found, size) : null };
  }

  // The point without which the others agree best; and whether that is more than chance.
  function worst(found, size) {
    const n = found.used.length, spare = 2 * n - found.parameters - 2;
    let best = null;
    for (const left of found.used) {
      const others = found.used.filter((p) => p !== left);
      const again = found.kind === "camera" ? camera(others, size, found.found) : homography(others);
      if (again && (!best || again.cost < best.cost)) best = { name: left.name, cost: again.cost, again, left };
    }
    if (!best) return null;
    const off = distance(best.again.project(best.left.xyz), best.left.xy);
    const ratio = (found.cost - best.cost) / 2 / (best.cost / spare + 0.01);
    return { name: best.name, off, rms: Math.sqrt(best.cost / (n - 1)), suspicious: off > 1.5 && ratio > 12 };
  }

  return { fit, FLOOR_FROM };
})();
