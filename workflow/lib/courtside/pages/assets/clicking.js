// @ts-check
"use strict";
// The clicking page: what is marked where, undone and redone, saved and loaded.
(() => {
  const given = courtside.data("clicking");
  const { court, frames, ends } = given;
  const { byId, button, element, say } = courtside;
  const NEAR = 12; // screen px per picture px when the view goes to a point
  const LOOKED = 5; // of them, from which a proposal can be confirmed
  const FINE_PX = 0.1;
  const SLACK = 0.01; // of a picture's size: what is not exact may lie outside by less, as for the workflow
  const UNDOS = 50; // changes that can be undone after a reload

  let marks = Object.fromEntries(frames.map((frame) => [frame.id, {}]));
  let past = [], future = [];
  let at = 0, chosen = "", fits = {}, turns = {}, views = {}, shownFrame = "";
  const savedTexts = {}; // by table: what its file holds
  const unsaved = (table) => table.text() !== savedTexts[table.name];
  const work = courtside.keeping.keeper(`courtside clicks ${given.stamp}`, () => used.some(unsaved));

  const frame = () => frames[at];
  const isTake = (one) => one.take !== null;
  const label = (one) => (isTake(one) ? `${one.take} ${one.camera} ${one.frame_idx}` : one.camera);
  const items = (one) => (isTake(one) ? ends : court.points);
  const markOf = (one, name) => marks[one.id][name] || null;
  const placed = (mark) => mark && !mark.hidden;
  // Where half a turn of a symmetric court brings a point.
  const turned = Object.fromEntries(court.points.map(({ name, xyz: [x, y, z] }) => {
    const there = [court.size_m[0] - x, court.size_m[1] - y, z];
    const other = court.points.find((point) => Math.hypot(...point.xyz.map((value, axis) => value - there[axis])) < 0.001);
    return [name, other ? other.name : null];
  }));
  const eitherEnd = (one) => Object.values(one.proposals || {}).some((proposal) => proposal.either);
  // Which end the marks say, where the lines leave that open: 1 as proposed, -1 half a turn on, 0 not yet.
  function endOf(one) {
    const off = (mark, proposal) => (proposal ? Math.hypot(mark.x - proposal.x, mark.y - proposal.y) : 1e4);
    const nearer = Object.entries(marks[one.id]).filter(([, mark]) => placed(mark)).map(([name, mark]) =>
      off(mark, one.proposals[turned[name]]) - off(mark, one.proposals[name]));
    return Math.sign(nearer.reduce((sum, value) => sum + value, 0));
  }
  function proposalOf(one, name) {
    const end = eitherEnd(one) ? endOf(one) : 1;
    return (end && (one.proposals || {})[end > 0 ? name : turned[name]]) || null;
  }
  const rounded = (value) => Math.round(value * 1000) / 1000;

  // ---- pictures ----
  const pictures = new Map();
  async function picture(one) {
    if (!pictures.has(one.id)) {
      const image = new Image();
      image.src = courtside.image(one.id);
      await image.decode();
      pictures.set(one.id, image);
    }
    return pictures.get(one.id);
  }

  const view = clickView.create(byId("view"), byId("loupe"), {
    clicked: (xy) => place(xy),
    pointed: (xy) => { byId("cursor").textContent = xy ? `${xy[0].toFixed(1)}, ${xy[1].toFixed(1)}` : ""; },
    zoomed: (scale) => { byId("zoom").textContent = `${scale >= 3 ? Math.round(scale) : scale.toFixed(1)}×`; },
  });

  async function open(index) {
    if (shownFrame) views[shownFrame] = view.state();
    at = index;
    const one = frame();
    if (!items(one).some((item) => item.name === chosen)) chosen = items(one)[0].name;
    const image = await picture(one);
    if (frame() !== one) return;
    view.show(image, one.size, views[one.id]);
    shownFrame = one.id;
    render();
  }

  // ---- changing marks ----
  function apply(changes, direction) {
    for (const change of changes) {
      const mark = direction > 0 ? change.after : change.before;
      if (mark) marks[change.frame][change.name] = mark;
      else delete marks[change.frame][change.name];
    }
    fits = {};
    keep();
  }

  function change(changes) {
    past.push(changes);
    future = [];
    apply(changes, 1);
    render();
  }

  function set(name, after) {
    const before = markOf(frame(), name);
    if (!before && !after) return;
    change([{ frame: frame().id, name, before, after }]);
  }

  function place(/** @type {number[]} */ [x, y]) {
    const { size } = frame();
    if (x < -0.5 || y < -0.5 || x > size[0] - 0.5 || y > size[1] - 0.5) return say("That is outside the picture.");
    set(chosen, { x: rounded(x), y: rounded(y) });
    say(`${chosen} at ${rounded(x)}, ${rounded(y)}`);
  }

  function nudge(dx, dy) {
    const mark = markOf(frame(), chosen);
    if (!placed(mark)) return say(`${chosen} is not marked yet: click, or press Space.`);
    view.forgetCursor();
    place([mark.x + dx, mark.y + dy]);
  }

  function confirm() {
    const proposal = proposalOf(frame(), chosen);
    if (!proposal) return say(`There is no proposal for ${chosen} here.`);
    if (placed(markOf(frame(), chosen))) return say(`${chosen} is marked already; delete it first to take the proposal.`);
    const xy = [proposal.x, proposal.y];
    if (view.scale() < LOOKED || !view.sees(xy)) { // look at a proposal before confirming it
      view.centre(xy, Math.max(view.scale(), NEAR));
      return say(`Look at ${chosen} close up, then confirm again.`);
    }
    place(xy);
    step(1, true);
  }

  function hide() {
    const mark = markOf(frame(), chosen);
    set(chosen, mark && mark.hidden ? null : { hidden: true });
  }

  function remove() { set(chosen, null); }

  function undo() { travel(past, future, -1, "Nothing to undo."); }
  function redo() { travel(future, past, 1, "Nothing to redo."); }
  function travel(from, to, direction, nothing) {
    const changes = from.pop();
    if (!changes) return say(nothing);
    to.push(changes);
    apply(direction > 0 ? changes : [...changes].reverse(), direction);
    const seen = changes.find((one) => one.frame === frame().id);
    if (seen) chosen = seen.name;
    else { chosen = changes[0].name; return open(frames.findIndex((one) => one.id === changes[0].frame)); }
    render();
  }

  // ---- choosing ----
  function choose(name, go = true) {
    chosen = name;
    if (go) visit();
    render();
  }

  // Goes to the mark, else to where the point is expected; stays where that is not known.
  function visit(always = false) {
    const xy = expected(frame(), chosen);
    view.forgetCursor();
    if (xy && (always || view.scale() < NEAR || !view.sees(xy))) view.centre(xy, Math.max(view.scale(), NEAR));
    return xy;
  }

  function expected(one, name) {
    const known = [markOf(one, name), proposalOf(one, name)].find(placed);
    return known ? [known.x, known.y] : predicted(one)[name] || null;
  }

  function predicted(one) {
    const fit = isTake(one) ? null : fitOf(one);
    const inside = (xy) => xy && xy.every((value, axis) => value > -0.5 && value < one.size[axis] - 0.5);
    const seen = fit ? court.points.map((point) => [point.name, fit.project(point.xyz)]) : [];
    return Object.fromEntries(seen.filter(([, xy]) => inside(xy)));
  }

  function step(by, open_ = false) {
    const names = items(frame()).map((item) => item.name);
    const from = names.indexOf(chosen);
    for (let n = 1; n <= names.length; n += 1) {
      const name = names[(from + by * n + n * names.length) % names.length];
      if (!open_ || !markOf(frame(), name)) return choose(name);
    }
    say("Every point of this picture is marked.");
    return render();
  }

  function fitOf(one) {
    if (!(one.id in fits)) {
      const points = court.points.filter((point) => placed(markOf(one, point.name)));
      fits[one.id] = clickFit.fit(points.map((point) => {
        const mark = markOf(one, point.name);
        return { name: point.name, xyz: point.xyz, xy: [mark.x, mark.y] };
      }), one.size);
    }
    return fits[one.id];
  }

  // ---- keeping, saving, loading ----
  function keep() {
    work.keep({ marks, past: past.slice(-UNDOS), saved: savedTexts, time: new Date().toISOString() })
      .then((isKept) => { byId("afresh").disabled = !isKept; });
  }

  function rows(takes) {
    return frames.filter((one) => isTake(one) === takes).flatMap((one) => items(one)
      .filter((item) => placed(markOf(one, item.name)))
      .map((item) => ({ ...one, point: item.name, ...markOf(one, item.name) })));
  }

  const tables = {
    court: { name: "court_points.csv", columns: clickTables.COURT, takes: false, text: () => clickTables.court(rows(false)) },
    racket: { name: "racket.csv", columns: clickTables.RACKET, takes: true, text: () => clickTables.racket(rows(true)) },
  };
  const used = Object.values(tables).filter((table) => frames.some((one) => isTake(one) === table.takes));
  const current = () => used.find((table) => table.takes === isTake(frame()));

  function save(table) {
    savedTexts[table.name] = table.text();
    courtside.download(table.name, savedTexts[table.name], "text/csv");
    keep();
    say(`Saved ${table.name}: ${rows(table.takes).length} rows. Put it where the session's file says: ${given.targets[table.name]}`);
    render();
  }

  async function copy(table) {
    say(await courtside.copy(table.text()) ? `${table.name} is on the clipboard.` : "The browser forbids copying: take the text below.");
  }

  function load(name, text) {
    const header = text.split("\n")[0];
    const table = header.includes("take") ? tables.racket : tables.court;
    const wanted = {};
    for (const row of clickTables.read(name, text, table.columns)) {
      const where = `${name}: line ${row.line}`;
      const point = table.takes ? row.end : row.point;
      const one = frames.find((f) => f.camera === row.camera && (table.takes ? f.take === row.take : !isTake(f)) && f.frame_idx === row.frame_idx);
      if (!one) throw new Error(`${where}: this page has no picture of camera "${row.camera}", frame ${row.frame_idx}; nothing was loaded`);
      if (!items(one).some((item) => item.name === point)) throw new Error(`${where}: the court has no point "${point}"; nothing was loaded`);
      const xy = [row.x_px, row.y_px], wide = one.size.map((length) => SLACK * length);
      if (!xy.every((value, axis) => value > -wide[axis] && value < one.size[axis] + wide[axis])) {
        throw new Error(`${where}: expected a place in the picture of ${one.size.join(" x ")} px, found ${xy.join(", ")}; nothing was loaded`);
      }
      const key = `${one.id} ${point}`;
      if (key in wanted) throw new Error(`${where}: ${point} is there twice for camera ${row.camera}; nothing was loaded`);
      wanted[key] = { frame: one.id, name: point, after: { x: row.x_px, y: row.y_px } };
    }
    const named = new Set(Object.values(wanted).map((one) => one.frame));
    const [replaced, others] = [true, false].map((yes) => frames.filter((one) => isTake(one) === table.takes && named.has(one.id) === yes));
    const changes = replaced.flatMap((one) => items(one).map((item) => {
      const before = markOf(one, item.name), found = wanted[`${one.id} ${item.name}`];
      if (!found && !placed(before)) return null; // what is marked as not visible stays
      return { frame: one.id, name: item.name, before, after: found ? found.after : null };
    })).filter(Boolean);
    const n = Object.keys(wanted).length, kept = others.filter((one) => items(one).some((item) => placed(markOf(one, item.name))));
    if (!n) return say(`${name} has no rows: nothing has changed.`);
    change(changes);
    return say(`Loaded ${n} ${n === 1 ? "row" : "rows"} of ${name}, the marks of ${replaced.map(label).join(", ")}. `
      + `${kept.length ? `Those of ${kept.map(label).join(", ")} stay. ` : ""}Undo brings back what was here.`);
  }

  byId("chooser").addEventListener("change", async (event) => {
    const [file] = event.target.files;
    event.target.value = "";
    if (!file) return;
    try { load(file.name, await file.text()); } catch (error) { say(error.message, true); }
  });

  // ---- showing ----
  function render() {
    const one = frame(), fit = isTake(one) ? null : fitOf(one);
    renderTabs();
    renderChosen(one);
    renderList(one, fit);
    byId("fit").innerHTML = "";
    byId("fit").classList.toggle("bad", Boolean(fit && fit.worst && fit.worst.suspicious));
    byId("fit").append(...(isTake(one) ? [] : fitWords(one, fit)));
    byId("drawings").hidden = isTake(one);
    if (!isTake(one)) renderDrawings(one, fit);
    view.setMarks(shownMarks(one));
    byId("undo").disabled = !past.length;
    byId("redo").disabled = !future.length;
    byId("text").value = current().text();
    byId("where").textContent = `${unsaved(current()) ? "Not saved yet. " : ""}The workflow reads ${given.targets[current().name]}.`;
  }

  function renderTabs() {
    frames.forEach((one, index) => {
      const tab = byId("tabs").children[index], names = items(one);
      const done = names.filter((item) => markOf(one, item.name)).length;
      tab.setAttribute("aria-selected", String(index === at));
      tab.setAttribute("aria-pressed", String(index === at));
      tab.querySelector(".count").textContent = `${done}/${names.length}`;
    });
  }

  function renderChosen(one) {
    const item = items(one).find((each) => each.name === chosen), mark = markOf(one, chosen), proposal = proposalOf(one, chosen);
    byId("chosen-name").textContent = chosen;
    byId("chosen-state").textContent = placed(mark) ? `${mark.x}, ${mark.y} px` : mark ? "not visible"
      : proposal ? `proposed, ±${proposal.sigma_px.toFixed(1)} px` : "not marked";
    byId("chosen-edges").textContent = item.edges;
    byId("confirm").disabled = !proposal || placed(mark);
    byId("hide").setAttribute("aria-pressed", String(Boolean(mark && mark.hidden)));
    byId("delete").disabled = !mark;
  }

  function renderList(one, fit) {
    const list = byId("list");
    list.replaceChildren();
    for (const item of items(one)) {
      const mark = markOf(one, item.name), off = fit && fit.residual[item.name];
      const row = button(list, "", () => { choose(item.name); byId("view").focus({ preventScroll: true }); });
      row.setAttribute("role", "option");
      row.setAttribute("aria-selected", String(item.name === chosen));
      row.dataset.point = item.name;
      const cells = [item.name, placed(mark) ? `${mark.x.toFixed(1)}, ${mark.y.toFixed(1)}` : mark ? "not visible" : proposalOf(one, item.name) ? "proposed" : "–",
        off !== undefined && off !== null && fit.spare > 0 ? `${off.toFixed(1)} px` : ""];
      for (const words of cells) row.append(element("span", { textContent: words }));
      if (fit && fit.worst && fit.worst.suspicious && fit.worst.name === item.name) row.lastElementChild.className = "worst";
      // Only where the list scrolls by itself: on a narrow screen the page would leave the picture.
      const scrolls = getComputedStyle(list.closest(".side")).overflowY === "auto";
      if (item.name === chosen && scrolls && document.activeElement === document.body) row.scrollIntoView({ block: "nearest" });
    }
  }

  function fitWords(one, fit) {
    const words = (text) => document.createTextNode(text);
    const strong = (text) => element("strong", { textContent: text });
    const n = court.points.filter((point) => placed(markOf(one, point.name))).length;
    if (!fit) return [words(`${n} marked. From ${clickFit.FLOOR_FROM} points on the floor on, the others are expected where the white crosses are.`)];
    const how = fit.kind === "camera" ? "a camera with a lens" : "a flat floor seen without lens";
    if (fit.spare <= 0) return [words(`${fit.n} floor points give the view; one more tells how well they agree.`)];
    const first = words(`${fit.n} points fit ${how} to ${fit.rms.toFixed(1)} px. `);
    if (!fit.worst) return [first, words("More points will tell which one fits worst.")];
    const { name, off, rms, suspicious } = fit.worst;
    const rest = `${off.toFixed(1)} px from where the others, which agree to ${rms.toFixed(1)} px, put it.`;
    return [first, strong(`${suspicious ? "Look again at" : "Fits worst:"} ${name}`), words(`${suspicious ? ":" : ","} ${rest}`)];
  }

  function renderDrawings(one, fit) {
    const quarters = turns[one.camera] ?? bestTurn(one, fit);
    const look = (point) => {
      const mark = markOf(one, point.name);
      return [placed(mark) ? "placed" : mark ? "hidden" : "open", point.name === chosen ? "chosen" : ""].filter(Boolean);
    };
    clickCourt.plan(byId("plan"), court, quarters, look, (name) => choose(name));
    byId("drawings").classList.toggle("lying", quarters % 2 === 1);
    const point = court.points.find((each) => each.name === chosen);
    byId("sketch-note").textContent = clickCourt.sketch(byId("sketch"), court, point, quarters);
  }

  // The quarter in which the drawing lies as the camera sees the court.
  function bestTurn(one, fit) {
    const middle = [court.size_m[0] / 2, court.size_m[1] / 2, 0];
    const from = fit && fit.project(middle), to = fit && fit.project([middle[0] + 0.5, middle[1], 0]);
    if (!from || !to) return 0;
    const angle = Math.atan2(to[1] - from[1], to[0] - from[0]); // of x, 0 where it runs to the right
    return (Math.round(angle / (Math.PI / 2)) + 4) % 4;
  }

  function shownMarks(one) {
    const known = predicted(one);
    return items(one).map(({ name }) => {
      const mark = markOf(one, name), proposal = proposalOf(one, name), about = { name, chosen: name === chosen };
      if (placed(mark)) return { ...about, kind: "placed", xy: [mark.x, mark.y] };
      if (mark) return null;
      if (proposal) return { ...about, kind: "proposed", xy: [proposal.x, proposal.y] };
      return known[name] ? { ...about, kind: "predicted", xy: known[name] } : null;
    }).filter(Boolean).sort((a, b) => a.chosen - b.chosen);
  }

  // ---- keys and buttons ----
  const zoom = (factor) => { view.forgetCursor(); view.zoom(factor); };
  const turn = () => {
    const one = frame();
    turns[one.camera] = ((turns[one.camera] ?? bestTurn(one, fitOf(one))) + 1) % 4;
    render();
  };
  const magnify = () => {
    const shown = byId("loupe-toggle").getAttribute("aria-pressed") !== "true";
    byId("loupe-toggle").setAttribute("aria-pressed", String(shown));
    view.setLoupe(shown);
  };
  const tab = (by) => {
    if (!by) return;
    const next = (at + by + frames.length) % frames.length;
    open(next);
    byId("tabs").children[next].focus();
  };
  const near = () => { if (!visit(true)) say(`The place of ${chosen} is unknown: mark four points on the floor first.`); };
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const keys = {
    n: () => step(1), b: () => step(-1), Enter: confirm, h: hide, Delete: remove, Backspace: remove, g: near, m: magnify,
    t: turn, "+": () => zoom(1.5), "=": () => zoom(1.5), "-": () => zoom(1 / 1.5), 0: () => view.whole(), " ": () => place(view.middle()),
  };
  const chords = { z: (shift) => (shift ? redo() : undo()), y: () => redo(), s: () => save(current()) };

  document.addEventListener("keydown", (event) => {
    const target = /** @type {Element} */ (event.target);
    if (event.altKey || target.closest("input, select, textarea, summary")) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const onButton = target.closest("button") && (key === "Enter" || key === " ");
    let action = null;
    if (event.ctrlKey || event.metaKey) action = chords[key] && (() => chords[key](event.shiftKey));
    else if (arrows[key] && target.closest("#tabs")) action = () => tab(arrows[key][0]);
    else if (arrows[key]) action = !target.closest(".tools") && (() => nudge(...arrows[key].map((value) => value * (event.shiftKey ? 1 : FINE_PX))));
    else if (/^[1-9]$/.test(key)) action = frames[Number(key) - 1] && (() => open(Number(key) - 1));
    else if (!onButton) action = keys[key];
    if (!action) return;
    event.preventDefault();
    action();
  });

  const actions = {
    "zoom-in": () => zoom(1.5), "zoom-out": () => zoom(1 / 1.5), whole: () => view.whole(), near, undo, redo, confirm, hide,
    delete: remove, next: () => step(1), previous: () => step(-1), "loupe-toggle": magnify, turn,
    afresh: () => { work.forget(); say("This browser has deleted the saved work of this session; the marks stay until the page is closed."); },
  };
  // After a click on a tool, keys go to the picture again; whoever uses a tool by keys stays there.
  document.querySelector(".tools").addEventListener("click", (/** @type {MouseEvent} */ event) => {
    if (event.detail) byId("view").focus({ preventScroll: true });
  });
  for (const [id, action] of Object.entries(actions)) byId(id).addEventListener("click", action);

  // ---- start ----
  async function start() {
    const kept = await work.read();
    frames.forEach((one, index) => {
      const tab = button(byId("tabs"), `${label(one)} `, () => {
        open(index);
        byId("view").focus({ preventScroll: true }); // so that keys go to the picture
      });
      tab.setAttribute("role", "tab");
      tab.append(element("span", { className: "count" }));
      for (const [name, xy] of Object.entries(one.clicks)) marks[one.id][name] = { x: xy[0], y: xy[1] };
    });
    for (const table of used) {
      button(byId("files"), `Save ${table.name}`, () => save(table), { className: "primary", id: `save-${table.name.split(".")[0]}` });
      button(byId("files"), "Copy", () => copy(table), { title: `Copy ${table.name}` });
    }
    button(byId("files"), "Load…", () => byId("chooser").click(), { id: "load" });
    for (const table of used) savedTexts[table.name] = table.text();
    if (kept && kept.marks) {
      for (const one of frames) if (kept.marks[one.id]) marks[one.id] = kept.marks[one.id];
      past = kept.past || [];
      Object.assign(savedTexts, kept.saved);
      const time = new Date(kept.time);
      say(`Your work of ${Number.isNaN(time.getTime()) ? "last time" : time.toLocaleString()} is here again.`);
    } else if (frames.some(eitherEnd)) say("The court was found, but not which end is which: mark one point in each picture, then the others are proposed.");
    else if (frames.some((one) => Object.keys(one.proposals).length)) say("Hollow marks are proposals: look at each close up, then press Enter, or click the right place.");
    else say("Choose a point, zoom in, click where its edges meet.");
    if (frames.length < 2) byId("tabs").hidden = true;
    const first = items(frames[0]).find((item) => !markOf(frames[0], item.name)) || items(frames[0])[0];
    chosen = first.name;
    open(0);
  }
  courtside.keeping.start(start);
})();
