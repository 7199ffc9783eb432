// @ts-check
"use strict";
// What every page may use: data and pictures inside the file, elements, saving, copying.
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

  return { data: (name) => stored(`data-${name}`), image, byId, element, button, say, download, copy };
})();
