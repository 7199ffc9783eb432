// @ts-check
"use strict";
// The table of names as text: the columns and words of the workflow's own reader; the parts that its rows name.
const peopleTable = (() => {
  const COLUMNS = ["take", "subject", "camera", "time_s", "x_px", "y_px"];
  const BOUNDS = ["from_s", "to_s"];
  const ROUNDING_S = 2e-3; // bounds are written to 1 ms, on the clock of a camera

  /** @param {any[][]} rows in the order of all columns */
  function written(rows) {
    const cell = (value) => (/[",\n]/.test(String(value)) ? `"${String(value).replaceAll('"', '""')}"` : String(value));
    return [[...COLUMNS, ...BOUNDS], ...rows].map((row) => row.map(cell).join(",")).join("\n") + "\n";
  }

  // Returns the rows of other takes, cells in the order of all columns; throws one line that says what is wrong.
  function others(name, text, take) {
    const lines = text.replace(/^\ufeff/, "").split(/\r\n?|\n/).filter((line) => line.trim());
    const cells = lines.map((line) => line.split(",").map((one) => one.trim().replace(/^"(.*)"$/, "$1")));
    const header = cells[0] || [];
    const known = [...COLUMNS, ...BOUNDS];
    if (!COLUMNS.every((key) => header.includes(key)) || !header.every((key) => known.includes(key))) {
      throw new Error(`${name}: expected the columns ${COLUMNS.join(",")} and perhaps ${BOUNDS.join(",")}, found ${lines[0]?.slice(0, 80) || "an empty file"}`);
    }
    return cells.slice(1).map((row, at) => {
      if (row.length !== header.length) {
        throw new Error(`${name}: row ${at + 1}: expected ${header.length} cells, found ${row.length}; correct it`);
      }
      return known.map((key) => (header.includes(key) ? row[header.indexOf(key)] : ""));
    }).filter((row) => row[0] !== take);
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
