// result.js - what comes of the controls: the command line and the parameter file, out and back.
// SPDX-License-Identifier: MIT

const changed = () => offered.filter(p => p.value !== undefined);
const quoted = word =>
  /^[A-Za-z0-9_.,:=+\/@%-]+$/.test(word) ? word : `'${word.replace(/'/g, "'\\''")}'`;

function command() {
  const words = ["radiosity", "solve", at("scene").value || "scene.obj", "--oracle", data.given];
  for (const p of changed()) words.push("--set", `${p.name}=${written(p.value)}`);
  return words.map(quoted).join(" ");
}

function file() {
  return (
    `oracle ${oracle.name}\n` +
    changed()
      .map(p => `${p.name} = ${written(p.value)}\n`)
      .join("")
  );
}

function say(text) {
  at("said").textContent = text;
}

function result() {
  const line = command(),
    wrong = offered.filter(p => p.wrong);
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
    if (!document.execCommand("copy"))
      return say("selected; copy it with the browser's own command");
  }
  say("copied");
}

function save() {
  const name = `${oracle.name}.params`,
    url = URL.createObjectURL(new Blob([file()], {type: "text/plain"}));
  make("a", {href: url, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
  const words = ["radiosity", "solve", at("scene").value, "--oracle", data.given, "--params", name];
  say(`saved; use it with: ${words.map(quoted).join(" ")}`);
}

// As solver/util/parameter_file.c reads it. Returns the values by name, or throws what is wrong, a
// line each.
function read(text) {
  const values = new Map(),
    lines = new Map(),
    wrong = [];
  let named = false;
  text.split("\n").forEach((whole, i) => {
    const line = whole.replace(/#.*/s, "").trim(),
      refuse = cause => wrong.push(`line ${i + 1}: ${cause}`);
    if (!line) return;
    if (!named) {
      const [word, name, more] = line.split(/\s+/);
      named = true;
      if (word !== "oracle" || !name || more || name.includes("="))
        refuse(`the first line says whose parameters these are; write oracle ${oracle.name}`);
      else if (name !== oracle.name)
        refuse(`these are parameters of oracle ${name}, not of ${oracle.name}`);
      return;
    }
    const equals = line.indexOf("="),
      name = line.slice(0, Math.max(equals, 0)).trim(),
      value = line.slice(equals + 1).trim();
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
