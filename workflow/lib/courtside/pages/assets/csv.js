// @ts-check
"use strict";
// Comma-separated text, as the workflow's own reader takes it.
const csv = (() => {
  /** @param {any[][]} rows */
  function written(columns, rows) {
    const cell = (value) => (/[",\n]/.test(String(value)) ? `"${String(value).replaceAll('"', '""')}"` : String(value));
    return [columns, ...rows].map((row) => row.map(cell).join(",")).join("\n") + "\n";
  }

  // Splits text into rows of cells, quotes respected, cells without blanks around them.
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
   * Returns the header and [line, cells] of the rows that follow; throws one line that names the file.
   * @param {(header: string[]) => boolean} accepts
   * @param {string} expected in words
   * @returns {{header: string[], rows: any[][]}}
   */
  function table(name, text, accepts, expected) {
    const lines = cells(text).map((row, at) => [at + 1, row]).filter(([, row]) => row.some(Boolean));
    const header = lines.length ? lines[0][1] : [];
    if (!accepts(header)) {
      throw new Error(`${name}: expected the columns ${expected}, found ${header.join(",").slice(0, 80) || "an empty file"}`);
    }
    for (const [line, row] of lines.slice(1)) {
      if (row.length !== header.length) {
        throw new Error(`${name}: line ${line}: expected ${header.length} cells, found ${row.length}; correct it`);
      }
    }
    return { header, rows: lines.slice(1) };
  }

  return { written, table };
})();
