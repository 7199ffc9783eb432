// @ts-check
"use strict";
// What every page may use: data and pictures inside the file, storage that may be forbidden, saving and copying.
const courtside = (() => {
  const parsed = new Map();

  function stored(id) {
    if (!parsed.has(id)) {
      const element = document.getElementById(id);
      if (!element) throw new Error(`the page holds no ${id}`);
      parsed.set(id, JSON.parse(element.textContent));
    }
    return parsed.get(id);
  }

  function image(name) {
    const address = stored("images")[name];
    if (!address) throw new Error(`the page holds no picture ${name}`);
    return address;
  }

  // Browsers may forbid storage to files, or it may be full: the page works without.
  const storage = {
    get(key) {
      try { return JSON.parse(window.localStorage.getItem(key)); } catch { return null; }
    },
    set(key, value) {
      try { window.localStorage.setItem(key, JSON.stringify(value)); return true; } catch { return false; }
    },
    remove(key) {
      try { window.localStorage.removeItem(key); return true; } catch { return false; }
    },
  };

  function download(name, text, mime = "text/plain") {
    const address = URL.createObjectURL(new Blob([text], { type: `${mime};charset=utf-8` }));
    const link = Object.assign(document.createElement("a"), { href: address, download: name });
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(address), 10000);
  }

  async function copy(text) {
    try {
      await navigator.clipboard.writeText(text);
      return true;
    } catch {
      const area = Object.assign(document.createElement("textarea"), { value: text });
      document.body.append(area);
      area.select();
      const done = document.execCommand("copy");
      area.remove();
      return done;
    }
  }

  return { data: (name) => stored(`data-${name}`), image, storage, download, copy };
})();
