// @ts-check
"use strict";
// What every page may use: data and pictures inside the file, elements, storage that may be forbidden, saving, copying.
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

  /** @type {(id: string) => any} every page holds its elements, of whatever kind */
  const byId = (id) => document.getElementById(id);

  /** @returns {any} an element with these properties and children */
  function element(kind, properties = {}, ...children) {
    const made = Object.assign(document.createElement(kind), properties);
    made.append(...children);
    return made;
  }

  function button(parent, words, action, properties = {}) {
    const made = element("button", { textContent: words, type: "button", ...properties });
    made.addEventListener("click", action);
    parent.append(made);
    return made;
  }

  function say(words, bad = false) {
    byId("message").textContent = words;
    byId("message").classList.toggle("bad", bad);
  }

  // Browsers may forbid storage to files, or it may be full: the page works without.
  const storage = {
    text(key) {
      try { return window.localStorage.getItem(key); } catch { return null; }
    },
    get(key) {
      try { return JSON.parse(storage.text(key)); } catch { return null; }
    },
    set(key, value) {
      try { window.localStorage.setItem(key, JSON.stringify(value)); return true; } catch { return false; }
    },
    remove(key) {
      try { window.localStorage.removeItem(key); return true; } catch { return false; }
    },
  };

  const NOWHERE = "This browser keeps nothing: save the file before you close or reload the page.";
  const ELSEWHERE = "Another tab has changed the work of this page: reload before you go on; what you do here is no longer kept.";

  /**
   * Keeps a page's work under a key. #unkept says why it is not kept; then leaving unsaved work is asked about.
   * @param {() => boolean} unsaved
   */
  function keeper(key, unsaved) {
    let last = storage.text(key), open = false; // what this tab read or wrote last; whether a change is not kept
    const elsewhere = () => storage.text(key) !== last;
    function warn(words) {
      byId("unkept").textContent = words;
      byId("unkept").hidden = !words;
    }
    window.addEventListener("storage", () => { if (elsewhere()) warn(ELSEWHERE); });
    window.addEventListener("beforeunload", (event) => { if (open && unsaved()) event.preventDefault(); });
    return {
      read: () => storage.get(key),
      /** Says whether the work is kept. */
      keep(value) {
        open = elsewhere() || !storage.set(key, value);
        warn(!open ? "" : elsewhere() ? ELSEWHERE : NOWHERE);
        if (!open) last = storage.text(key);
        return !open;
      },
      forget() {
        storage.remove(key);
        last = null;
      },
    };
  }

  function download(name, text, mime = "text/plain") {
    const address = URL.createObjectURL(new Blob([text], { type: `${mime};charset=utf-8` }));
    const link = element("a", { href: address, download: name });
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
      const area = element("textarea", { value: text });
      document.body.append(area);
      area.select();
      const done = document.execCommand("copy");
      area.remove();
      return done;
    }
  }

  return { data: (name) => stored(`data-${name}`), image, byId, element, button, say, storage, keeper, download, copy };
})();
