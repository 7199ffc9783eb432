// @ts-check
"use strict";
// A picture on a canvas: zoom, pan, pinch, pixel grid, marks, magnifier. Pixel (0, 0) has its middle at (0, 0).
const clickView = (() => {
  const CLICK_PX = 4; // a pointer that moves no farther clicks
  const MOST = 64; // screen px per picture px
  const PIXELS_FROM = 3; // scale from which pixels are drawn as squares
  const GRID_FROM = 8;
  const LOUPE_UNTIL = 12;
  const MARK = "#ff2d8f", PLACED = "#00d0ff", PROPOSED = "#ffe04a", PREDICTED = "rgb(255 255 255 / 80%)";

  function create(canvas, loupe, on) {
    const context = canvas.getContext("2d"), glass = loupe.getContext("2d");
    const pointers = new Map();
    let image = null, size = [1, 1], scale = 1, shift = [0, 0], marks = [], cursor = null, moved = 0, pinch = null;
    let showLoupe = true, waiting = false;

    const box = () => [canvas.clientWidth, canvas.clientHeight];
    const toScreen = (/** @type {number[]} */ [x, y]) => [(x + 0.5) * scale + shift[0], (y + 0.5) * scale + shift[1]];
    const toPicture = (/** @type {number[]} */ [u, v]) => [(u - shift[0]) / scale - 0.5, (v - shift[1]) / scale - 0.5];
    const least = () => Math.min(box()[0] / size[0], box()[1] / size[1]) * 0.9;
    const ratio = () => window.devicePixelRatio || 1;

    function limit() {
      scale = Math.min(Math.max(scale, least()), MOST);
      box().forEach((length, axis) => { // some of the picture always stays in view
        const extent = size[axis] * scale, kept = Math.min(80, extent / 2);
        shift[axis] = Math.min(Math.max(shift[axis], kept - extent), length - kept);
      });
    }

    function draw() {
      if (waiting) return;
      waiting = true;
      requestAnimationFrame(() => { waiting = false; paint(); });
    }

    function paint() {
      const [w, h] = box(), dpr = ratio();
      if (!w || !h || !image) return;
      if (canvas.width !== Math.round(w * dpr) || canvas.height !== Math.round(h * dpr)) {
        canvas.width = Math.round(w * dpr);
        canvas.height = Math.round(h * dpr);
      }
      context.setTransform(dpr, 0, 0, dpr, 0, 0);
      context.clearRect(0, 0, w, h);
      context.imageSmoothingEnabled = scale < PIXELS_FROM;
      context.imageSmoothingQuality = "high";
      context.drawImage(image, shift[0], shift[1], size[0] * scale, size[1] * scale);
      if (scale >= GRID_FROM) grid(w, h);
      for (const mark of marks) paintMark(context, mark, toScreen(mark.xy));
      paintLoupe();
      on.zoomed(scale);
    }

    function grid(w, h) {
      const [x0, y0] = toPicture([0, 0]).map((value) => Math.max(0, Math.floor(value + 0.5)));
      const [x1, y1] = toPicture([w, h]).map((value, axis) => Math.min(size[axis], Math.ceil(value + 0.5)));
      context.beginPath();
      for (let x = x0; x <= x1; x += 1) { const [u] = toScreen([x - 0.5, 0]); context.moveTo(u, toScreen([0, y0 - 0.5])[1]); context.lineTo(u, toScreen([0, y1 - 0.5])[1]); }
      for (let y = y0; y <= y1; y += 1) { const v = toScreen([0, y - 0.5])[1]; context.moveTo(toScreen([x0 - 0.5, 0])[0], v); context.lineTo(toScreen([x1 - 0.5, 0])[0], v); }
      context.lineWidth = 1;
      context.strokeStyle = "rgb(0 0 0 / 16%)";
      context.stroke();
    }

    // The middle stays free, so that what is marked can be seen.
    function paintMark(ctx, mark, /** @type {number[]} */ [u, v], big = 1) {
      const colour = mark.chosen ? MARK : { placed: PLACED, proposed: PROPOSED, predicted: PREDICTED }[mark.kind];
      const reach = (mark.chosen ? 13 : 9) * big, free = (mark.kind === "placed" ? 3 : 5) * big;
      const outline = () => {
        ctx.beginPath();
        if (mark.kind === "predicted") ctx.setLineDash([2, 3]);
        else if (mark.kind === "proposed") ctx.arc(u, v, reach * 0.75, 0, 7);
        for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
          ctx.moveTo(u + dx * free, v + dy * free);
          ctx.lineTo(u + dx * reach, v + dy * reach);
        }
        ctx.stroke();
        ctx.setLineDash([]);
      };
      ctx.lineWidth = 3.5; ctx.strokeStyle = "rgb(0 0 0 / 55%)"; outline();
      ctx.lineWidth = 1.5; ctx.strokeStyle = colour; outline();
      if (mark.kind === "placed") {
        ctx.beginPath(); ctx.arc(u, v, 1, 0, 7); ctx.fillStyle = colour; ctx.fill();
      }
      if (big === 1) {
        ctx.font = `${mark.chosen ? "bold " : ""}12px system-ui, sans-serif`;
        ctx.lineWidth = 3; ctx.strokeStyle = "rgb(0 0 0 / 65%)";
        ctx.strokeText(mark.name, u + 8, v - 8);
        ctx.fillStyle = colour; ctx.fillText(mark.name, u + 8, v - 8);
      }
    }

    function paintLoupe() {
      const chosen = marks.find((mark) => mark.chosen);
      const at = cursor || (chosen && toScreen(chosen.xy));
      loupe.hidden = !showLoupe || !at || scale >= LOUPE_UNTIL;
      if (loupe.hidden) return;
      const side = loupe.clientWidth, dpr = ratio();
      loupe.width = loupe.height = Math.round(side * dpr);
      const close = Math.max(12, Math.min(32, 4 * scale)), middle = toPicture(at);
      glass.setTransform(dpr, 0, 0, dpr, 0, 0);
      glass.fillStyle = "#24282d";
      glass.fillRect(0, 0, side, side);
      glass.imageSmoothingEnabled = false;
      const corner = middle.map((value) => side / 2 - (value + 0.5) * close);
      glass.drawImage(image, corner[0], corner[1], size[0] * close, size[1] * close);
      for (const mark of marks) paintMark(glass, mark, mark.xy.map((value, axis) => (value + 0.5) * close + corner[axis]), 1.01);
      glass.strokeStyle = "rgb(255 255 255 / 70%)";
      glass.lineWidth = 1;
      glass.beginPath();
      for (const [dx, dy] of [[1, 0], [0, 1]]) {
        for (const s of [-1, 1]) { glass.moveTo(side / 2 + s * 8 * dx, side / 2 + s * 8 * dy); glass.lineTo(side / 2 + s * side * dx, side / 2 + s * side * dy); }
      }
      glass.stroke();
      loupe.classList.toggle("left", at[0] > box()[0] / 2);
    }

    function zoomAt(factor, /** @type {number[]} */ [u, v]) {
      const [x, y] = toPicture([u, v]);
      scale = Math.min(Math.max(scale * factor, least()), MOST);
      shift = [u - (x + 0.5) * scale, v - (y + 0.5) * scale];
      limit();
      draw();
    }

    function inside(event) {
      const { left, top } = canvas.getBoundingClientRect();
      return [event.clientX - left, event.clientY - top];
    }

    function spread() {
      const [a, b] = [...pointers.values()];
      return { middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], apart: Math.hypot(a[0] - b[0], a[1] - b[1]) || 1 };
    }

    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      if (!pointers.size) moved = event.button === 0 ? 0 : Infinity; // other buttons drag only
      pointers.set(event.pointerId, inside(event));
      pinch = pointers.size === 2 ? spread() : null;
      if (pinch) moved = Infinity;
    });
    canvas.addEventListener("pointermove", (event) => {
      const here = inside(event), before = pointers.get(event.pointerId);
      cursor = here;
      if (before && !pinch) {
        moved = Math.max(moved, Math.hypot(here[0] - before[0], here[1] - before[1]));
        if (moved > CLICK_PX) {
          shift = shift.map((value, axis) => value + here[axis] - before[axis]);
          pointers.set(event.pointerId, here);
          limit();
        }
      } else if (before) {
        pointers.set(event.pointerId, here);
        const now = spread();
        shift = shift.map((value, axis) => value + now.middle[axis] - pinch.middle[axis]);
        zoomAt(now.apart / pinch.apart, now.middle);
        pinch = now;
      }
      on.pointed(toPicture(here));
      draw();
    });
    const lift = (event) => {
      const clicked = event.type === "pointerup" && pointers.has(event.pointerId) && moved <= CLICK_PX;
      pointers.delete(event.pointerId);
      pinch = null;
      if (clicked) on.clicked(toPicture(inside(event)));
    };
    canvas.addEventListener("pointerup", lift);
    canvas.addEventListener("pointercancel", lift);
    canvas.addEventListener("pointerleave", () => { cursor = null; on.pointed(null); draw(); });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const step = event.deltaY * [1, 20, 400][event.deltaMode];
      zoomAt(Math.exp(-Math.max(-400, Math.min(400, step)) * 0.002), inside(event));
    }, { passive: false });

    let last = [0, 0];
    new ResizeObserver(() => {
      const now = box();
      if (last[0] && now[0]) shift = shift.map((value, axis) => value + (now[axis] - last[axis]) / 2);
      const first = !last[0];
      last = now;
      if (first) whole(); else { limit(); draw(); }
    }).observe(canvas);

    function whole() {
      scale = Math.min(...box().map((length, axis) => length / size[axis]));
      shift = box().map((length, axis) => (length - size[axis] * scale) / 2);
      draw();
    }

    function show(picture, pictureSize, view) {
      [image, size] = [picture, pictureSize];
      if (view) { ({ scale } = view); centre(view.middle, scale); } else whole();
    }

    function centre(xy, wanted = scale) {
      scale = Math.min(Math.max(wanted, least()), MOST);
      shift = box().map((length, axis) => length / 2 - (xy[axis] + 0.5) * scale);
      limit();
      draw();
    }

    const middle = () => toPicture(box().map((length) => length / 2));
    return {
      show, whole, centre, middle,
      zoom: (factor) => zoomAt(factor, box().map((length) => length / 2)),
      scale: () => scale,
      state: () => ({ scale, middle: middle() }),
      setMarks(list) { marks = list; draw(); },
      setLoupe(shown) { showLoupe = shown; draw(); },
      sees(xy) { const [u, v] = toScreen(xy), [w, h] = box(); return u > 20 && v > 20 && u < w - 20 && v < h - 20; },
      forgetCursor() { cursor = null; },
    };
  }

  return { create };
})();
