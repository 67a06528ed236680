// The page of `stillpoint explore`. What it shows is a function of the link: the system, the hash of its specification, the
// walk, the cycle of it that is shown, and the inputs held. Every text of the file becomes a text node, never markup.
"use strict";

const at = (id) => document.getElementById(id);
let known = null; // what /api/systems told
let link = null; // what the link says
let shown = null; // the view on the page
const FEW = 60; // outcomes shown at first
let listed = []; // the outcomes on the page
let chosen = 0; // the one chosen by the arrow keys
let asked = 0; // requests for views are numbered, a late answer is dropped
const opened = new Set(); // properties whose details are open
let unfolded = false; // whether the properties with nothing to say are shown

// Elements.
function el(tag, attributes, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes || {})) {
    if (value === null || value === undefined || value === false) continue;
    if (key === "onclick" || key === "onchange" || key === "ontoggle") element[key] = value;
    else element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}
const span = (kind, text) => el("span", { class: kind }, text);

// The link.
function written(wanted) {
  const pairs = [["system", wanted.system], ["spec", wanted.hash], ["path", wanted.path]];
  if (wanted.at !== null) pairs.push(["at", wanted.at]);
  if (wanted.held) pairs.push(["held", wanted.held]);
  return "#" + pairs.map(([key, value]) => key + "=" + encodeURIComponent(value)).join("&");
}
function read(fragment) {
  const found = {};
  for (const pair of fragment.replace(/^#/, "").split("&")) {
    const cut = pair.indexOf("=");
    if (cut > 0) {
      try { found[pair.slice(0, cut)] = decodeURIComponent(pair.slice(cut + 1)); } catch { found[pair.slice(0, cut)] = pair.slice(cut + 1); }
    }
  }
  return found;
}
function system(name) { return known.systems.find((s) => s.name === name); }
function begin(name) {
  const own = system(name) || system(known.start) || known.systems[0];
  return { system: own.name, hash: own.hash, path: "0", at: null, held: "" };
}
function go(changes) {
  const wanted = written({ ...link, ...changes });
  if (wanted === location.hash) load(); else location.hash = wanted;
}

// Requests.
async function answer(response) {
  let body = null;
  try { body = await response.json(); } catch { /* told by the status */ }
  if (!response.ok) throw Object.assign(new Error((body && body.error) || "status " + response.status), { status: response.status });
  return body;
}
function post(address, body) {
  return fetch(address, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });
}
const gone = (error) => (error.status ? error.message : "The command that serves this page has ended; start it again and reload.");

async function load() {
  const found = read(location.hash);
  if (!found.system) {
    history.replaceState(null, "", written(begin(known.start)));
    return load();
  }
  const number = found.at === undefined ? null : Number(found.at);
  link = { system: found.system, hash: found.spec || "", path: found.path || "0", at: number, held: found.held || "" };
  const mine = ++asked;
  const wanted = { system: link.system, hash: link.hash, path: link.path, held: link.held };
  if (link.at !== null) wanted.at = link.at;
  try {
    const view = await answer(await post("/api/view", wanted));
    if (mine !== asked) return;
    shown = view;
    // Rules are told by their numbers.
    const rules = system(link.system).rules;
    if (view.fired) view.fired = view.fired.map((k) => rules[k]);
    if (view.next) for (const item of view.next.classes) item.rules = item.rules.map((k) => rules[k]);
    chosen = 0;
    render();
  } catch (error) {
    if (mine === asked) refuse(error);
  }
}

// What cannot be shown.
function refuse(error) {
  shown = null;
  at("main").hidden = true;
  at("position").textContent = "–";
  for (const id of ["first", "back", "forward", "last", "slider"]) at(id).disabled = true;
  const own = system(link.system);
  const box = at("refused");
  box.hidden = false;
  box.replaceChildren(el("h2", {}, error.status === 409 ? "This link belongs to another specification" : "This cannot be shown"),
    el("p", {}, gone(error)));
  if (error.status) {
    box.append(el("button", { id: "begin", onclick: () => { link = begin(link.system); go({}); } }, "Begin at the initial state"));
    if (error.status === 409 && own) {
      box.append(el("button", { id: "anyway", onclick: () => go({ hash: own.hash }) }, "Make the same choices in this one"));
    }
  }
  document.body.dataset.ready = "refused";
}

// The page.
function render() {
  const own = system(link.system);
  at("refused").hidden = true;
  at("main").hidden = false;
  at("title").textContent = own.title || known.title;
  at("system").value = own.name;
  document.title = `${own.name}, cycle ${shown.at} – Stillpoint`;
  const time = own.scaled || shown.at === 0 ? "" : ` · ${milliseconds(shown.at * own.cycle_us)}`;
  at("position").textContent = `Cycle ${shown.at} of ${shown.length}${time}`;
  at("first").disabled = at("back").disabled = shown.at === 0;
  at("last").disabled = at("forward").disabled = shown.at === shown.length;
  const slider = at("slider");
  slider.disabled = shown.length === 0;
  slider.max = shown.length;
  slider.value = shown.at;
  lastCycle();
  at("machines").replaceChildren(...shown.machines.filter((m) => m.states.length + m.outputs.length).map(machine));
  next(own);
  properties(own);
  diagram();
  control();
  const parameters = own.parameters.concat(own.readings).map(([name, value]) => `${name} = ${value}`);
  at("about").textContent = `Stillpoint ${known.version} · system ${own.system} · specification ${own.hash}`
    + (parameters.length ? ` · ${parameters.join(", ")}` : "")
    + own.abstractions.map((a) => ` · abstraction: ${a}`).join("");
  document.body.dataset.ready = `${shown.path}@${shown.at}`;
}
function milliseconds(us) {
  return `${(us / 1000).toFixed(3).replace(/\.?0+$/, "")} ms`;
}
function hint(item) {
  return [item.text || item.note, (item.requirements || []).join(" ")].filter(Boolean).join("\n") || null;
}

function lastCycle() {
  const box = at("last-cycle");
  if (shown.at === 0) {
    box.replaceChildren(el("p", { class: "dim" }, "The initial state. No cycle was made yet."));
    return;
  }
  const inputs = shown.inputs.map((i) => [span("name", `${i.name} = ${i.value}`), ", "]).flat().slice(0, -1);
  const rules = shown.fired.map((r) => [el("span", { class: "name", title: hint(r) }, r.name), ", "]).flat().slice(0, -1);
  box.replaceChildren(
    el("p", { id: "made" }, span("dim", "Inputs read: "), ...(inputs.length ? inputs : ["none"])),
    el("p", {}, span("dim", "Rules fired: "), ...(rules.length ? rules : ["none"])));
  if (shown.fault) box.append(el("p", {}, span("chip bad", "fault"), ` ${shown.fault}: there is no state after this cycle.`));
}

function cell(item) {
  const value = item.value === null ? "–" : item.value;
  const kind = item.value === null ? "none" : item.kind === "bool" && value === "FALSE" ? "false" : item.kind;
  return el("div", { class: item.before ? "cell changed" : "cell", title: hint(item), "data-name": item.name },
    span("key", item.name),
    el("span", { class: `value ${kind}` }, item.before ? el("s", {}, item.before) : null, value));
}
function machine(m) {
  const box = el("div", { class: "machine", "data-machine": m.name }, el("h3", {}, m.name, el("small", {}, m.machine)));
  if (m.states.length) box.append(el("div", { class: "cells states" }, ...m.states.map(cell)));
  if (m.outputs.length && shown.at > 0) {
    box.append(el("p", { class: "label" }, "outputs of the cycle"), el("div", { class: "cells outputs" }, ...m.outputs.map(cell)));
  }
  return box;
}

// What comes next.
function held() {
  return new Map(link.held.split("!").filter(Boolean).map((pair) => pair.split("=").map(Number)));
}
function hold(number, value) {
  const all = held();
  if (value === null) all.delete(number); else all.set(number, value);
  go({ held: [...all].sort((a, b) => a[0] - b[0]).map((pair) => pair.join("=")).join("!") });
}
function next(own) {
  const list = shown.next;
  const open = new Set(shown.properties.flatMap((p) => p.says.flatMap((s) => s.open || [])));
  at("hold").hidden = !list || own.inputs.length === 0;
  at("initials").replaceChildren();
  if (!list) {
    at("next-text").textContent = "There is no next cycle after a fault.";
    at("classes").replaceChildren();
    at("filter").hidden = true;
    listed = [];
    return;
  }
  const n = list.classes.length;
  at("next-text").textContent = `${n} ${n === 1 ? "outcome" : "outcomes"} of ${list.combinations} input combinations`
    + (list.complete ? "." : `; only the first ${list.most} cycles were made, hold inputs to see the others.`);
  const all = held();
  const readable = new Set(list.read);
  at("held-text").textContent = all.size ? `(${all.size} held)` : "";
  const order = own.inputs.map((input, k) => [input, k]);
  const rank = ([input, k]) => (all.has(k) ? 0 : readable.has(k) ? 1 : open.has(input.name) ? 2 : 3);
  order.sort((a, b) => rank(a) - rank(b) || a[1] - b[1]);
  at("inputs").replaceChildren(...order.map(([input, k]) => holder(input, k, all, readable)));
  at("filter").hidden = n < 10 && !at("filter").value;
  outcomes(FEW);
  if (shown.initials) initials();
}
// The outcomes on the page: those that the filter lets through, the first ones of many.
function outcomes(most) {
  const wanted = at("filter").value.trim().toLowerCase();
  const all = shown.next.classes;
  const fitting = wanted ? all.filter((item) => words(item).includes(wanted)) : all;
  listed = fitting.slice(0, most);
  chosen = 0;
  at("classes").replaceChildren(...listed.map(one));
  if (fitting.length > listed.length) {
    at("classes").append(el("li", {}, el("button", { id: "more", onclick: () => outcomes(Infinity) }, `Show all ${fitting.length}`)));
  }
  if (!listed.length) at("classes").append(el("li", { class: "dim" }, "No outcome fits the filter."));
  choose(0);
}
function words(item) {
  const rules = item.rules.map((r) => [r.name, ...r.requirements]).flat();
  return [...rules, ...item.changes.map(change), ...item.when.map(condition), ...item.broken, item.fault || ""].join("\n").toLowerCase();
}
const change = ([name, a, b]) => `${name}: ${a} → ${b}`;
const condition = ([name, values]) => `${name} = ${values.join(", ")}`;
function holder(input, k, all, readable) {
  const value = all.has(k) ? all.get(k) : null;
  let field;
  if (input.values) {
    field = el("select", { onchange: (e) => hold(k, e.target.value === "" ? null : Number(e.target.value)) },
      el("option", { value: "" }, "any"), ...input.values.map((v, n) => el("option", { value: n }, v)));
    field.value = value === null ? "" : String(value);
  } else {
    field = el("input", { type: "number", min: input.lo, max: input.hi, placeholder: "any",
      onchange: (e) => hold(k, e.target.value === "" ? null : Math.min(input.hi, Math.max(input.lo, Math.trunc(Number(e.target.value)))) - input.lo) });
    if (value !== null) field.value = value + input.lo;
  }
  const kind = value !== null ? "held" : readable.has(k) ? "" : "unread";
  const title = [input.text, readable.has(k) ? "" : "no cycle of this state reads it"].filter(Boolean).join("\n");
  return el("label", { class: kind, title: title || null }, input.name, field);
}
function one(item, number) {
  const head = [span("number", number < 9 ? String(number + 1) : "")];
  if (item.rules.length) head.push(el("span", { class: "name" }, item.rules.map((r) => r.name).join(", ")));
  else head.push(span("dim", "no rule fires"));
  for (const id of item.broken) head.push(" ", span("chip bad", `violates ${id}`));
  if (item.fault) head.push(" ", span("chip bad", item.fault));
  else if (!item.changes.length) head.push(" ", span("chip", "same state"));
  const lines = [];
  if (item.changes.length) lines.push(el("span", { class: "line" }, item.changes.map(change).join(", ")));
  const written = (list) => list.map(condition).join("; ");
  const special = item.when.filter(([, , least]) => !least);
  const rest = item.when.length - special.length;
  // Few conditions are told in full, of many those that stand out.
  const when = rest > 2 ? special.length ? `${written(special)}; ${rest} others FALSE or least` : `${rest} inputs FALSE or least` : written(item.when);
  const exactly = item.exact ? (when ? `if ${when}` : "whatever the inputs are") : when ? `only if ${when}, and more` : "for several combinations of inputs";
  lines.push(el("span", { class: "line dim" }, `${exactly} · ${item.combinations} ${item.combinations === "1" ? "combination" : "combinations"}`));
  const rules = item.rules.map((r) => [r.name, hint(r)].filter(Boolean).join(": ")).concat(rest > 2 ? [written(item.when)] : []).join("\n");
  return el("li", {}, el("button", { title: rules || null, "data-choice": item.choice, onclick: () => step(number) }, ...head, ...lines));
}
function choose(number) {
  const items = at("classes").children;
  if (!listed.length) return;
  const before = chosen;
  chosen = Math.max(0, Math.min(listed.length - 1, number));
  if (items[before]) items[before].classList.remove("chosen");
  items[chosen].classList.add("chosen");
  if (chosen !== before) items[chosen].scrollIntoView({ block: "nearest" });
}
function step(number) {
  const item = shown && shown.next && listed[number];
  if (!item) return;
  notice("");
  // The same step as the walk goes on along it, another one begins a new walk here.
  if (shown.parts[shown.at + 1] === item.choice) return move(shown.at + 1);
  if (shown.at >= known.most_cycles) return notice(`A walk has at most ${known.most_cycles} cycles.`);
  go({ path: [...shown.parts.slice(0, shown.at + 1), item.choice].join("."), at: null });
}
function move(cycle) {
  if (!shown || cycle < 0 || cycle > shown.length || cycle === shown.at) return;
  go({ path: shown.path, at: cycle === shown.length ? null : cycle });
}
function initials() {
  const all = shown.initials;
  const present = shown.parts[0];
  const select = el("select", { id: "initial", onchange: (e) => go({ path: e.target.value, at: null }) },
    ...all.states.map((s) => el("option", { value: s.choice }, s.values.map(([n, v]) => `${n} = ${v}`).join(", "))));
  select.value = present;
  at("initials").replaceChildren(el("label", {}, span("dim", all.complete ? "Initial state " : `Initial state (the first ${all.states.length}) `), select));
}

// Control states, drawn once for each system.
let drawn = null;
async function control() {
  if (!at("control").open) return;
  const own = system(link.system);
  if (drawn !== own) {
    drawn = own;
    at("graphs").replaceChildren(el("p", { class: "dim" }, "Exploring …"));
    try {
      const found = await answer(await post("/api/control", { system: own.name, hash: own.hash }));
      if (drawn !== own) return;
      if (!found.graphs) {
        at("graphs").replaceChildren(el("p", {}, "The exploration met its limit first, so nothing is drawn. Start with a larger --time or --memory."));
        return;
      }
      at("graphs").replaceChildren(...found.graphs.map((g) => el("div", { "data-machine": g.machine }, picture(g.svg))));
      if (!found.graphs.length) at("graphs").append(el("p", { class: "dim" }, "No machine has a variable with an enumeration as type."));
    } catch (error) {
      drawn = null;
      at("graphs").replaceChildren(el("p", {}, gone(error)));
      return;
    }
  }
  if (!shown) return;
  for (const box of at("graphs").children) {
    const machine = shown.machines.find((m) => m.name === box.dataset.machine);
    const values = machine ? machine.states.filter((s) => s.kind === "enum").map((s) => s.value).join(" ") : "";
    for (const node of box.querySelectorAll("g.node")) {
      const label = [...node.querySelectorAll("text")].map((t) => t.textContent).join(" ");
      node.classList.toggle("present", label === values);
    }
  }
}
function picture(svg) {
  return document.importNode(new DOMParser().parseFromString(svg, "image/svg+xml").documentElement, true);
}

// Properties.
const TONES = { broken: "bad", pending: "warm", open: "warm", met: "good", seen: "good" };
const RANKS = { broken: 0, pending: 2, open: 3 };
function properties(own) {
  const rows = shown.properties.map((p, k) => ({ ...p, ...own.properties[k], state: p }));
  const rank = (p) => (p.state.broken && p.standing !== "broken" ? 1 : RANKS[p.standing] ?? 4);
  rows.sort((a, b) => rank(a) - rank(b));
  // Of many properties those that have nothing to say are folded away.
  const quiet = (p) => ["idle", "none", "other", "unseen"].includes(p.standing) && !p.state.broken && !opened.has(p.id);
  const silent = rows.length > 8 ? rows.filter(quiet) : [];
  at("judged").replaceChildren(...rows.filter((p) => !silent.includes(p)).map(property));
  if (silent.length) {
    const rest = el("details", { id: "rest", ontoggle: () => { unfolded = rest.open; } },
      el("summary", {}, `${silent.length} of which nothing is asked here`), ...silent.map(property));
    rest.open = unfolded;
    at("judged").append(rest);
  }
  if (!rows.length) at("judged").append(el("p", { class: "dim" }, "This system states no property."));
}
function property(p) {
  const earlier = p.state.broken && p.standing !== "broken";
  const head = el("summary", {}, span("name", p.id), el("span", { class: "words" }, p.text || p.written.map((w) => w.join(" ")).join("; ")),
    earlier ? span("chip bad", `violated in cycle ${p.state.broken}`) : null, span(`chip ${TONES[p.standing] || ""}`, p.state.text));
  const says = p.says.map((s) => el("tr", {}, el("td", {}, s.key), el("td", { class: "name" }, s.text), el("td", {}, value(s))));
  const bounds = p.written.filter(([key]) => ["within", "exactly", "fastest", "observe", "of"].includes(key))
    .map(([key, text]) => el("tr", {}, el("td", {}, key), el("td", { class: "name" }, text), el("td", {})));
  const body = el("div", { class: "body" }, el("table", { class: "says" }, ...says, ...bounds),
    p.note ? el("p", { class: "dim" }, p.note) : null,
    p.requirements.length ? el("p", { class: "dim" }, p.requirements.join(" ")) : null,
    el("button", { class: "small", "data-run": p.id, onclick: (e) => run(p.id, e.target) }, "Find its counterexample or witness"));
  const box = el("details", { class: "property", "data-id": p.id, "data-standing": p.standing,
    ontoggle: () => (box.open ? opened.add(p.id) : opened.delete(p.id)) }, head, body);
  box.open = opened.has(p.id);
  return box;
}
function value(s) {
  if (s.open) return el("span", { class: "chip warm", title: `depends on ${s.open.join(", ")}` }, `depends on ${s.open.length > 2 ? s.open.length + " inputs" : s.open.join(", ")}`);
  if (s.value === null) return span("dim", "–");
  return span(s.value ? "chip good" : "chip", s.value ? "TRUE" : "FALSE");
}
async function run(id, button) {
  button.disabled = true;
  notice(`Exploring for ${id} …`);
  const [from, own] = [location.hash, link];
  try {
    const found = await answer(await post("/api/run", { system: own.system, hash: own.hash, property: id }));
    notice(`${id}: ${found.text}`);
    if (found.other) {
      at("notice").append(" ", el("a", { href: written({ ...own, path: found.other, at: null, held: "" }) }, "The run beside it"));
    }
    // Whoever has walked on meanwhile is not carried away.
    if (found.path !== null && location.hash === from) go({ path: found.path, at: null, held: "" });
  } catch (error) {
    notice(`${id}: ${gone(error)}`);
  }
  button.disabled = false;
}

// History.
function diagram() {
  const box = at("diagram");
  at("save-svg").hidden = shown.length === 0;
  at("save-recording").hidden = shown.length === 0 || !system(link.system).recordable;
  if (shown.length === 0) box.replaceChildren(el("p", { class: "dim" }, "The diagram begins with the first cycle."));
  else if (shown.diagram === null) box.replaceChildren(el("p", { class: "dim" }, "The walk is too long to be drawn here; it can be saved."));
  else box.replaceChildren(picture(shown.diagram));
}
async function save(address, name) {
  try {
    const response = await post(address, { system: link.system, hash: link.hash, path: shown.path });
    if (!response.ok) await answer(response);
    const target = URL.createObjectURL(await response.blob());
    el("a", { href: target, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(target), 1000);
  } catch (error) {
    notice(gone(error));
  }
}
function notice(text) {
  at("notice").textContent = text;
  at("notice").hidden = !text;
}
async function copy() {
  try {
    await navigator.clipboard.writeText(location.href);
    notice("The link is on the clipboard.");
  } catch {
    notice(`The browser does not allow it here; copy the address of the page: ${location.href}`);
  }
}
function help() {
  if (at("help").open) at("help").close(); else at("help").showModal();
}

// Keys.
function key(event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const tag = event.target.tagName;
  if (tag === "SELECT" || tag === "INPUT" || tag === "TEXTAREA") return;
  if (event.key === "?") { event.preventDefault(); return help(); }
  if (at("help").open || !shown) return;
  // On a button or a summary Enter does what it does there.
  if (event.key === "Enter" && (tag === "BUTTON" || tag === "SUMMARY")) return;
  const moves = {
    ArrowDown: () => choose(chosen + 1), ArrowUp: () => choose(chosen - 1), Enter: () => step(chosen),
    ArrowLeft: () => move(shown.at - 1), Backspace: () => move(shown.at - 1), ArrowRight: () => move(shown.at + 1),
    Home: () => move(0), End: () => move(shown.length), l: copy,
  };
  const act = /^[1-9]$/.test(event.key) ? () => step(Number(event.key) - 1) : moves[event.key];
  if (act) {
    event.preventDefault();
    act();
  }
}

async function start() {
  try {
    known = await answer(await fetch("/api/systems"));
  } catch (error) {
    notice(gone(error));
    return;
  }
  at("name").textContent = known.name;
  at("system").replaceChildren(...known.systems.map((s) => el("option", { value: s.name }, s.title ? `${s.name}: ${s.title}` : s.name)));
  at("chooser").hidden = known.systems.length < 2;
  at("system").onchange = (event) => { link = begin(event.target.value); notice(""); go({}); };
  at("first").onclick = () => move(0);
  at("back").onclick = () => move(shown.at - 1);
  at("forward").onclick = () => move(shown.at + 1);
  at("last").onclick = () => move(shown.length);
  at("slider").onchange = (event) => move(Number(event.target.value));
  at("copy").onclick = copy;
  at("ask").onclick = help;
  at("filter").oninput = () => shown && shown.next && outcomes(FEW);
  at("control").ontoggle = control;
  const file = (ending) => `${link.system.replace(/[^A-Za-z0-9_-]+/g, "-")}.${ending}`;
  at("save-svg").onclick = () => save("/api/diagram", file("svg"));
  at("save-recording").onclick = () => save("/api/recording", file("ndjson"));
  addEventListener("hashchange", load);
  addEventListener("keydown", key);
  await load();
}
start();
