// @ts-check
"use strict";
// The table of names as text: the columns and words of the workflow's own reader; the parts that its rows name.
const peopleTable = (() => {
  const COLUMNS = ["take", "subject", "camera", "time_s", "x_px", "y_px"];
  const BOUNDS = ["from_s", "to_s"];
  const ROUNDING_S = 2e-3; // bounds are written to 1 ms, on the clock of a camera

  /** @param {any[][]} rows in the order of all columns */
  const written = (rows) => csv.written([...COLUMNS, ...BOUNDS], rows);

  // Returns the rows of other takes, cells in the order of all columns; throws one line that says what is wrong.
  function others(name, text, take) {
    const known = [...COLUMNS, ...BOUNDS];
    const accepts = (header) => COLUMNS.every((key) => header.includes(key)) && header.every((key) => known.includes(key));
    const { header, rows } = csv.table(name, text, accepts, `${COLUMNS.join(",")} and perhaps ${BOUNDS.join(",")}`);
    return rows.map(([, row]) => known.map((key) => (header.includes(key) ? row[header.indexOf(key)] : "")))
      .filter((row) => row[0] !== take);
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

  return { written, others, parts };
})();
