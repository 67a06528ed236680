"use strict";
// Choosing a state of a picture shows how it is reached and left.
for (const figure of document.querySelectorAll("figure.graph")) {
  const svg = figure.querySelector("svg"), pane = figure.querySelector(".chosen");
  const choose = (node) => {
    const n = node.dataset.node, already = node.classList.contains("now");
    for (const other of svg.querySelectorAll(".now, .in, .out")) other.classList.remove("now", "in", "out");
    svg.classList.toggle("picked", !already);
    if (already) { pane.innerHTML = '<p class="hint">Choose a state to see how it is reached and left.</p>'; return; }
    node.classList.add("now");
    for (const edge of svg.querySelectorAll(".edge")) {
      const both = "both" in edge.dataset, {from, to} = edge.dataset;
      if (to === n || (both && from === n)) edge.classList.add("in");
      if (from === n || (both && to === n)) edge.classList.add("out");
    }
    pane.innerHTML = document.getElementById(node.dataset.info).innerHTML;
  };
  for (const node of svg.querySelectorAll("[data-info]")) {
    node.addEventListener("click", () => choose(node));
    node.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") { event.preventDefault(); choose(node); }
    });
  }
}
// Paper cannot be opened.
addEventListener("beforeprint", () => {
  for (const part of document.querySelectorAll("details:not([open])")) { part.open = true; part.dataset.opened = ""; }
});
addEventListener("afterprint", () => {
  for (const part of document.querySelectorAll("details[data-opened]")) { part.open = false; delete part.dataset.opened; }
});
