// @ts-check
"use strict";
// Opens whatever is folded away about a place that a link leads to, and everything before printing.
(() => {
  function unfold() {
    const place = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    for (let at = place; at; at = at.parentElement) if (at instanceof HTMLDetailsElement) at.open = true;
  }
  addEventListener("hashchange", unfold);
  addEventListener("beforeprint", () => document.querySelectorAll("details").forEach((item) => { item.open = true; }));
  unfold();
})();
