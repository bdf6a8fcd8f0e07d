// parameters.js - a control for each parameter that the oracle offers.
//
// What is known besides the defaults is `value` of a parameter, undefined while it is the default.
// SPDX-License-Identifier: MIT

const parameters = oracle.parameters.map(p => {
  const type = types.get(p.type);
  return {
    name: p.name,
    doc: p.doc,
    unit: type.unit,
    whole: type.base === "integer",
    fixed: p.fixed === true,
    preset: p.default === null ? Infinity : Number(p.default),
    low: p.low === null ? -Infinity : p.low,
    high: p.high === null ? Infinity : p.high,
    value: undefined,
    wrong: "",
    show: () => {},
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
  if (!Number.isFinite(value) && /\d/.test(text))
    return `${text} is too large to be a number here; inf is one`;
  if (value < p.low || value > p.high) return `${p.name} takes ${rangeOf(p)}`;
  if (p.whole && !Number.isInteger(value)) return `${p.name} takes ${rangeOf(p)}`;
  return "";
}

function rangeOf(p) {
  const numbers = `${written(p.low)} to ${written(p.high)}`;
  return (p.whole ? "whole numbers from " : "") + numbers + (p.unit ? " " + p.unit : "");
}

const FEW = 12; // so many whole numbers make a list
const DECADES = 3; // so far a slider goes to either side of a default, where its range has no ends
const STEPS = 20; // of a slider, to a decade; 200 of an even one

// Which control fits: {kind: "check" | "list" | "number"}; of a number with the slider's low, high
// and whether it goes by logarithms, where one fits.
function fit(p) {
  const width = p.high - p.low;
  if (p.whole && p.low === 0 && p.high === 1) return {kind: "check"};
  if (p.whole && width < FEW) return {kind: "list"};
  const ends = {kind: "number", log: false, low: p.low, high: p.high};
  const positive = p.preset > 0 && Number.isFinite(p.preset);
  if (positive && p.low >= 0 && (p.low > 0 ? p.high / p.low >= 100 : p.preset < p.high / 50)) {
    ends.log = true;
    if (p.low === 0 || p.high === Infinity) {
      ends.low = Math.max(p.low, p.preset / 10 ** DECADES, p.whole ? 1 : 0);
      ends.high = Math.min(p.high, p.preset * 10 ** DECADES);
    }
    return ends;
  }
  return Number.isFinite(width) && width > 0 ? ends : {kind: "number"};
}

// A slider whose positions are logarithms, or values. Returns [element, show(value)].
function slider(p, way, change) {
  const place = way.log ? Math.log10 : x => x;
  const step = way.log ? 1 / STEPS : p.whole ? 1 : (way.high - way.low) / (10 * STEPS);
  const first = place(way.low),
    last = place(way.high),
    preset = Math.min(Math.max(place(p.preset), first), last);
  // Whole steps from the default, so that one of them is it.
  const count = Math.floor((last - preset) / step + 1e-9),
    below = Math.floor((preset - first) / step + 1e-9);
  const element = make("input", {
    type: "range",
    min: -below,
    max: count,
    step: 1,
    "aria-label": `${p.name}, slider`,
  });
  element.addEventListener("input", () => {
    const i = Number(element.value),
      x = preset + i * step;
    const value = i === 0 ? p.preset : Number((way.log ? 10 ** x : x).toPrecision(way.log ? 2 : 6));
    change(Math.min(Math.max(p.whole ? Math.round(value) : value, p.low), p.high));
  });
  return [
    element,
    value => {
      const i = value > 0 || !way.log ? Math.round((place(value) - preset) / step) : -below;
      element.value = Math.min(Math.max(i, -below), count);
      element.setAttribute("aria-valuetext", `${written(value)}${p.unit ? " " + p.unit : ""}`);
    },
  ];
}

// Does an argument's expression read the parameter?
const reads = (e, p) => e.parameter === p.name || (e.operands || []).some(part => reads(part, p));

function control(p) {
  const way = fit(p),
    id = `p-${p.name}`,
    item = make("li"),
    row = make("div", {className: "control"});
  const wrong = make("p", {className: "wrong", id: `${id}-wrong`, "aria-live": "polite"});
  const reset = make("button", {type: "button", "aria-label": `reset ${p.name}`}, "reset");
  const change = value => {
    p.value = value === p.preset ? undefined : value;
    p.wrong = "";
    p.show();
    result();
  };
  const about = `${id}-doc ${id}-range ${id}-wrong`;
  let box,
    showSlider = () => {};
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
    box = make("input", {
      type: "text",
      id,
      spellcheck: false,
      autocomplete: "off",
      "aria-describedby": about,
    });
    if (p.whole) box.inputMode = "numeric";
    box.addEventListener("input", () => {
      const text = box.value.trim(),
        cause = fault(p, text);
      if (cause) {
        // not the number that was there before the last letter
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
  reset.addEventListener("click", () => {
    p.value = undefined;
    p.wrong = "";
    p.show();
    result();
    box.focus();
  });
  p.show = () => {
    const value = p.value === undefined ? p.preset : p.value;
    if (way.kind === "check") box.checked = value === 1;
    else if (way.kind === "list") box.value = String(value);
    else if (document.activeElement !== box || number(box.value.trim()) !== value)
      box.value = written(value);
    showSlider(value);
    box.removeAttribute("aria-invalid");
    wrong.textContent = "";
    reset.disabled = p.value === undefined;
    item.classList.toggle("changed", p.value !== undefined);
  };
  const users = oracle.nodes.filter(n => n.arguments.some(a => reads(a.value, p))).map(n => n.name);
  item.addEventListener("focusin", () => mark(users));
  item.addEventListener("focusout", () => mark([]));
  item.append(
    make("label", {for: id}, p.name),
    make("p", {id: `${id}-doc`}, ...prose(p.doc)),
    row,
    make(
      "p",
      {id: `${id}-range`, className: "range"},
      `${rangeOf(p)}; default ${written(p.preset)}`,
    ),
    wrong,
  );
  return item;
}
