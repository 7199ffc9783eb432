// @ts-check
"use strict";
// The table of names as text: the columns and words of the workflow's own reader.
const peopleTable = (() => {
  const COLUMNS = ["take", "subject", "camera", "time_s", "x_px", "y_px"];
  const BOUNDS = ["from_s", "to_s"];

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

  return { written, others };
})();
