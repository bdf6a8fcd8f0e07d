// panel.js - the script of the page that `radiosity panel` makes.
//
// The page holds one graph (JSON of dagc, schema dagc/1), perhaps what a solve has counted in it, and the drawing. Values that
// differ from the defaults are all that it knows besides; the command line and the parameter file are made from them. Names and
// texts of the oracle become text nodes, never markup.
// SPDX-License-Identifier: MIT
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const catalog = data.graph.catalog;
  const oracle = data.graph.oracles.find(o => o.name === data.oracle);
  const byName = list => new Map(list.map(item => [item.name, item]));
  const types = byName(catalog.types), tools = byName(catalog.tools), decisions = byName(catalog.decisions);
  const nodes = byName(oracle.nodes);
  const counted = new Map((data.statistics ? data.statistics.nodes : []).map(n => [n.node, n]));
  const at = id => document.getElementById(id);

  // An element with properties, attributes (as they contain a "-") and children.
  function make(name, properties = {}, ...children) {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(properties))
      if (key.includes("-") || key === "for" || key === "role") element.setAttribute(key, value);
      else element[key] = value;
    element.append(...children);
    return element;
  }

  // Text in which `names` are names.
  function prose(text) {
    return text.split("`").map((part, i) => (i % 2 ? make("code", {}, part) : part));
  }

  // ---- numbers, as the command line takes them

  function written(value) {
    if (!Number.isFinite(value)) return value < 0 ? "-inf" : "inf";
    const size = Math.abs(value);
    return value !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential().replace("e+", "e") : String(value);
  }

  function number(text) {
    if (/^[+-]?inf(inity)?$/i.test(text)) return text[0] === "-" ? -Infinity : Infinity;
    return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(text) ? Number(text) : NaN;
  }

  // ---- parameters

  const parameters = oracle.parameters.map(p => {
    const type = types.get(p.type);
    return {
      name: p.name, doc: p.doc, unit: type.unit, whole: type.base === "integer", fixed: p.fixed === true,
      preset: p.default === null ? Infinity : Number(p.default),
      low: p.low === null ? -Infinity : p.low, high: p.high === null ? Infinity : p.high,
      value: undefined, wrong: "", show: () => {}
    };
  });
  const offered = parameters.filter(p => !p.fixed);
  const find = name => parameters.find(p => p.name === name);

  // What is wrong with a text as a parameter's value, "" when nothing is.
  function fault(p, text) {
    const value = number(text);
    if (text === "") return `${p.name} has no value; write a number`;
    if (/^[+-]?\d+,\d+$/.test(text)) return `'${text}' is not a number; write a point, not a comma`;
    if (Number.isNaN(value)) return `'${text}' is not a number; write one such as 0.05, 2e-5 or inf`;
    if (!Number.isFinite(value) && /\d/.test(text)) return `${text} is too large to be a number here; inf is one`;
    if (value < p.low || value > p.high) return `${p.name} takes ${rangeOf(p)}`;
    if (p.whole && !Number.isInteger(value)) return `${p.name} takes ${rangeOf(p)}`;
    return "";
  }

  function rangeOf(p) {
    return `${p.whole ? "whole numbers from " : ""}${written(p.low)} to ${written(p.high)}${p.unit ? " " + p.unit : ""}`;
  }

  const FEW = 12;       // so many whole numbers make a list
  const DECADES = 3;    // a slider goes so far to either side of a default, where the range has no end of its own
  const STEPS = 20;     // of a slider, to a decade; 200 of an even one

  // Which control fits: {kind: "check" | "list" | "number"}, of a number with the slider's {low, high, log}.
  function fit(p) {
    const width = p.high - p.low;
    if (p.whole && p.low === 0 && p.high === 1) return {kind: "check"};
    if (p.whole && width < FEW) return {kind: "list"};
    const far = 10 ** DECADES, positive = p.preset > 0 && Number.isFinite(p.preset);
    const log = positive && p.low >= 0 && (p.low > 0 ? p.high / p.low >= 100 : p.preset < p.high / 50);
    if (log)
      return {kind: "number", log, low: p.low > 0 && Number.isFinite(p.high) ? p.low : Math.max(p.low, p.preset / far, p.whole ? 1 : 0),
              high: p.low > 0 && Number.isFinite(p.high) ? p.high : Math.min(p.high, p.preset * far)};
    return Number.isFinite(width) && width > 0 ? {kind: "number", log, low: p.low, high: p.high} : {kind: "number"};
  }

  // A slider whose positions are logarithms, or values. Returns [element, show(value)].
  function slider(p, way, change) {
    const place = way.log ? Math.log10 : x => x;
    const step = way.log ? 1 / STEPS : p.whole ? 1 : (way.high - way.low) / (10 * STEPS);
    const first = place(way.low), last = place(way.high), preset = Math.min(Math.max(place(p.preset), first), last);
    // Whole steps from the default, so that one of them is it.
    const count = Math.floor((last - preset) / step + 1e-9), below = Math.floor((preset - first) / step + 1e-9);
    const element = make("input", {type: "range", min: -below, max: count, step: 1, "aria-label": `${p.name}, slider`});
    element.addEventListener("input", () => {
      const i = Number(element.value), x = preset + i * step;
      const value = i === 0 ? p.preset : Number((way.log ? 10 ** x : x).toPrecision(way.log ? 2 : 6));
      change(Math.min(Math.max(p.whole ? Math.round(value) : value, p.low), p.high));
    });
    return [element, value => {
      element.value = value > 0 || !way.log ? Math.round((place(value) - preset) / step) : -below;
      element.setAttribute("aria-valuetext", `${written(value)}${p.unit ? " " + p.unit : ""}`);
    }];
  }

  // Does an argument's expression read the parameter?
  const reads = (e, p) => e.parameter === p.name || (e.operands || []).some(part => reads(part, p));

  function control(p) {
    const way = fit(p), id = `p-${p.name}`, item = make("li"), row = make("div", {className: "control"});
    const wrong = make("p", {className: "wrong", id: `${id}-wrong`, "aria-live": "polite"});
    const reset = make("button", {type: "button", "aria-label": `reset ${p.name}`}, "reset");
    const change = value => { p.value = value === p.preset ? undefined : value; p.wrong = ""; p.show(); result(); };
    const about = `${id}-doc ${id}-range ${id}-wrong`;
    let box, showSlider = () => {};
    if (way.kind === "check") {
      box = make("input", {type: "checkbox", id, "aria-describedby": about});
      box.addEventListener("change", () => change(box.checked ? 1 : 0));
    } else if (way.kind === "list") {
      box = make("select", {id, "aria-describedby": about});
      for (let v = p.low; v <= p.high; v++) box.append(make("option", {value: v}, String(v)));
      box.addEventListener("change", () => change(Number(box.value)));
    } else {
      if (way.low !== undefined) {
        const [element, show] = slider(p, way, change);
        showSlider = show;
        row.append(element);
      }
      box = make("input", {type: "text", id, spellcheck: false, autocomplete: "off", "aria-describedby": about});
      if (p.whole) box.inputMode = "numeric";
      box.addEventListener("input", () => {
        const text = box.value.trim(), cause = fault(p, text);
        if (cause) { // not the number that was there before the last letter
          p.value = undefined;
          p.wrong = cause;
          wrong.textContent = cause;
          box.setAttribute("aria-invalid", "true");
          reset.disabled = false;
          item.classList.remove("changed");
          result();
        } else change(number(text));
      });
    }
    row.append(box);
    if (p.unit) row.append(p.unit);
    row.append(reset);
    reset.addEventListener("click", () => { p.value = undefined; p.wrong = ""; p.show(); result(); box.focus(); });
    p.show = () => {
      const value = p.value === undefined ? p.preset : p.value;
      if (way.kind === "check") box.checked = value === 1;
      else if (way.kind === "list") box.value = String(value);
      else if (document.activeElement !== box || number(box.value.trim()) !== value) box.value = written(value);
      showSlider(value);
      box.removeAttribute("aria-invalid");
      wrong.textContent = "";
      reset.disabled = p.value === undefined;
      item.classList.toggle("changed", p.value !== undefined);
    };
    const users = oracle.nodes.filter(n => n.arguments.some(a => reads(a.value, p))).map(n => n.name);
    item.addEventListener("focusin", () => mark(users));
    item.addEventListener("focusout", () => mark([]));
    item.append(make("label", {for: id}, p.name),
                make("p", {id: `${id}-doc`}, ...prose(p.doc)), row,
                make("p", {id: `${id}-range`, className: "range"}, `${rangeOf(p)}; default ${written(p.preset)}`), wrong);
    return item;
  }

  // ---- what comes of it

  const changed = () => offered.filter(p => p.value !== undefined);
  const quoted = word => (/^[A-Za-z0-9_.,:=+\/@%-]+$/.test(word) ? word : `'${word.replace(/'/g, "'\\''")}'`);

  function command() {
    const words = ["radiosity", "solve", at("scene").value || "scene.obj", "--oracle", data.given];
    for (const p of changed()) words.push("--set", `${p.name}=${written(p.value)}`);
    return words.map(quoted).join(" ");
  }

  function file() {
    return `oracle ${oracle.name}\n` + changed().map(p => `${p.name} = ${written(p.value)}\n`).join("");
  }

  function say(text) { at("said").textContent = text; }

  function result() {
    const line = command(), wrong = offered.filter(p => p.wrong);
    if (at("command").textContent !== line) at("command").textContent = line;
    at("reset-all").disabled = !changed().length && !wrong.length;
    say(wrong.length ? `not taken: ${wrong.map(p => p.name).join(", ")}` : "");
  }

  async function copy() {
    try {
      await navigator.clipboard.writeText(command());
    } catch {
      // A page from a file may have no clipboard of its own: what is selected can be copied.
      getSelection().selectAllChildren(at("command"));
      if (!document.execCommand("copy")) return say("selected; copy it with the browser's own command");
    }
    say("copied");
  }

  function save() {
    const name = `${oracle.name}.params`, url = URL.createObjectURL(new Blob([file()], {type: "text/plain"}));
    make("a", {href: url, download: name}).click();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
    say(`saved; use it with: radiosity solve ${quoted(at("scene").value)} --oracle ${quoted(data.given)} --params ${name}`);
  }

  // As solver/util/parameter_file.c reads it. Returns the values by name, or throws what is wrong, a line each.
  function read(text) {
    const values = new Map(), lines = new Map(), wrong = [];
    let named = false;
    text.split("\n").forEach((whole, i) => {
      const line = whole.replace(/#.*/s, "").trim(), refuse = cause => wrong.push(`line ${i + 1}: ${cause}`);
      if (!line) return;
      if (!named) {
        const [word, name, more] = line.split(/\s+/);
        named = true;
        if (word !== "oracle" || !name || more || name.includes("=")) refuse(`the first line says whose parameters these are; write oracle ${oracle.name}`);
        else if (name !== oracle.name) refuse(`these are parameters of oracle ${name}, not of ${oracle.name}`);
        return;
      }
      const equals = line.indexOf("="), name = line.slice(0, Math.max(equals, 0)).trim(), value = line.slice(equals + 1).trim();
      const p = find(name);
      if (!name) refuse(`'${line}' sets nothing; write NAME = VALUE`);
      else if (!p) refuse(`oracle ${oracle.name} has no parameter ${name}`);
      else if (p.fixed) refuse(`${name} is fixed by the author, at ${written(p.preset)}`);
      else if (lines.has(name)) refuse(`${name} is set twice, first in line ${lines.get(name)}`);
      else if (fault(p, value)) refuse(fault(p, value));
      lines.set(name, i + 1);
      values.set(name, number(value));
    });
    if (!named) wrong.push(`no line says whose parameters these are; write oracle ${oracle.name}`);
    if (wrong.length) throw new Error(wrong.join("\n"));
    return values;
  }

  function take(values) {
    for (const p of offered) {
      const value = values.get(p.name);
      p.value = value === undefined || value === p.preset ? undefined : value;
      p.wrong = "";
      p.show();
    }
    result();
  }

  async function load() {
    const from = at("load").files[0];
    if (!from) return;
    try {
      const values = read(await from.text());
      take(values);
      say(`${from.name}: ${values.size} value${values.size === 1 ? "" : "s"} taken`);
    } catch (error) {
      say(`${from.name} is not taken.\n${error.message}`);
    }
    at("load").value = ""; // so that the same file can be chosen again
  }

  // ---- the graph

  const drawing = at("drawing"), svg = drawing.querySelector("svg");
  const order = [...nodes.keys()];
  const drawn = new Map([...drawing.querySelectorAll("[data-node]")].map(g => [g.dataset.node, g]));
  let here = 0, scale = 0;

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
  // An expression as it was written, in no more parentheses than it needs where what binds tighter than `around` stands.
  function formula(e, around = 0) {
    if (e.number !== undefined) return typeof e.number === "number" ? written(e.number) : e.number;
    if (e.operator === undefined) return e.parameter || e.fact || (e.term ? e.term + (e.level ? "." + e.level : "") : e.extern + "()");
    if (e.operator === "negate") return "−" + formula(e.operands[0], 3);
    if (!SIGNS[e.operator]) return `${e.operator}(${e.operands.map(part => formula(part)).join(", ")})`;
    const [sign, binds] = SIGNS[e.operator], text = formula(e.operands[0], binds) + sign + formula(e.operands[1], binds + 0.5);
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
  const percent = (part, whole) => (whole ? `${(100 * part / whole).toPrecision(3)} %` : "");

  const count = n => n.toLocaleString("en");

  function seconds(t) {
    const [size, unit] = [[1, "s"], [1e-3, "ms"], [1e-6, "µs"], [1e-9, "ns"]].find(([least]) => t >= least) || [1e-9, "ns"];
    return t ? `${Number((t / size).toPrecision(3))} ${unit}` : "0 s";
  }

  // What a solve has counted of a node.
  function tellNode(list, n) {
    pair(list, "calls", count(n.calls));
    if (!n.calls) return;
    pair(list, "of discussions", percent(n.share, 1));
    if (n.timed) pair(list, "time", `${seconds(n.seconds)}, ${percent(n.seconds_share, 1)} of all; ${seconds(n.mean_seconds)} a call`);
    pair(list, "rays", n.rays ? `${count(n.rays)}, ${Number((n.rays / n.calls).toPrecision(3))} a call` : "");
    pair(list, "terms made", Object.entries(n.terms).map(([name, times]) => `${name} ${count(times)}`).join(", "));
  }

  function choose(name, focus) {
    const node = nodes.get(name), tool = tools.get(node.tool), found = counted.get(name), list = make("dl");
    const table = make("table"), head = make("tr", {}, make("th", {scope: "col"}, "answer"), make("th", {scope: "col"}, "kind"), make("th", {scope: "col"}, "leads to"));
    go(order.indexOf(name), focus);
    for (const [other, g] of drawn) g.classList.toggle("chosen", other === name);
    for (const argument of node.arguments) {
      const used = offered.filter(p => reads(argument.value, p));
      pair(list, argument.name, make("code", {}, formula(argument.value)),
           ...used.flatMap(p => [" ", link(`set ${p.name}`, () => at(`p-${p.name}`).focus())]));
    }
    pair(list, "reads", needs(tool.reads));
    pair(list, "writes", needs(tool.writes));
    if (found) {
      tellNode(list, found);
      head.append(make("th", {scope: "col", className: "number"}, "times"), make("th", {scope: "col", className: "number"}, "share"));
    }
    table.append(make("thead", {}, head));
    const body = make("tbody");
    for (const arc of node.arcs) {
      const row = make("tr", {}, make("td", {}, arc.answer), make("td", {}, arc.kind),
                       make("td", {}, arc.node ? link(arc.node, () => choose(arc.node, true)) : make("span", {title: decisions.get(arc.decision).doc}, arc.decision)));
      const answer = found?.answers.find(a => a.answer === arc.answer);
      if (found)
        row.append(make("td", {className: "number"}, answer ? count(answer.count) : ""),
                   make("td", {className: "number"}, answer ? percent(answer.count, found.calls) : ""));
      body.append(row);
    }
    table.append(body);
    at("node").replaceChildren(make("h3", {}, name),
      make("p", {}, make("code", {}, node.tool), ` (${tool.kind}): `, ...prose(tool.doc)), list, make("div", {className: "table"}, table));
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
  const grown = factor => zoom(Math.min(Math.max((scale || svg.clientWidth / svg.viewBox.baseVal.width) * factor, 0.1), 8));

  function keys(event) {
    const last = order.length - 1;
    const to = {ArrowDown: here + 1, ArrowRight: here + 1, ArrowUp: here - 1, ArrowLeft: here - 1, Home: 0, End: last}[event.key];
    if (event.key === "Enter" || event.key === " ") choose(order[here], true);
    else if (to === undefined) return;
    else go(Math.min(Math.max(to, 0), last), true);
    event.preventDefault();
  }

  // What the statistics are of.
  function tellCounted() {
    const s = data.statistics, unused = [...drawn.keys()].filter(name => counted.has(name) && !counted.get(name).calls);
    at("counted").hidden = false;
    at("counted").append(`Counted in a solve of ${s.scene}: ${count(s.discussions)} discussions, ${count(s.rays)} rays, `
      + `${seconds(s.seconds)} in the nodes.`, unused.length ? ` Never asked: ${unused.join(", ")}.` : "");
  }

  // ---- begin

  at("doc").append(...prose(oracle.doc));
  at("offered").append(...offered.map(control));
  if (!offered.length) at("offered").append(make("li", {}, "This oracle offers none."));
  for (const p of parameters.filter(q => q.fixed)) {
    at("author").hidden = false;
    pair(at("fixed"), p.name, `${written(p.preset)}${p.unit ? " " + p.unit : ""}`, make("p", {}, ...prose(p.doc)));
  }
  order.forEach((name, i) => {
    const g = drawn.get(name), n = counted.get(name);
    if (!g) return;
    g.setAttribute("tabindex", i ? "-1" : "0");
    g.setAttribute("role", "button");
    g.setAttribute("aria-label", `${name}: ${nodes.get(name).tool}${n ? `, asked ${n.calls} times` : ""}`);
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
  zoom(svg && svg.viewBox.baseVal.width > drawing.clientWidth * 1.5 ? 1 : 0); // as large as can be read, else all of it
  const start = drawn.get(oracle.start)?.getBoundingClientRect(), frame = drawing.getBoundingClientRect();
  if (start) drawing.scrollLeft += start.left + start.width / 2 - frame.left - frame.width / 2;
  take(new Map());
})();
