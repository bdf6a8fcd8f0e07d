// graph.js - the drawing's nodes, chosen by a click or by keys, and what is told of them; then the
// page begins.
// SPDX-License-Identifier: MIT

const drawing = at("drawing"),
  svg = drawing.querySelector("svg");
const order = [...nodes.keys()];
const drawn = new Map([...drawing.querySelectorAll("[data-node]")].map(g => [g.dataset.node, g]));
let here = 0,
  scale = 0;

function mark(names) {
  for (const [name, g] of drawn) g.classList.toggle("uses", names.includes(name));
}

// Only one node is a stop of the tab key; arrow keys go from it to others.
function go(i, focus) {
  const g = drawn.get(order[i]);
  if (!g) return;
  drawn.get(order[here])?.setAttribute("tabindex", "-1");
  here = i;
  g.setAttribute("tabindex", "0");
  if (focus) {
    g.focus();
    g.scrollIntoView({block: "nearest", inline: "nearest"});
  }
}

const SIGNS = {add: [" + ", 1], subtract: [" − ", 1], multiply: [" × ", 2], divide: [" / ", 2]};
// An expression as it was written, in parentheses where it binds less than what is around it.
function formula(e, around = 0) {
  if (e.number !== undefined) return typeof e.number === "number" ? written(e.number) : e.number;
  if (e.operator === undefined)
    return (
      e.parameter || e.fact || (e.term ? e.term + (e.level ? "." + e.level : "") : e.extern + "()")
    );
  if (e.operator === "negate") return "−" + formula(e.operands[0], 3);
  if (!SIGNS[e.operator])
    return `${e.operator}(${e.operands.map(part => formula(part)).join(", ")})`;
  const [sign, binds] = SIGNS[e.operator],
    text = formula(e.operands[0], binds) + sign + formula(e.operands[1], binds + 0.5);
  return binds < around ? `(${text})` : text;
}

function link(text, act) {
  const button = make("button", {type: "button", className: "link"}, text);
  button.addEventListener("click", act);
  return button;
}

function pair(list, name, ...value) {
  if (value.length && value[0] !== "") list.append(make("dt", {}, name), make("dd", {}, ...value));
}

const needs = list => list.map(n => n.term + (n.level ? "." + n.level : "")).join(", ");
const count = n => n.toLocaleString("en");
const short = n => Number(n.toPrecision(3));
const percent = (part, whole) => (whole ? `${short((100 * part) / whole)} %` : "");

function seconds(t) {
  const [size, unit] = [
    [1, "s"],
    [1e-3, "ms"],
    [1e-6, "µs"],
    [1e-9, "ns"],
  ].find(([least]) => t >= least) || [1e-9, "ns"];
  return t ? `${short(t / size)} ${unit}` : "0 s";
}

// What a solve has counted of a node.
function tellNode(list, n) {
  pair(list, "calls", count(n.calls));
  if (!n.calls) return;
  pair(list, "of discussions", percent(n.share, 1));
  const share = percent(n.seconds_share, 1);
  if (n.timed)
    pair(list, "time", `${seconds(n.seconds)}, ${share} of all; ${seconds(n.mean_seconds)} a call`);
  pair(list, "rays", n.rays ? `${count(n.rays)}, ${short(n.rays / n.calls)} a call` : "");
  pair(
    list,
    "terms made",
    Object.entries(n.terms)
      .map(([name, times]) => `${name} ${count(times)}`)
      .join(", "),
  );
}

function choose(name, focus) {
  const node = nodes.get(name),
    tool = tools.get(node.tool),
    found = counted.get(name),
    list = make("dl");
  const table = make("table"),
    head = make(
      "tr",
      {},
      make("th", {scope: "col"}, "answer"),
      make("th", {scope: "col"}, "kind"),
      make("th", {scope: "col"}, "leads to"),
    );
  go(order.indexOf(name), focus);
  for (const [other, g] of drawn) g.classList.toggle("chosen", other === name);
  for (const argument of node.arguments) {
    const used = offered.filter(p => reads(argument.value, p));
    pair(
      list,
      argument.name,
      make("code", {}, formula(argument.value)),
      ...used.flatMap(p => [" ", link(`set ${p.name}`, () => at(`p-${p.name}`).focus())]),
    );
  }
  pair(list, "reads", needs(tool.reads));
  pair(list, "writes", needs(tool.writes));
  if (found) {
    tellNode(list, found);
    head.append(
      make("th", {scope: "col", className: "number"}, "times"),
      make("th", {scope: "col", className: "number"}, "share"),
    );
  }
  table.append(make("thead", {}, head));
  const body = make("tbody");
  for (const arc of node.arcs) {
    const row = make(
      "tr",
      {},
      make("td", {}, arc.answer),
      make("td", {}, arc.kind),
      make(
        "td",
        {},
        arc.node
          ? link(arc.node, () => choose(arc.node, true))
          : make("span", {title: decisions.get(arc.decision).doc}, arc.decision),
      ),
    );
    const answer = found?.answers.find(a => a.answer === arc.answer);
    if (found)
      row.append(
        make("td", {className: "number"}, answer ? count(answer.count) : ""),
        make("td", {className: "number"}, answer ? percent(answer.count, found.calls) : ""),
      );
    body.append(row);
  }
  table.append(body);
  at("node").replaceChildren(
    make("h3", {}, name),
    make("p", {}, make("code", {}, node.tool), ` (${tool.kind}): `, ...prose(tool.doc)),
    list,
    make("div", {className: "table"}, table),
  );
  at("node").firstChild.scrollIntoView({block: "nearest"});
}

function zoom(to) {
  if (!svg) return;
  scale = to;
  const width = svg.viewBox.baseVal.width || 400;
  svg.style.width = scale ? `${width * scale}px` : "100%";
  svg.style.maxWidth = scale ? "none" : `${width * 1.34}px`;
  svg.style.height = "auto";
}
const grown = factor =>
  zoom(Math.min(Math.max((scale || svg.clientWidth / svg.viewBox.baseVal.width) * factor, 0.1), 8));

function keys(event) {
  const last = order.length - 1;
  const to = {
    ArrowDown: here + 1,
    ArrowRight: here + 1,
    ArrowUp: here - 1,
    ArrowLeft: here - 1,
    Home: 0,
    End: last,
  }[event.key];
  if (event.key === "Enter" || event.key === " ") choose(order[here], true);
  else if (to === undefined) return;
  else go(Math.min(Math.max(to, 0), last), true);
  event.preventDefault();
}

// What the statistics are of.
function tellCounted() {
  const s = data.statistics,
    unused = [...drawn.keys()].filter(name => counted.has(name) && !counted.get(name).calls);
  const used = new Map(Object.entries(s.parameters ?? {})); // infinite ones are no numbers in JSON
  const set = offered.filter(
    p => Number.isFinite(used.get(p.name)) && used.get(p.name) !== p.preset,
  );
  const values = set.map(p => `${p.name} = ${written(used.get(p.name))}`).join(", ");
  at("counted").hidden = false;
  at("counted").append(
    `Counted in a solve of ${s.scene}${values ? ` with ${values}` : ""}: ` +
      `${count(s.discussions)} discussions, ` +
      `${count(s.rays)} rays, ${seconds(s.seconds)} in the nodes.`,
    unused.length ? ` Never asked: ${unused.join(", ")}.` : "",
  );
}

// ---- begin

at("doc").append(...prose(oracle.doc));
at("offered").append(...offered.map(control));
if (!offered.length) at("offered").append(make("li", {}, "This oracle offers none."));
for (const p of parameters.filter(q => q.fixed)) {
  at("author").hidden = false;
  pair(
    at("fixed"),
    p.name,
    `${written(p.preset)}${p.unit ? " " + p.unit : ""}`,
    make("p", {}, ...prose(p.doc)),
  );
}
order.forEach((name, i) => {
  const g = drawn.get(name),
    n = counted.get(name);
  if (!g) return;
  g.setAttribute("tabindex", i ? "-1" : "0");
  g.setAttribute("role", "button");
  g.setAttribute(
    "aria-label",
    `${name}: ${nodes.get(name).tool}${n ? `, asked ${n.calls} times` : ""}`,
  );
  g.addEventListener("click", () => choose(name, true));
  g.addEventListener("keydown", keys);
});
if (data.statistics) tellCounted();
svg?.setAttribute("role", "group"); // not one picture: its nodes are buttons
at("smaller").addEventListener("click", () => grown(1 / 1.3));
at("larger").addEventListener("click", () => grown(1.3));
at("fit").addEventListener("click", () => zoom(0));
at("reset-all").addEventListener("click", () => take(new Map()));
at("scene").addEventListener("input", result);
at("copy").addEventListener("click", copy);
at("save").addEventListener("click", save);
at("load").addEventListener("change", load);
// All of it, unless that would be too small to read.
zoom(svg && svg.viewBox.baseVal.width > drawing.clientWidth * 1.5 ? 1 : 0);
const start = drawn.get(oracle.start)?.getBoundingClientRect(),
  frame = drawing.getBoundingClientRect();
if (start) drawing.scrollLeft += start.left + start.width / 2 - frame.left - frame.width / 2;
take(new Map());
