// @ts-check
"use strict";
// Unfolds the target of a link, and everything before printing.
(() => {
  function unfold() {
    const place = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    for (let at = place; at; at = at.parentElement) if (at instanceof HTMLDetailsElement) at.open = true;
  }
  addEventListener("hashchange", unfold);
  addEventListener("beforeprint", () => document.querySelectorAll("details").forEach((item) => { item.open = true; }));
  unfold();
})();
