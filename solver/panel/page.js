// page.js - what the parts of a panel's script share: the oracle, elements, numbers.
//
// The page holds one graph (JSON of dagc, schema dagc/1) and perhaps what a solve has counted in
// it. Names and texts of the oracle become text nodes, never markup. page.js, parameters.js,
// result.js and graph.js stand in one script, in this order.
// SPDX-License-Identifier: MIT
"use strict";

const data = JSON.parse(document.getElementById("data").textContent);
const catalog = data.graph.catalog;
const oracle = data.graph.oracles.find(o => o.name === data.oracle);
const byName = list => new Map(list.map(item => [item.name, item]));
const types = byName(catalog.types),
  tools = byName(catalog.tools),
  decisions = byName(catalog.decisions);
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
  return value !== 0 && (size < 1e-3 || size >= 1e6)
    ? value.toExponential().replace("e+", "e")
    : String(value);
}

function number(text) {
  if (/^[+-]?inf(inity)?$/i.test(text)) return text[0] === "-" ? -Infinity : Infinity;
  return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(text) ? Number(text) : NaN;
}
