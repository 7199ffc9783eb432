// @ts-check
"use strict";
// The table of names as text: the columns and words of the workflow's own reader; the parts that its rows name.
const peopleTable = (() => {
  const COLUMNS = ["take", "subject", "camera", "time_s", "x_px", "y_px"];
  const BOUNDS = ["from_s", "to_s"];
  const SAME_PX = 1; // from the pixel of a picture's person
  const ROUNDING_S = 2e-3; // bounds are written to 1 ms, on the clock of a camera

  /** @param {any[][]} rows in the order of all columns */
  const written = (rows) => csv.written([...COLUMNS, ...BOUNDS], rows);

  function check(where, what, name, names) {
    if (names.includes(name)) return;
    throw new Error(`${where}: expected a ${what} of ${names.join(", ")}, found "${name.slice(0, 40)}"; correct it or delete the line`);
  }

  /**
   * Returns the rows by take, cells in the order of all columns; throws one line that says what is wrong.
   * @returns {Record<string, string[][]>}
   */
  function read(name, text, { takes, take, subjects, clocks }) {
    const known = [...COLUMNS, ...BOUNDS], found = {};
    const accepts = (header) => COLUMNS.every((key) => header.includes(key)) && header.every((key) => known.includes(key));
    const { header, rows } = csv.table(name, text, accepts, `${COLUMNS.join(",")} and perhaps ${BOUNDS.join(",")}`);
    for (const [line, row] of rows) {
      const where = `${name}: line ${line}`, cells = known.map((key) => (header.includes(key) ? row[header.indexOf(key)] : ""));
      check(where, "take", cells[0], takes);
      if (cells[0] === take) {
        check(where, "subject", cells[1], subjects);
        check(where, "camera", cells[2], Object.keys(clocks));
      }
      known.slice(3).forEach((key, at) => {
        const cell = cells[3 + at], empty = cell === "" && BOUNDS.includes(key);
        if (!empty && (cell === "" || !Number.isFinite(Number(cell)))) {
          throw new Error(`${where}: expected ${key} as a finite number, found "${cell.slice(0, 40)}"; correct it`);
        }
      });
      (found[cells[0]] ||= []).push(cells);
    }
    return found;
  }

  /**
   * Returns the name that each row of this take gives, as `parts` takes it, with its person; null where no picture
   * of the page is the row's.
   */
  function named(rows, { persons, clocks }) {
    return rows.map(([, subject, camera, time, x, y, ...bounds]) => {
      const there = (view) => view.camera === camera && Math.abs(view.time_s - time) < ROUNDING_S
        && Math.hypot(view.at_px[0] - x, view.at_px[1] - y) < SAME_PX;
      const person = persons.find((one) => one.columns.some((column) => column.views.some(there)));
      const [time_s, from_s, to_s] = [time, ...bounds].map((cell) => (cell === "" ? null : (cell - clocks[camera][0]) / clocks[camera][1]));
      return person ? { person: person.index, subject, time_s, from_s, to_s } : null;
    });
  }

  /**
   * Returns the parts of a take, [{from, subject}], by the names that one person was given before.
   * @param {any[]} given
   * @param {{start_s: number, stop_s: number}} take
   */
  function parts(given, take) {
    const names = [...given].sort((a, b) => a.time_s - b.time_s);
    const found = [{ from: take.start_s, subject: "" }];
    const open = (from) => { if (from !== null && from < take.stop_s - ROUNDING_S) found.push({ from, subject: "" }); };
    names.forEach((one, at) => {
      const before = names[at - 1];
      if (before && before.subject === one.subject && before.from_s === one.from_s) return;
      const from = one.from_s ?? (before ? before.to_s ?? (before.time_s + one.time_s) / 2 : take.start_s);
      if (before && before.to_s !== null && before.to_s < from - ROUNDING_S) open(before.to_s);
      if (from <= take.start_s + ROUNDING_S) found[0].subject = one.subject;
      else found.push({ from, subject: one.subject });
    });
    if (names.length) open(names[names.length - 1].to_s);
    return found;
  }

  return { written, read, named, parts };
})();
