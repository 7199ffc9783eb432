// @ts-check
"use strict";
// Tables of clicks as text: the same columns, checks and words as the workflow's own reader.
const clickTables = (() => {
  const COURT = ["camera", "point", "frame_idx", "x_px", "y_px"];
  const RACKET = ["take", "camera", "frame_idx", "end", "x_px", "y_px"];

  function written(columns, rows) {
    const cell = (value) => (/[",\n]/.test(value) ? `"${String(value).replaceAll('"', '""')}"` : String(value));
    return [columns, ...rows].map((row) => row.map(cell).join(",")).join("\n") + "\n";
  }

  // Splits CSV text into rows of cells, quotes respected, cells without blanks around them.
  function cells(text) {
    const rows = [];
    let row = [], cell = "", quoted = false;
    const finish = () => { row.push(cell.trim()); cell = ""; };
    const source = text.replace(/^\ufeff/, "").replace(/\r\n?/g, "\n");
    for (let at = 0; at < source.length; at += 1) {
      const char = source[at];
      if (quoted) {
        if (char === '"' && source[at + 1] === '"') { cell += '"'; at += 1; }
        else if (char === '"') quoted = false;
        else cell += char;
      } else if (char === '"') quoted = true;
      else if (char === ",") finish();
      else if (char === "\n") { finish(); rows.push(row); row = []; }
      else cell += char;
    }
    if (cell || row.length) { finish(); rows.push(row); }
    return rows;
  }

  /**
   * Returns rows as objects; throws one line that says what is wrong and where.
   * @returns {Record<string, any>[]}
   */
  function read(name, text, columns) {
    const lines = cells(text).map((row, at) => [at + 1, row]).filter(([, row]) => row.some(Boolean));
    const header = lines.length ? lines[0][1] : [];
    if ([...header].sort().join() !== [...columns].sort().join()) {
      throw new Error(`${name}: expected the columns ${columns.join(",")}, found ${header.join(",").slice(0, 80) || "an empty file"}`);
    }
    return lines.slice(1).map(([line, row]) => {
      if (row.length !== header.length) {
        throw new Error(`${name}: line ${line}: expected ${header.length} cells, found ${row.length}; correct it`);
      }
      const found = Object.fromEntries(header.map((key, at) => [key, row[at]]));
      for (const key of ["x_px", "y_px", "frame_idx"]) {
        const value = Number(found[key]);
        if (found[key] === "" || !Number.isFinite(value)) {
          throw new Error(`${name}: line ${line}: expected ${key} as a number, found "${found[key].slice(0, 40)}"; correct it`);
        }
        found[key] = value;
      }
      return { line, ...found };
    });
  }

  return {
    COURT, RACKET, read,
    court: (rows) => written(COURT, rows.map((r) => [r.camera, r.point, r.frame_idx, r.x, r.y])),
    racket: (rows) => written(RACKET, rows.map((r) => [r.take, r.camera, r.frame_idx, r.point, r.x, r.y])),
  };
})();
