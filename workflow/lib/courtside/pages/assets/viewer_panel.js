// @ts-check
"use strict";
/* The words beside the picture: switches, legend, and the numbers of the picked joint. */

const { element } = courtside;
const WHY = {
  1: "not seen", 2: "score too low", 3: "too few views", 4: "views disagree", 5: "interpolated",
  6: "outside the picture", 7: "no depth there", 8: "too uncertain", 255: "missing",
};
const MEASURES = {
  sigma: { words: "expected error σ", unit: "mm", of: (layer, ...where) => layer.sigmaMm(...where) },
  reprojection: { words: "reprojection error", unit: "px", of: (layer, ...where) => layer.reprojectionPx(...where) },
  distance: { words: "distance", unit: "mm", of: (layer, ...where) => layer.distanceMm(layer.against, ...where) },
};

function options(select, entries, chosen) {
  select.replaceChildren(...entries.map(([value, words]) => element("option", { value, textContent: words })));
  if (chosen !== undefined) select.value = chosen;
}

function box(words, checked, changed, swatch) {
  const input = element("input", { type: "checkbox", checked });
  input.addEventListener("change", () => changed(input.checked));
  const parts = [input];
  if (swatch) {
    const patch = element("span", { className: "swatch" });
    patch.style.background = swatch;
    parts.push(patch);
  }
  return element("label", {}, ...parts, words);
}

/** A round number at or above a value: 1, 2 or 5 times a power of ten. */
function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].find((digit) => digit * power >= value * (1 - 1e-9)) * power;
}

/** Where the colour scale of a measure ends: about the 95th percentile over all layers. */
function scaleEnd(layers, of) {
  const values = [];
  for (const layer of layers) {
    const stride = Math.max(1, Math.floor(layer.length / 60));
    for (let frame = 0; frame < layer.length; frame += stride) {
      for (let person = 0; person < layer.persons.length; person++) {
        layer.joints.forEach((_, joint) => {
          const value = of(layer, person, joint, frame);
          if (Number.isFinite(value)) values.push(value);
        });
      }
    }
  }
  values.sort((a, b) => a - b);
  return values.length ? roundUp(Math.max(values[Math.floor(0.95 * (values.length - 1))], 1e-3)) : 1;
}

function swatches(entries) {
  return entries.flatMap(([colour, words]) => {
    const patch = element("span", { className: "swatch" });
    patch.style.background = colour;
    return [patch, words];
  });
}

function legend(view, scene) {
  const shown = view.layers.filter((layer) => layer.shown);
  const { left, right, middle } = scene.colours;
  if (view.colour === "layer") return [element("div", {}, ...swatches(shown.map((layer) => [view.layerColour(layer), layer.name])))];
  const bones = shown.map(({ name }, order) => `${name}: ${order ? "thin" : "thick"}${order % 2 ? ", dashed" : ""}`);
  const drawn = shown.length > 1 ? [element("div", { textContent: bones.join("; ") })] : [];
  if (view.colour === "side") return [element("div", {}, ...swatches([[left, "left"], [right, "right"], [middle, "middle"]])), ...drawn];
  const measure = MEASURES[view.colour];
  const bar = element("span", { className: "bar" });
  bar.style.background = `linear-gradient(to right, ${[0, 1, 2, 3, 4, 5, 6].map((at) => shade(at, 6)).join(", ")})`;
  const end = view.end[view.colour];
  const digits = end < 1 ? 2 : end < 5 ? 1 : 0;
  const ticks = [0, end / 2, end].map((value, at) => element("span", { textContent: `${at === 2 ? "≥ " : ""}${value.toFixed(digits)}` }));
  const lines = [element("div", { textContent: `${measure.words}${view.colour === "distance" ? ` from ${view.against.name}` : ""} (${measure.unit})` }),
    bar, element("div", { className: "ticks" }, ...ticks)];
  if (view.colour === "sigma") {
    const covers = [...new Set(shown.filter((layer) => layer.ellipsoid).map((layer) => layer.covers))].filter(Boolean);
    lines.push(element("div", { textContent: `root mean square distance from the true place${covers.length ? `: ${covers.join("; ")}` : ""}` }));
  }
  lines.push(element("div", {}, ...swatches([[UNKNOWN, "not known"]])));
  return [...lines, ...drawn];
}

/** Rows of the picked joint: [heading, one text per shown layer]. */
function numbers(view) {
  const shown = view.layers.filter((layer) => layer.shown);
  const columns = shown.map((layer) => {
    const person = layer.persons.indexOf(view.picked.person);
    const joint = layer.joints.indexOf(view.picked.joint);
    const frame = layer.frameAt(view.time_s);
    if (person < 0 || joint < 0) return { note: "has no such joint" };
    if (frame < 0) return { note: "no frame then" };
    const where = [person, joint, frame];
    return {
      place: layer.position(...where), sigmas: layer.sigmas(...where), sigma: layer.sigmaMm(...where),
      px: layer.reprojectionPx(...where), views: layer.n_views ? layer.n_views[layer.at(...where)] : null,
      note: WHY[layer.reason[layer.at(...where)]] || "",
    };
  });
  const axis = (at) => columns.map(({ place }) => (place ? place[at].toFixed(3) : "–"));
  const rows = [["x (m)", axis(0)], ["y (m)", axis(1)], ["z (m)", axis(2)],
    ["σ (mm)", columns.map(({ sigma }) => (Number.isFinite(sigma) ? sigma.toFixed(1) : "–"))],
    ["σ x, y, z (mm)", columns.map(({ sigmas }) => (sigmas ? sigmas.map((one) => (1000 * one).toFixed(1)).join(", ") : "–"))],
    ["reproj. (px)", columns.map(({ px }) => (Number.isFinite(px) ? px.toFixed(1) : "–"))],
    ["views", columns.map(({ views }) => (views === null || views === undefined ? "–" : String(views)))],
    ["note", columns.map(({ note }) => note)]];
  return { shown, rows: rows.filter(([name, cells]) => name !== "note" || cells.some(Boolean)) };
}

function readout(view) {
  if (!view.picked) return [element("span", { className: "soft", textContent: "Click a joint in the picture, or choose one above." })];
  const { shown, rows } = numbers(view);
  const head = element("tr", {}, element("th"), ...shown.map((layer) => element("th", { textContent: layer.name, scope: "col" })));
  const body = rows.map(([name, cells]) => element("tr", {}, element("th", { textContent: name, scope: "row" }),
    ...cells.map((cell) => element("td", { textContent: cell }))));
  const title = element("caption", { textContent: `${view.picked.joint.replaceAll("_", " ")} of ${view.picked.person}` });
  return [element("table", {}, title, element("thead", {}, head), element("tbody", {}, ...body))];
}
