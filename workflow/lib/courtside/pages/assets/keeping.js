// @ts-check
"use strict";
// Keeps a page's work in the browser's database, if the browser lets it. Not in `localStorage`: of pages opened as
// files, Chromium shows about one in forty an empty one, and forgets what it writes there.
courtside.keeping = (() => {
  const DATABASE = "courtside", STORE = "work", WAIT_MS = 5000;
  const ELSEWHERE = "Another tab has changed the work of this page: reload before you go on; what you do here is no longer kept.";
  const NOWHERE = "This browser keeps nothing: save the file before you close or reload the page.";
  const listeners = [];
  let opened = null, channel = null; // null also where the browser forbids them

  const answer = (request) => new Promise((given, failed) => {
    request.onsuccess = () => given(request.result);
    request.onerror = () => failed(request.error);
  });
  const done = (transaction) => new Promise((complete, failed) => {
    transaction.oncomplete = complete;
    transaction.onabort = () => failed(transaction.error);
    transaction.commit();
  });

  function open() {
    const request = indexedDB.open(DATABASE, 1);
    request.onupgradeneeded = () => request.result.createObjectStore(STORE);
    const late = new Promise((_, failed) => { setTimeout(() => failed(new Error("the browser opens no database")), WAIT_MS); });
    return Promise.race([answer(request), late]);
  }

  try { channel = new BroadcastChannel(DATABASE); } catch { /* other tabs are not heard */ }
  if (channel) channel.onmessage = ({ data }) => listeners.forEach((one) => { if (one.key === data) one.told(); });
  /** Call `told` when another tab has changed what is kept under a key. */
  const listen = (key, told) => listeners.push({ key, told });

  async function store(mode) {
    opened = opened || open();
    return (await opened).transaction(STORE, mode).objectStore(STORE);
  }

  /** Returns the text that is kept under a key, or null. */
  async function read(key) {
    try { return (await answer((await store("readonly")).get(key))) || null; } catch { return null; }
  }

  /** Keeps `change(text)` of the text that is kept under a key; unless that is undefined. Returns it. */
  async function write(key, change) {
    const place = await store("readwrite"), text = change((await answer(place.get(key))) || null);
    if (text === undefined) return text;
    if (text === null) place.delete(key);
    else place.put(text, key);
    await done(place.transaction);
    if (channel) channel.postMessage(key);
    return text;
  }

  /**
   * Keeps the work of one page under a key. #unkept says why it is not kept; then leaving unsaved work is asked about.
   * @param {() => boolean} unsaved
   */
  function keeper(key, unsaved) {
    let last = null; // what this tab read or wrote last
    let isOpen = false, waiting = 0; // whether the last change is not kept, and how many are being kept
    function warn(words) {
      courtside.byId("unkept").textContent = words;
      courtside.byId("unkept").hidden = !words;
    }
    listen(key, async () => { if ((await read(key)) !== last) warn(ELSEWHERE); });
    window.addEventListener("beforeunload", (event) => { if ((isOpen || waiting) && unsaved()) event.preventDefault(); });

    async function swap(text) {
      const before = last;
      last = text;
      waiting += 1;
      try {
        isOpen = (await write(key, (found) => (found === before ? text : undefined))) === undefined;
        warn(isOpen ? ELSEWHERE : "");
      } catch {
        isOpen = true;
        warn(NOWHERE);
      }
      if (isOpen && last === text) last = before;
      waiting -= 1;
      return !isOpen;
    }

    return {
      /** Returns the work that is kept, or null. */
      async read() {
        last = await read(key);
        try { return JSON.parse(last); } catch { return null; }
      },
      /** Says whether the work is kept. */
      keep: (value) => swap(JSON.stringify(value)),
      forget: () => swap(null),
    };
  }

  /** What all pages of a session share under a key: `told(value)` is called with what it is, then after each change. */
  async function shared(key, told) {
    const tell = async () => told(JSON.parse(await read(key)));
    listen(key, tell);
    await tell();
    return {
      /** Keeps `change(value)`, unless the browser forbids it. */
      async change(change) {
        try { await write(key, (text) => JSON.stringify(change(JSON.parse(text)))); } catch { return; }
        await tell();
      },
    };
  }

  /** Runs `first` to its end; until then the page takes no keys and clicks, and says that it is busy. */
  async function start(first) {
    const hush = (event) => event.stopPropagation(), events = ["keydown", "pointerdown", "click"];
    events.forEach((name) => window.addEventListener(name, hush, true));
    document.body.setAttribute("aria-busy", "true");
    await first();
    document.body.removeAttribute("aria-busy");
    events.forEach((name) => window.removeEventListener(name, hush, true));
  }

  return { keeper, shared, start };
})();
