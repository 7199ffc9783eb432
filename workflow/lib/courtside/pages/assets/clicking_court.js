// @ts-check
"use strict";
// Drawings of the court: from above with its named points, and the chosen point magnified with the edges it names.
const clickCourt = (() => {
  const SPACE = "http://www.w3.org/2000/svg";
  const SKETCH_LINES = 4; // half the sketch's side, in widths of a line
  const POST_M = 0.04;

  function make(parent, tag, attributes, words) {
    const element = document.createElementNS(SPACE, tag);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    if (words !== undefined) element.textContent = words;
    parent.append(element);
    return element;
  }

  // From metres seen from above (x right, y up) to the drawing, turned by quarters clockwise.
  function turned(quarters) {
    const [c, s] = [[1, 0], [0, 1], [-1, 0], [0, -1]][quarters % 4];
    return ([x, y]) => [c * x + s * y, s * x - c * y];
  }

  function rectangle(parent, to, [x0, y0, x1, y1], name, least = 0) {
    const [a, b] = [to([x0, y0]), to([x1, y1])];
    const [x, y, w, h] = [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.abs(a[0] - b[0]), Math.abs(a[1] - b[1])];
    const [gx, gy] = [Math.max(0, least - w) / 2, Math.max(0, least - h) / 2];
    return make(parent, "rect", { x: x - gx, y: y - gy, width: w + 2 * gx, height: h + 2 * gy, class: name });
  }

  function line(parent, to, from, until, name, width, dash) {
    const [a, b] = [to(from), to(until)];
    const dashes = dash ? { "stroke-dasharray": dash } : {};
    return make(parent, "line", { x1: a[0], y1: a[1], x2: b[0], y2: b[1], class: name, "stroke-width": width, ...dashes });
  }

  // The court from above; points above others are drawn beside them.
  function plan(svg, court, quarters, look, choose) {
    svg.replaceChildren();
    const to = turned(quarters);
    const length = Math.max(...court.size_m);
    const dot = 0.016 * length;
    const places = spots(court, length).map((place) => to(place));
    const corners = [[0, 0], court.size_m].map(to);
    const all = [...places, ...corners], room = [0.13 * length, 0.07 * length];
    const low = [0, 1].map((axis) => Math.min(...all.map((p) => p[axis])) - room[axis]);
    const high = [0, 1].map((axis) => Math.max(...all.map((p) => p[axis])) + room[axis]);
    svg.setAttribute("viewBox", [...low, high[0] - low[0], high[1] - low[1]].join(" "));
    for (const painted of court.lines_m) rectangle(svg, to, painted, "line", 0.006 * length);
    if (court.net) {
      const [left, right] = court.net.x_m, y = court.net.y_m;
      line(svg, to, [left, y], [right, y], "net", 0.004 * length, `${0.02 * length} ${0.012 * length}`);
    }
    const middle = to(court.size_m.map((value) => value / 2));
    const taken = places.map(([x, y]) => [x - dot, y - dot, x + dot, y + dot]);
    court.points.forEach((point, at) => {
      const place = places[at], foot = to(point.xyz);
      if (point.xyz[2] > 0) {
        make(svg, "line", { x1: foot[0], y1: foot[1], x2: place[0], y2: place[1], class: "post", "stroke-width": 0.004 * length });
      }
      const name = ["spot", ...look(point)].join(" ");
      const spot = make(svg, "circle", { cx: place[0], cy: place[1], r: dot, class: name, "stroke-width": 0.3 * dot });
      make(spot, "title", {}, `${point.name}: ${point.edges}`);
      const size = 0.042 * length, corner = freePlace(taken, place, place[0] < middle[0] - 1e-6, dot, [0.58 * size * point.name.length, 0.8 * size]);
      const chosen = look(point).includes("chosen") ? "chosen" : "";
      const text = make(svg, "text", { x: corner[0], y: corner[1], "font-size": size, class: chosen }, point.name);
      for (const element of [spot, text]) element.addEventListener("click", () => choose(point.name));
    });
  }

  // The lower left corner of a name beside its point, where nothing else is written yet.
  function freePlace(taken, [x, y], toLeft, dot, [w, h]) {
    const left = x - 1.4 * dot - w, right = x + 1.4 * dot, sides = toLeft ? [left, right] : [right, left];
    const up = y - 0.7 * dot, down = y + 0.7 * dot + h, over = y - 1.5 * dot, under = y + 1.5 * dot + h;
    const tried = [...sides.flatMap((u) => [[u, up], [u, down]]), [x - w / 2, over], [x - w / 2, under], [sides[0], over - h], [sides[0], under + h]];
    const box = (/** @type {number[]} */ [u, v]) => [u, v - h, u + w, v];
    const meets = (a) => taken.some((b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]);
    const best = tried.find((corner) => !meets(box(corner))) || tried[0];
    taken.push(box(best));
    return best;
  }

  // Where points are drawn on the plan, metres: raised ones moved outwards from those below.
  function spots(court, length) {
    return court.points.map(({ xyz }) => {
      const outwards = Math.sign(xyz[0] - court.size_m[0] / 2) || 1;
      return xyz[2] > 0 ? [xyz[0] + outwards * 0.075 * length, xyz[1]] : [xyz[0], xyz[1]];
    });
  }

  function sketch(svg, court, point, quarters) {
    svg.replaceChildren();
    if (point.xyz[2] > 0) return post(svg, court, point);
    const half = SKETCH_LINES * court.line_width_m, to = turned(quarters);
    const [x, y] = point.xyz, here = to(point.xyz);
    svg.setAttribute("viewBox", [here[0] - half, here[1] - half, 2 * half, 2 * half].join(" "));
    make(svg, "rect", { x: here[0] - 4 * half, y: here[1] - 4 * half, width: 8 * half, height: 8 * half, class: "floor" });
    for (const painted of court.lines_m) rectangle(svg, to, painted, "line");
    for (const mark of point.marks) {
      const ends = mark.axis === 0 ? [[mark.at_m, y - 4 * half], [mark.at_m, y + 4 * half]] : [[x - 4 * half, mark.at_m], [x + 4 * half, mark.at_m]];
      line(svg, to, ...ends, "edge", 0.03 * half, mark.side === 0 ? `${0.08 * half} ${0.06 * half}` : "");
    }
    if (point.on_post) {
      const [left, right] = court.net.x_m, ny = court.net.y_m;
      line(svg, to, [left, ny], [right, ny], "edge", 0.02 * half, `${0.02 * half} ${0.05 * half}`);
    }
    make(svg, "circle", { cx: here[0], cy: here[1], r: 0.09 * half, class: "at", "stroke-width": 0.035 * half });
    bar(svg, here[0] + 0.28 * half, here[1] + 0.86 * half, half);
    const width = Math.round(1000 * court.line_width_m);
    const dashed = point.marks.some((mark) => mark.side === 0) ? "; dashed: the middle of a line" : "";
    return `${point.name} from above, line ${width} mm wide${dashed}`;
  }

  function bar(svg, x, y, half) {
    make(svg, "rect", { x, y, width: 0.1, height: 0.03 * half, fill: "#111" });
    make(svg, "text", { x: x + 0.05, y: y - 0.04 * half, "font-size": 0.17 * half, "text-anchor": "middle" }, "10 cm");
  }

  // A post's tip from the side, the net towards the middle of the court.
  function post(svg, court, point) {
    const half = 0.16, inwards = Math.sign(court.size_m[0] / 2 - point.xyz[0]) || 1;
    svg.setAttribute("viewBox", [-half, -half, 2 * half, 2 * half].join(" "));
        make(svg, "rect", { x: -POST_M / 2, y: 0, width: POST_M, height: half, class: "post" });
    if (court.net) {
      const x = inwards > 0 ? POST_M / 2 : -half;
      make(svg, "rect", { x, y: 0, width: half - POST_M / 2, height: 0.075, class: "line" });
      make(svg, "rect", { x, y: 0.075, width: half - POST_M / 2, height: half, fill: "var(--line)" });
    }
    make(svg, "circle", { cx: 0, cy: 0, r: 0.09 * half, class: "at", "stroke-width": 0.035 * half });
    return `${point.name} from the side: the middle of the post's upper end, beside the tape of the net`;
  }

  return { plan, sketch };
})();
