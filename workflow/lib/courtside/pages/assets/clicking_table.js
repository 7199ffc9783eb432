// @ts-check
"use strict";
// Tables of clicks as text: the same columns, checks and words as the workflow's own reader.
const clickTables = (() => {
  const COURT = ["camera", "point", "frame_idx", "x_px", "y_px"];
  const RACKET = ["take", "camera", "frame_idx", "end", "x_px", "y_px"];

  /**
   * Returns rows as objects; throws one line that says what is wrong and where.
   * @returns {Record<string, any>[]}
   */
  function read(name, text, columns) {
    const same = (header) => [...header].sort().join() === [...columns].sort().join();
    const { header, rows } = csv.table(name, text, same, columns.join(","));
    return rows.map(([line, row]) => {
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
    court: (rows) => csv.written(COURT, rows.map((r) => [r.camera, r.point, r.frame_idx, r.x, r.y])),
    racket: (rows) => csv.written(RACKET, rows.map((r) => [r.take, r.camera, r.frame_idx, r.point, r.x, r.y])),
  };
})();
