// @ts-check
"use strict";
// The page on which persons are named: names by part of the take, split, joined and saved.
(() => {
  const given = courtside.data("people");
  const { byId, button, say } = courtside;
  const SAVED = `courtside people saved ${given.session} ${given.target}`;
  const UNDOS = 20;
  const COLOURS = ["#0b62b0", "#d1495b", "#1d7a3e", "#9a5400", "#7b4fb5", "#00838f", "#b0306a", "#5f6b00"];
  const FEW = 4; // cameras whose pictures are shown of each person, unless all are wanted
  const colour = (person) => COLOURS[given.persons.indexOf(person) % COLOURS.length];
  const rounded = (value) => Math.round(value * 1000) / 1000;

  // By person: parts of the take, [{from, subject}], the first from its start. By take: {rows, time} of loaded files.
  // What other pages saved before `since` does not count.
  let state = { parts: partsOf(given.named), loaded: {}, since: 0 };
  let past = [], future = []; // states as text
  let savedText = ""; // of the file
  let saved = {}, sharing = null; // by take: rows that this session's pages saved; what tells them to the other pages
  const work = courtside.keeping.keeper(`courtside people ${given.stamp}`, () => text() !== savedText);

  function partsOf(names) {
    const named = (person) => names.filter((one) => one.person === person.index);
    return Object.fromEntries(given.persons.map((person) => [person.index, peopleTable.parts(named(person), given)]));
  }

  // ---- names ----
  const endOf = (own, at) => (at + 1 < own.length ? own[at + 1].from : given.stop_s);
  const within = (own, at) => (column) => column.time_s >= own[at].from && (column.time_s < endOf(own, at) || at + 1 === own.length);

  /** Returns the largest picture of a column. */
  function largest(column) {
    return column.views.reduce((best, view) => (!best || view.size_px > best.size_px ? view : best), null);
  }

  /** Returns the cameras with the largest pictures of a person, in the session's order. */
  function clearest(person) {
    const size = {};
    for (const view of person.columns.flatMap((column) => column.views)) size[view.camera] = (size[view.camera] || 0) + view.size_px;
    const best = Object.keys(size).sort((a, b) => size[b] - size[a]).slice(0, FEW);
    return Object.keys(given.clocks).filter((camera) => best.includes(camera));
  }

  function rowsOf(person) {
    const own = state.parts[person.index], found = [];
    own.forEach((part, at) => {
      if (!part.subject) return;
      const shown = person.columns.filter(within(own, at)).filter((column) => column.views.length);
      for (const column of new Set([shown[0], shown[shown.length - 1]])) {
        if (!column) continue;
        const view = largest(column), [offset, scale] = given.clocks[view.camera];
        const bounds = [part.from, endOf(own, at)].map((time) => rounded(time * scale + offset));
        found.push([given.take, part.subject, view.camera, view.time_s, ...view.at_px, ...(own.length > 1 ? bounds : ["", ""])]);
      }
    });
    return found;
  }

  /** Returns the names of a person in all parts. */
  function namesOf(person) {
    return [...new Set(state.parts[person.index].map((part) => part.subject).filter(Boolean))];
  }

  // Where one name is given to two persons at one time, further apart than two tracks of one body.
  function clash(person, at) {
    const own = state.parts[person.index], { subject } = own[at], found = { far: given.meet_m, words: "" };
    for (const other of subject ? given.persons.filter((one) => one !== person && namesOf(one).includes(subject)) : []) {
      const theirs = state.parts[other.index], places = new Map(other.path.map(([time_s, x, y]) => [time_s, [x, y]]));
      for (const [time_s, x, y] of person.path.filter((row) => within(own, at)({ time_s: row[0] }) && places.has(row[0]))) {
        const there = theirs.some((part, n) => part.subject === subject && within(theirs, n)({ time_s }));
        const far = there ? Math.hypot(x - places.get(time_s)[0], y - places.get(time_s)[1]) : 0;
        if (far > found.far) Object.assign(found, { far, words: `${subject} is also ${other.name}, ${far.toFixed(1)} m away at ${time_s.toFixed(1)} s` });
      }
    }
    return found.words;
  }

  // ---- changing names ----
  function keep() {
    work.keep({ ...state, past: past.slice(-UNDOS), time: new Date().toISOString() });
    render();
  }

  function change(edit) {
    past.push(JSON.stringify(state));
    future = [];
    edit();
    keep();
  }

  function travel(from, to, done) {
    if (!from.length) return say(`Nothing to be ${done}.`);
    const before = state;
    to.push(JSON.stringify(state));
    state = JSON.parse(from.pop());
    keep();
    const changed = given.persons.filter(({ index }) => JSON.stringify(before.parts[index]) !== JSON.stringify(state.parts[index]));
    return say(`The last change is ${done}${changed.length ? `: ${changed.map((person) => person.name).join(", ")}` : ""}.`);
  }
  const undo = () => travel(past, future, "undone");
  const redo = () => travel(future, past, "done again");

  function split(person, column) {
    const own = state.parts[person.index], at = person.columns.indexOf(column);
    const part = { from: rounded((person.columns[at - 1].time_s + column.time_s) / 2), subject: "" };
    change(() => {
      own.push(part);
      own.sort((a, b) => a.from - b.from);
    });
    control(person, `name ${own.indexOf(part)}`).focus();
  }

  function afresh() {
    change(() => { state = { parts: partsOf(given.named), loaded: {}, since: Date.now() }; });
    say("Names are as the workflow has them; Undo brings back yours.");
  }

  // ---- showing ----
  function element(parent, kind, properties = {}) {
    const made = courtside.element(kind, properties);
    parent.append(made);
    return made;
  }

  const control = (person, name) => byId(person.name).querySelector(`[data-control="${name}"]`);

  function render() {
    const { activeElement } = document, active = given.persons.find((person) => byId(person.name).contains(activeElement));
    const name = active && /** @type {HTMLElement} */ (activeElement).dataset.control;
    given.persons.forEach(renderPerson);
    if (active && !byId(active.name).contains(document.activeElement)) {
      (control(active, name) || control(active, "name 0")).focus({ preventScroll: true });
    }
    renderFloor();
    renderSide();
    byId("undo").disabled = !past.length;
    byId("redo").disabled = !future.length;
  }

  function renderSide() {
    const named = new Set(Object.values(state.parts).flat().map((part) => part.subject));
    const open = given.subjects.filter((name) => !named.has(name));
    const alone = given.subjects.length === 1 && given.persons.length === 1;
    byId("missing").textContent = !open.length ? "Every subject has a person."
      : alone ? "One subject and one person: no name is needed." : `Not named yet: ${open.join(", ")}.`;
    byId("missing").className = open.length && !alone ? "warn" : "good";
    const twice = given.persons.flatMap((person) => state.parts[person.index].filter((_, at) => clash(person, at)).map((part) => part.subject));
    byId("clashes").textContent = twice.length ? `Two persons at one time: ${[...new Set(twice)].join(", ")}.` : "";
    const kept = others().map(({ take, rows, where }) => `${take} (${counted(rows)} ${where})`);
    byId("where").textContent = `The workflow reads ${given.target}, where the session's file says people: ${given.target}. `
      + (given.takes.length < 2 ? "" : `The file holds all takes: ${kept.length ? `beside ${given.take}, ${kept.join(", ")}` : "no names of other takes are known here"}. `
      + "If you named others elsewhere since, load people.csv first.");
    byId("text").value = text();
  }

  function addCard(person) {
    const card = element(byId("persons"), "article", { className: "person" });
    card.style.setProperty("--own", colour(person));
    card.dataset.person = card.id = person.name;
    element(card, "h2", { textContent: person.name });
    const doubts = person.doubts.map(([, stop, kept]) => ` May be somebody else after ${stop.toFixed(1)} s (${Math.round(kept * 100)} % that not).`);
    element(card, "p", {
      className: doubts.length ? "about warn" : "about soft",
      textContent: `Placed in ${Math.round(person.placed * 100)} % of the take; one person throughout with probability ${person.confidence.toFixed(2)}.${doubts.join("")}`,
    });
    element(card, "div", { className: "parts" });
    element(card, "div", { className: "strip" });
  }

  // Pictures are drawn again only where parts begin elsewhere than before.
  function renderPerson(person) {
    const [list, strip] = ["parts", "strip"].map((name) => byId(person.name).querySelector(`.${name}`));
    const own = state.parts[person.index], drawn = JSON.stringify([own.map((part) => part.from), byId("all").checked]);
    list.replaceChildren();
    own.forEach((part, at) => renderPart(list, person, part, at));
    if (strip.dataset.drawn === drawn) return;
    strip.replaceChildren();
    renderStrip(strip, person);
    strip.dataset.drawn = drawn;
  }

  function renderPart(list, person, part, at) {
    const own = state.parts[person.index], row = element(list, "div", { className: "part" });
    if (own.length > 1) renderBounds(row, person, part, at);
    const label = element(row, "label", { textContent: "is " });
    const choice = element(label, "select", { ariaLabel: `Name of ${person.name}${own.length > 1 ? ` from ${part.from.toFixed(1)} s` : ""}` });
    for (const name of ["", ...given.subjects]) {
      const others = name ? given.persons.filter((one) => one !== person && namesOf(one).includes(name)) : [];
      const words = `${name || "no subject"}${others.length ? ` (also ${others.map((one) => one.name).join(", ")})` : ""}`;
      element(choice, "option", { value: name, textContent: words });
    }
    choice.value = part.subject;
    choice.dataset.control = `name ${at}`;
    choice.addEventListener("change", () => change(() => { part.subject = choice.value; }));
    const pictured = person.columns.filter(within(own, at)).some((column) => column.views.length);
    if (part.subject && !pictured) element(row, "span", { className: "bad", textContent: "There is no picture in this part: it cannot be saved." });
    const twice = clash(person, at);
    if (twice) element(row, "span", { className: "bad", textContent: `${twice}: correct one of them.` });
  }

  function renderBounds(row, person, part, at) {
    const own = state.parts[person.index];
    if (!at) element(row, "span", { textContent: `to ${endOf(own, at).toFixed(2)} s` });
    else {
      const label = element(row, "label", { textContent: "from " });
      const field = element(label, "input", { type: "number", step: "0.01", value: part.from.toFixed(2), ariaLabel: `Part ${at + 1} of ${person.name} begins, s` });
      field.dataset.control = `from ${at}`;
      const moved = () => {
        const value = Number(field.value);
        if (!(value > own[at - 1].from && value < endOf(own, at))) { render(); return say("A part begins after the one before and before the next one.", true); }
        return change(() => { part.from = value; });
      };
      field.addEventListener("change", () => setTimeout(moved)); // once Tab has moved the focus on
      element(row, "span", { textContent: "s" });
      button(row, "Join to the part before", () => {
        change(() => { own.splice(at, 1); });
        control(person, `name ${at - 1}`).focus();
      }).dataset.control = `join ${at}`;
    }
  }

  function renderStrip(box, person) {
    const table = element(box, "table"), own = state.parts[person.index];
    const head = element(element(table, "thead"), "tr"), body = element(table, "tbody");
    const cuts = own.slice(1).map((part) => person.columns.find((column) => column.time_s >= part.from));
    element(head, "td");
    person.columns.forEach((column, at) => {
      const cell = element(head, "th", { scope: "col", className: cuts.includes(column) ? "cut" : "" });
      element(cell, "div", { textContent: `${column.time_s.toFixed(1)} s` });
      if (at && !cuts.includes(column)) button(cell, "Split here", () => split(person, column), { title: `Another name from about ${column.time_s.toFixed(1)} s on` });
    });
    for (const camera of byId("all").checked ? Object.keys(given.clocks) : clearest(person)) {
      const views = person.columns.map((column) => column.views.find((view) => view.camera === camera));
      if (!views.some(Boolean)) continue;
      const row = element(body, "tr");
      element(row, "th", { scope: "row", textContent: camera });
      views.forEach((view, at) => {
        const cell = element(row, "td", { className: cuts.includes(person.columns[at]) ? "cut" : "" });
        if (view) element(cell, "img", { src: courtside.image(view.image), alt: `${person.name} in ${camera} at ${view.time_s.toFixed(1)} s` });
      });
    }
  }

  function renderFloor() {
    const svg = byId("floor"), points = given.persons.flatMap((person) => person.path.map(([, x, y]) => [x, y]));
    if (given.court) points.push([0, 0], given.court.size_m);
    const axis = (at) => points.map((point) => point[at]);
    const margin = Math.max(1, ...[0, 1].map((at) => (Math.max(...axis(at)) - Math.min(...axis(at))) / 12)); // room for labels
    const low = [0, 1].map((at) => Math.min(...axis(at)) - margin), high = [0, 1].map((at) => Math.max(...axis(at)) + margin);
    svg.replaceChildren();
    if (!points.length) return;
    const size = [high[0] - low[0], high[1] - low[1]], wide = Math.max(...size) / 90;
    const draw = (kind, properties) => {
      const made = document.createElementNS("http://www.w3.org/2000/svg", kind);
      for (const [key, value] of Object.entries(properties)) made.setAttribute(key, String(value));
      svg.append(made);
      return made;
    };
    svg.setAttribute("viewBox", `${low[0]} ${-high[1]} ${size[0]} ${size[1]}`);
    for (const [x0, y0, x1, y1] of given.court ? given.court.lines_m : []) {
      draw("rect", { class: "line", x: Math.min(x0, x1), y: -Math.max(y0, y1), width: Math.abs(x1 - x0), height: Math.abs(y1 - y0) });
    }
    for (const person of given.persons) {
      if (!person.path.length) continue;
      const places = person.path.map(([, x, y]) => `${x},${-y}`).join(" "), [, x, y] = person.path[0];
      draw("polyline", { class: "path", points: places, stroke: colour(person), "stroke-width": wide / 2 });
      draw("circle", { cx: x, cy: -y, r: wide, fill: colour(person) });
    }
    for (const person of given.persons.filter((one) => one.path.length)) {
      const [, x, y] = person.path[0], words = namesOf(person).join(", ") || person.name.replace("person-", "");
      const label = draw("text", { class: "label", x, y: -y - 1.6 * wide, "font-size": 4 * wide, "stroke-width": wide });
      label.textContent = words;
      label.addEventListener("click", () => byId(person.name).scrollIntoView());
    }
    const bar = size[0] < 10 ? 1 : 5, left = low[0] + 2 * wide, down = -low[1] - 2 * wide; // m
    draw("line", { class: "scale", x1: left, y1: down, x2: left + bar, y2: down, "stroke-width": wide / 2 });
    draw("text", { class: "scale-label", x: left + bar / 2, y: down - wide, "font-size": 3 * wide }).textContent = `${bar} m`;
  }

  // ---- files ----
  const counted = (rows) => `${rows.length} ${rows.length === 1 ? "row" : "rows"}`;
  const ownRows = () => given.persons.flatMap(rowsOf);

  const inFile = (take) => given.rows.filter((row) => row[0] === take);
  const same = (rows, others) => JSON.stringify(rows) === JSON.stringify(others);

  // What this session's pages saved, by take, {rows, time, before}, counts as long as people.csv has the rows `before`,
  // of when it was saved. Once the file has the saved rows, these are that.
  function placed(one, take) {
    return same(inFile(take), one.rows) ? { ...one, before: one.rows } : one;
  }

  async function share() {
    sharing = await courtside.keeping.shared(SAVED, (known) => { saved = known || {}; renderSide(); });
    const anew = (known) => Object.fromEntries(Object.entries(known || {}).map(([take, one]) => [take, placed(one, take)]));
    if (!same(anew(saved), saved)) await sharing.change(anew);
  }

  // Returns the rows of every other take, the newest of people.csv, of a loaded file and of what other pages saved.
  function others() {
    return given.takes.filter((take) => take !== given.take).map((take) => {
      const ways = [{ rows: inFile(take), time: state.since, where: "of people.csv when this page was made" }];
      if (take in state.loaded) ways.push({ ...state.loaded[take], where: "of a loaded file" });
      if (take in saved && same(inFile(take), saved[take].before)) {
        ways.push({ ...saved[take], where: `saved in this browser ${new Date(saved[take].time).toLocaleString()}` });
      }
      return { take, ...ways.reduce((newest, way) => (way.time > newest.time ? way : newest)) };
    }).filter((one) => one.rows.length);
  }

  function text() {
    return peopleTable.written([...others().flatMap((one) => one.rows), ...ownRows()]);
  }

  function save() {
    const rows = ownRows(), more = others();
    savedText = text();
    courtside.download("people.csv", savedText, "text/csv");
    const one = { rows: rows.map((row) => row.map(String)), time: Date.now(), before: inFile(given.take) };
    sharing.change((known) => ({ ...known, [given.take]: one }));
    const held = [{ take: given.take, rows }, ...more].map((one) => `${counted(one.rows)} of ${one.take}`).join(", ");
    say(`Saved ${held}. Put the file where the workflow reads it: ${given.target}.`
      + (more.length || given.takes.length < 2 ? "" : " If that file has names of other takes by now, load it here first, then save again."));
  }

  function load(name, content) {
    const { [given.take]: own = [], ...found } = peopleTable.read(name, content, given);
    const names = peopleTable.named(own, given), taken = own.length && names.every(Boolean);
    const before = Object.fromEntries(others().map((one) => [one.take, one.rows]));
    const takes = Object.entries(found).map(([take, rows]) => `${take}: ${rows.length}${before[take] ? ` in place of ${before[take].length}` : ""}`);
    change(() => {
      for (const [take, rows] of Object.entries(found)) state.loaded[take] = { rows, time: Date.now() };
      if (taken) state.parts = partsOf(names);
    });
    const ofOthers = Object.values(found).flat(), left = names.filter((one) => !one).length;
    say(`Loaded ${name}: ${counted(ofOthers)} of other takes${takes.length ? ` (${takes.join(", ")})` : ""}${own.length ? `, ${counted(own)} of ${given.take}` : ""}. `
      + (taken ? `The names of ${given.take} are those of the file. ` : own.length
        ? `Names given here stay and those of ${given.take} in the file are left out, for ${left} of them ${left === 1 ? "is" : "are"} of no picture of this page. ` : "")
      + "Undo brings back what was here.", Boolean(own.length && !taken));
  }

  byId("save").addEventListener("click", save);
  byId("all").addEventListener("change", render);
  byId("all-label").hidden = Object.keys(given.clocks).length <= FEW;
  byId("load").addEventListener("click", () => byId("chooser").click());
  byId("chooser").addEventListener("change", async (event) => {
    const [file] = event.target.files;
    event.target.value = "";
    if (!file) return;
    try { load(file.name, await file.text()); } catch (error) { say(error.message, true); }
  });
  for (const [id, action] of Object.entries({ afresh, undo, redo })) byId(id).addEventListener("click", action);
  const chords = { s: () => save(), z: (shift) => (shift ? redo() : undo()), y: () => redo() };
  document.addEventListener("keydown", (event) => {
    const action = (event.ctrlKey || event.metaKey) && !event.altKey && chords[event.key.toLowerCase()];
    if (!action || (event.key !== "s" && /** @type {Element} */ (event.target).closest("input[type=number], textarea"))) return;
    event.preventDefault();
    action(event.shiftKey);
  });
  const bar = document.querySelector("header");
  new ResizeObserver(() => document.documentElement.style.setProperty("--bar", `${bar.offsetHeight}px`)).observe(bar);

  // ---- start ----
  async function start() {
    await share();
    given.persons.forEach(addCard);
    byId("left-out").textContent = given.left_out ? `${given.left_out} more, seen in less than 2 % of the take, are not shown.` : "";
    savedText = text();
    const kept = await work.read(), before = JSON.stringify([state.parts, state.loaded]);
    if (kept && kept.parts) {
      ({ past } = kept);
      state = { parts: kept.parts, loaded: kept.loaded, since: kept.since };
    }
    render();
    if (JSON.stringify([state.parts, state.loaded]) === before) return;
    const rows = others().flatMap((one) => one.rows);
    say(`Your work of ${new Date(kept.time).toLocaleString()} is here again${rows.length ? `, with ${counted(rows)} of other takes` : ""}.`);
  }
  courtside.keeping.start(start);
})();
