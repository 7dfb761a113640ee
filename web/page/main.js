// The page: asks the worker, and tells what it answers.

import { interval } from "./digits.js";
import { View } from "./view.js";
import bracket from "../../examples/models/bracket.obj";
import pin from "../../examples/models/pin.obj";
import pawn from "../../examples/models/pawn.obj";
import ring from "../../examples/models/ring.obj";
import star from "../../examples/models/star.obj";
import figure from "../../examples/models/figure.obj";

const $ = (id) => document.getElementById(id);
const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];
const tolerances = ["0.001", "0.002", "0.005", "0.01", "0.02", "0.05", "0.1", "0.2", "0.5", "1", "2", "5", "10"];
const many_parts = 8;
const usual_tolerance = tolerances.indexOf("0.1");
const schemes = ["auto", "loop", "catmark", "doo-sabin", "midedge", "bilinear", "flat"];
const examples = [
  { name: "Bracket and pin", parts: [["bracket.obj", bracket], ["pin.obj", pin]], rotate: [135, [0, 0, 1]], move: [0.05, 0.05, 0.5], view: [0.18, 0.22, 1] },
  { name: "Star and ring", parts: [["star.obj", star], ["ring.obj", ring]], rotate: [0, [0, 0, 1]], move: [6, 0, 0], view: [0.2, 0.4, 1] },
  { name: "Figure and pawn", parts: [["figure.obj", figure], ["pawn.obj", pawn]], rotate: [0, [0, 0, 1]], move: [3, 0, 0], view: [0.3, 0.25, 1] },
];

// The worker, asked by name; each question has one answer.

class Engine {
  constructor(source) {
    this.worker = new Worker(URL.createObjectURL(new Blob([source], { type: "text/javascript" })));
    this.next = 0;
    this.open = new Map();
    this.worker.onmessage = ({ data }) => {
      const { resolve, reject } = this.open.get(data.id);
      this.open.delete(data.id);
      if (data.fault === undefined) resolve(data.result);
      else reject(Object.assign(new Error(data.fault), { broken: data.broken }));
    };
    this.worker.onerror = (event) => tell(`snug stopped: ${event.message || "the worker could not be started"}`);
  }
  ask(op, rest = {}, transfer = []) {
    const id = this.next++;
    return new Promise((resolve, reject) => {
      this.open.set(id, { resolve, reject });
      this.worker.postMessage({ id, op, ...rest }, transfer);
    });
  }
}

const bytesOf = (base64) => {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
};

// What there is.

const state = {
  // {name, bytes, scheme, path, options, pose, home, size, source, info}. Of a scene's part: `path` is its file and `options`
  // are those that the command needs to read it so. Parts with one `source` have the same surface.
  parts: [],
  pair: [0, 1],
  moves: 1,
  answer: null,
  file: null, // the answer that came with the page
};
let engine;
let view = null;

const moving = () => state.parts[state.pair[state.moves]];
const largest = () => Math.max(...state.pair.map((p) => state.parts[p]?.size ?? 0));
const percent = () => tolerances[$("tolerance").value];
// As the command does it, so that both ask with the same double.
const tolerance = () => (Number(percent()) / 100) * largest();

function tell(message) {
  $("fault").querySelector("span").textContent = message;
  $("fault").hidden = false;
}
const silence = () => ($("fault").hidden = true);

// Asking: one question at a time, and the latest place after it.

let asking = false;
let again = false;
const answered = [];

async function ask() {
  if (state.parts.length < 2 || state.parts.some((p) => !p.info)) return;
  if (asking) {
    again = true;
    return;
  }
  asking = true;
  do {
    again = false;
    const [a, b] = state.pair;
    const poses = [state.parts[a].pose, state.parts[b].pose];
    const question = { a, b, poseA: poses[0], poseB: poses[1], tolerance: tolerance(), solid: $("solid").checked };
    try {
      const answer = await engine.ask("ask", question);
      state.answer = { ...answer, question, percent: percent() };
      answered.push(answer.milliseconds);
      show(state.answer);
    } catch (error) {
      state.answer = null;
      if ($("solid").checked) $("solid").checked = false;
      else verdictWords("undecided", "No answer", error.message);
      tell(error.message);
    }
  } while (again);
  asking = false;
}

const words = {
  separated: "Separated",
  within: "Within tolerance",
  intersecting: "Intersecting",
  undecided: "Undecided",
};

function sentence({ collision, question }) {
  const [lower, upper] = interval(collision.distance);
  if (collision.verdict === "separated") return "Proved: the limit surfaces do not touch.";
  if (collision.verdict === "within") return `Proved: two points, one on each surface, are at most ${upper} apart.`;
  if (collision.verdict === "intersecting") {
    return collision.contained === null ? `Proved: the ${question.solid ? "solids" : "limit surfaces"} have a point in common.`
      : `Proved: a point of ${"AB"[collision.contained]} lies inside the solid ${"BA"[collision.contained]}.`;
  }
  return `The distance lies in [${lower}, ${upper ?? "?"}]; try a larger tolerance.`;
}

function verdictWords(verdict, title, text) {
  $("answer").dataset.verdict = verdict;
  if ($("verdict").textContent !== title) $("verdict").textContent = title;
  $("sentence").textContent = text;
}

const point_text = (p) => p.map((x) => String(x)).join("  ");
const looks = [
  { name: "surfaces and cages", on: ["show-surface", "show-cage"] },
  { name: "surfaces", on: ["show-surface"] },
  { name: "triangles", on: ["show-surface", "show-mesh"] },
  { name: "adaptive triangles", on: ["show-surface", "show-mesh", "adaptive"] },
  { name: "enclosures", on: ["show-surface", "show-enclosures"] },
  { name: "hulls", on: ["show-surface", "show-hulls"] },
];
const layer_names = ["show-surface", "show-cage", "show-mesh", "adaptive", "show-enclosures", "show-hulls"];

function look(index) {
  $("look").value = index;
  for (const id of layer_names) $(id).checked = looks[index].on.includes(id);
  visibility();
  showLayers();
}

function place_text(at, part) {
  if (!at) return "";
  const dual = ["doo-sabin", "midedge"].includes(part.info.scheme);
  return ` (${dual ? "vertex" : "face"} ${at.owner})`;
}

const inContact = ({ collision, distance }) => collision.verdict === "intersecting" || distance.distance[1] === 0;
// Whose witnesses are shown: the points behind a proof of contact are those of collide.
const seenAnswer = ({ collision, distance }) => (collision.verdict === "intersecting" && collision.witness ? collision : distance);

function show(answer) {
  const { collision, distance, milliseconds } = answer;
  verdictWords(collision.verdict, words[collision.verdict], sentence(answer));
  const [lower, upper] = interval(distance.distance);
  $("interval").textContent = inContact(answer) ? "0" : `${lower} to ${upper}`;
  $("exact").textContent = inContact(answer) ? "contact is proved" : `exactly ${distance.distance.join(" to ")}`;
  const { witness, witnessAt } = seenAnswer(answer);
  ["witness-a", "witness-b"].forEach((id, side) => {
    $(id).textContent = point_text(witness[side]) + place_text(witnessAt[side], state.parts[state.pair[side]]);
  });
  $("work").textContent = `${milliseconds.toFixed(1)} ms, ${collision.stats.boxTests + distance.stats.boxTests} pairs of boxes`;
  $("depth").hidden = !(answer.question.solid && collision.verdict === "intersecting");
  $("depth-text").textContent = $("proof-text").textContent = "";
  showCommands(answer);
  compareWithFile(answer);
  overlay();
  storyGoes(answer);
}

// Three steps for who opens the page without parts of their own.

const steps = [
  { title: "Cages lie", text: "The pin's tip is inside the bracket's cage, yet the surfaces do not touch: their distance is proved, and marked." },
  { title: "Now drag the pin", text: "Push it into the bracket. Each place is answered at once, and a verdict is never a guess." },
  { title: "Take the proof along", text: "Download it: snug-check verifies it, a program that shares no code with this one." },
];
let step = -1;

function tellStory(next) {
  step = next;
  $("story").hidden = step < 0 || step >= steps.length;
  if ($("story").hidden) return;
  $("story").classList.toggle("last", step + 1 === steps.length);
  $("story-title").textContent = steps[step].title;
  $("story-text").textContent = steps[step].text;
  $("story-next").textContent = step + 1 < steps.length ? "Next" : "Close";
  [...document.querySelectorAll(".steps i")].forEach((mark, i) => mark.classList.toggle("on", i <= step));
  if (step === 1) look(1);
}
// Who has dragged it there has done the second step.
const storyGoes = ({ collision }) => step === 1 && collision.verdict === "intersecting" && tellStory(2);

// The same questions to the command.

// For interactive shells, too, which expand `!` within double quotes.
const quoted = (word) => (/^[\w.+:%/-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
// A file whose name begins with `-` is neither an option nor standard input.
const fileWord = (part) => (part.path ?? part.name).replace(/^-/, "./-");

function commands({ question, percent }) {
  const [a, b] = state.pair.map((p) => state.parts[p]);
  const options = [];
  for (const [side, part] of [["a", a], ["b", b]]) {
    for (const [name, value] of Object.entries(part.options ?? {})) {
      if (name === "--scheme") part.scheme === "auto" && options.push(`--scheme-${side}`, value);
      else if (a.options?.[name] !== b.options?.[name] || (name === "--sharp" && $("sharp").checked)) return ["# These parts are read with options of their own, which only a scene file can give."];
      else if (side === "a") options.push(name, value);
    }
  }
  for (const [side, part, pose] of [["a", a, question.poseA], ["b", b, question.poseB]]) {
    if (part.scheme !== "auto") options.push(`--scheme-${side}`, part.scheme);
    if (pose.some((x, i) => x !== identity[i])) options.push(`--place-${side}`, pose.join(" "));
  }
  if ($("sharp").checked) options.push("--sharp", String(angle()));
  if (question.solid) options.push("--solid");
  const line = (command, how) => ["snug", command, fileWord(a), fileWord(b), ...options, how, `${percent}%`].map(quoted).join(" ");
  return [line("collide", "--tolerance"), line("distance", "--absolute")];
}

function showCommands(answer) {
  $("commands").textContent = commands(answer).join("\n\n");
}

// A file that proves the answer which is shown.
async function downloadProof() {
  if (!state.answer) return;
  const { question } = state.answer;
  try {
    const { text, missing } = await engine.ask("proof", { ...question, apart: !inContact(state.answer) });
    $("proof-text").textContent = missing && `${text ? "It does not prove" : "There is no proof of"} ${missing}.`;
    if (!text) return;
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type: "text/plain" }));
    link.download = "snug-proof.txt";
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  } catch (error) {
    tell(error.message);
  }
}

// An answer that `snug view --answer` put in: what it says, and whether this page finds the same.

function compareWithFile(answer) {
  const file = state.file;
  if (!file) return;
  const same_place = (pose, given) => pose.every((x, i) => x === (given ?? identity)[i]);
  const { poseA, poseB } = answer.question;
  const here = same_place(poseA, file.place_a) && same_place(poseB, file.place_b);
  const found = file.command === "distance" ? answer.distance : answer.collision;
  const upper = found.distance[1] === Infinity ? null : found.distance[1];
  const asked = file.tolerance ?? file.absolute;
  const comparable = here && (asked === undefined || asked === answer.question.tolerance);
  const same = found.distance[0] === file.distance[0] && upper === file.distance[1] && (file.verdict ?? found.verdict) === found.verdict;
  const says = `${file.verdict ? `${file.verdict}, ` : ""}distance ${file.distance[0]} to ${file.distance[1] ?? "?"}`;
  $("file-answer").textContent = `The file's answer (${file.command}): ${says}. ` +
    (!here ? "The parts have been moved since." : !comparable ? "It was asked with another tolerance." : same ? "This page finds the same, digit by digit." : "This page finds other digits: another version?");
  $("file-answer").hidden = false;
}

// The overlay: witnesses, the gap between them, and the parts' names.

function put(element, at) {
  element.toggleAttribute("hidden", !at);
  if (at) element.setAttribute("transform", `translate(${at[0]} ${at[1]})`);
}

function overlay() {
  if (!view) return;
  const witness = state.answer && seenAnswer(state.answer).witness;
  const [a, b] = witness ? witness.map((p) => view.seen(p)) : [null, null];
  const apart = state.answer && !inContact(state.answer);
  put($("mark-a"), a);
  put($("mark-b"), b);
  const line = $("gap-line");
  line.toggleAttribute("hidden", !(a && b && apart));
  if (a && b) {
    for (const [name, value] of [["x1", a[0]], ["y1", a[1]], ["x2", b[0]], ["y2", b[1]]]) line.setAttribute(name, value);
  }
  const tag = $("gap-label");
  put(tag, a && b ? [(a[0] + b[0]) / 2, Math.min(a[1], b[1]) - 18] : null);
  if (a && b) {
    const text = tag.querySelector("text");
    const words = apart ? interval(state.answer.distance.distance).join(" to ") : "contact";
    if (text.textContent !== words) {
      text.textContent = words;
      const box = text.getBBox();
      const rect = tag.querySelector("rect");
      for (const [name, value] of [["x", box.x - 6], ["y", box.y - 3], ["width", box.width + 12], ["height", box.height + 6]]) rect.setAttribute(name, value);
    }
  }
  names();
}

function names() {
  const labels = $("names");
  while (labels.children.length < 2) labels.append(document.createElement("span"));
  [...labels.children].forEach((label, side) => {
    const part = view.parts[state.pair[side]];
    const shown = state.parts[state.pair[side]]?.info && part?.sphere;
    const sphere = shown && part.placedSphere();
    const { up, right } = view.axes();
    const at = shown && view.seen([0, 1, 2].map((k) => sphere.center.getComponent(k) + sphere.radius * (0.6 * up[k] - 0.55 * right[k])));
    label.hidden = !at || (side === 1 && state.pair[0] === state.pair[1]);
    if (!at) return;
    label.textContent = "AB"[side];
    label.classList.toggle("moves", side === state.moves);
    label.style.left = `${at[0]}px`;
    label.style.top = `${at[1]}px`;
  });
}

// Moving.

const handleMoving = () => view?.handlesTo(view.parts[state.pair[state.moves]], $("handles").value);

function moved(part) {
  view?.part(state.parts.indexOf(part)).place(part.pose);
  handleMoving();
  view?.draw();
  ask();
}

function moveTo(part, x, y, z) {
  part.pose = part.pose.slice();
  [part.pose[3], part.pose[7], part.pose[11]] = [x, y, z];
  moved(part);
}

function moveAlong(direction, by) {
  const part = moving();
  moveTo(part, part.pose[3] + by * direction[0], part.pose[7] + by * direction[1], part.pose[11] + by * direction[2]);
}

const middleOf = (part) => view.part(state.parts.indexOf(part)).placedSphere().center.toArray();

// From a pose, about a point, which stays where it is.
async function turned(pose, middle, axis, degrees) {
  const there = await engine.ask("pose", { steps: { after: pose, move: middle.map((x) => -x) } });
  const turned = await engine.ask("pose", { steps: { after: there, axis, degrees } });
  return engine.ask("pose", { steps: { after: turned, move: middle } });
}

async function turnPart(degrees) {
  const part = moving();
  try {
    part.pose = await turned(part.pose, middleOf(part), view.axes().forward, degrees);
    moved(part);
  } catch (error) {
    tell(error.message);
  }
}

// What handles do: always from where they were taken hold of. Of turns the last one counts that was asked for.
let grip = null;
async function byHandles(what) {
  if (what === "begin") {
    grip = { part: moving(), pose: moving().pose, middle: middleOf(moving()), wanted: null, busy: false };
    return;
  }
  const { part, pose, middle } = grip;
  if (what.move) return moveTo(part, pose[3] + what.move[0], pose[7] + what.move[1], pose[11] + what.move[2]);
  grip.wanted = what;
  if (grip.busy) return;
  const mine = grip;
  mine.busy = true;
  while (mine.wanted) {
    const { axis, degrees } = mine.wanted;
    mine.wanted = null;
    try {
      part.pose = await turned(pose, middle, axis, degrees);
      moved(part);
    } catch (error) {
      tell(error.message);
    }
  }
  mine.busy = false;
}

function setMoves(side) {
  state.moves = side;
  document.querySelector(`input[name="moves"][value="${side}"]`).checked = true;
  if (view) names();
  handleMoving();
}

function putBack() {
  for (const part of state.parts) {
    part.pose = part.home.slice();
    view?.part(state.parts.indexOf(part)).place(part.pose);
  }
  view?.fit();
  handleMoving();
  ask();
}

function keyDown(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || !view || state.parts.length === 0 || !moving()?.info) return;
  const step = moving().size / (event.shiftKey ? 1000 : 100);
  const { right, up, forward } = view.axes();
  const actions = {
    ArrowLeft: () => moveAlong(right, -step),
    ArrowRight: () => moveAlong(right, step),
    ArrowUp: () => moveAlong(up, step),
    ArrowDown: () => moveAlong(up, -step),
    PageUp: () => moveAlong(forward, step),
    PageDown: () => moveAlong(forward, -step),
    "[": () => turnPart(-5),
    "]": () => turnPart(5),
    a: () => setMoves(0),
    b: () => state.parts.length > 1 && setMoves(1),
    j: () => view.turn(0.1, 0),
    l: () => view.turn(-0.1, 0),
    i: () => view.turn(0, -0.1),
    k: () => view.turn(0, 0.1),
    "+": () => view.zoom(1 / 1.1),
    "-": () => view.zoom(1.1),
    Home: putBack,
    h: () => $("keys").showModal(),
  };
  const action = actions[event.key] ?? actions[event.key.toLowerCase()];
  if (!action) return;
  event.preventDefault();
  action();
}

// A pointer on a part moves it; anything else is the camera's.
function listenToPointers() {
  const stage = $("stage");
  let drag = null;
  const end = () => {
    drag = null;
    view.controls.enabled = true;
  };
  stage.addEventListener("pointerdown", (event) => {
    if (event.handedOn) return;
    stage.focus({ preventScroll: true, focusVisible: false });
    if (drag) {
      // A second finger: both turn the view.
      const { first, part, pose } = drag;
      end();
      part.pose = pose;
      moved(part);
      const again = new PointerEvent("pointerdown", { ...eventInit(first), bubbles: true });
      again.handedOn = true;
      view.renderer.domElement.dispatchEvent(again);
      return;
    }
    if (event.button !== 0 || !event.isPrimary || view.overHandle(event.clientX, event.clientY)) return;
    const hit = view.hit(event.clientX, event.clientY);
    if (!hit) return;
    const side = state.pair.indexOf(hit.part);
    if (side >= 0) setMoves(side);
    const part = state.parts[hit.part];
    view.controls.enabled = false;
    drag = { id: event.pointerId, part, pose: part.pose, from: hit.point.clone(), first: event };
    stage.setPointerCapture(event.pointerId);
    event.stopPropagation();
  }, { capture: true });
  stage.addEventListener("pointermove", (event) => {
    if (!drag) {
      if (event.pointerType === "mouse" && event.buttons === 0) stage.classList.toggle("over", Boolean(view.hit(event.clientX, event.clientY)));
      return;
    }
    if (event.pointerId !== drag.id) return;
    event.stopPropagation();
    const to = view.inPlane(event.clientX, event.clientY, drag.from);
    if (!to) return;
    moveTo(drag.part, drag.pose[3] + to.x - drag.from.x, drag.pose[7] + to.y - drag.from.y, drag.pose[11] + to.z - drag.from.z);
  }, { capture: true });
  for (const name of ["pointerup", "pointercancel"]) {
    stage.addEventListener(name, (event) => drag?.id === event.pointerId && end(), { capture: true });
  }
  stage.addEventListener("contextmenu", (event) => event.preventDefault());
  stage.addEventListener("keydown", keyDown);
}

const eventInit = ({ pointerId, pointerType, clientX, clientY, screenX, screenY, button, buttons, isPrimary }) =>
  ({ pointerId, pointerType, clientX, clientY, screenX, screenY, button, buttons, isPrimary });

// Parts.

const angle = () => Math.min(179, Math.max(0, Number($("angle").value) || 0));

async function read(index, { name, bytes, scheme, path, options }) {
  const how = { scheme };
  if ($("sharp").checked) how.sharp = angle();
  const level = Number($("level").value);
  const part = state.parts[index];
  const like = state.parts.findIndex(({ source }, i) => i !== index && source?.bytes === bytes && source.scheme === scheme && source.sharp === how.sharp);
  let { source, info } = state.parts[like] ?? {};
  if (source) {
    await engine.ask("share", { part: index, from: like });
  } else {
    info = await engine.ask("read", { part: index, name: path ?? name, bytes, options: how, level });
    source = { bytes, ...how };
  }
  Object.assign(part, { name, bytes, scheme, path, options, source, info, size: info.size });
  if (view) {
    const seen = view.part(index);
    seen.shape(info.shape);
    seen.cage(info.edges, info.size);
    seen.place(part.pose);
  }
}

// What the layers show beside surfaces and cages, from the worker.
async function layers() {
  const level = Number($("level").value);
  const told = [];
  const few = state.parts.length <= many_parts;
  const made = new Map();
  for (const [index, part] of state.parts.entries()) {
    if (!part.info || !view) continue;
    // Once for all parts with the same surface.
    const ask = async (op, how) => {
      if (!made.has(part.source)) made.set(part.source, new Map());
      const known = made.get(part.source);
      if (!known.has(op)) known.set(op, await engine.ask(op, { part: index, ...how }));
      return known.get(op);
    };
    const seen = view.part(index);
    const letter = state.pair.includes(index) ? "AB"[state.pair.indexOf(index)] : part.name;
    try {
      const how = $("adaptive").checked ? { adaptive: true, tolerance: (Number(percent()) / 100) * part.size } : { level };
      const key = JSON.stringify(how);
      if (part.shapeKey !== key) {
        const shape = await ask("shape", how);
        part.shapeKey = key;
        part.triangles = shape.triangles.length / 3;
        part.shapeText = `${part.triangles} triangles` + (shape.errorBound === undefined ? "" : ` within ${shape.errorBound.toPrecision(3)}`);
        seen.shape(shape);
      }
      const told_here = [part.shapeText];
      if ($("show-enclosures").checked) {
        const shapes = await ask("enclosures", { level: Math.min(level, 3) });
        seen.enclosures(shapes);
        told_here.push(`${shapes.count} enclosures`);
      } else {
        seen.enclosures(null);
      }
      if ($("show-hulls").checked) {
        $("shown").textContent = `${letter}: making hulls\u2026`;
        const hulls = await ask("hulls", { tolerance: Math.max(0.005, Number(percent()) / 100) * part.size });
        seen.hulls(hulls);
        const gaps = [hulls.inner, hulls.outer].filter(Boolean).map((hull) => hull.gap.toPrecision(3));
        told_here.push(`hulls ${hulls.outcome === "complete" ? "proved" : "not proved"}, gaps ${gaps.join(" and ")}`);
      } else {
        seen.hulls(null);
      }
      if (few || state.pair.includes(index)) told.push(`${letter}: ${told_here.join(", ")}`);
    } catch (error) {
      tell(`${letter}: ${error.message}`);
    }
    visibility();
  }
  if (!few) told.push(`${state.parts.length} parts: ${state.parts.reduce((sum, part) => sum + (part.triangles ?? 0), 0)} triangles`);
  $("shown").textContent = told.join("; ");
}
let redoing = false;
let redo = false;
async function showLayers() {
  if (redoing) {
    redo = true;
    return;
  }
  redoing = true;
  do {
    redo = false;
    await layers();
  } while (redo);
  redoing = false;
}

function visibility() {
  if (!view) return;
  const solid = !$("show-enclosures").checked && !$("show-hulls").checked;
  for (const part of view.parts) {
    part.show("surface", $("show-surface").checked);
    part.show("mesh", $("show-mesh").checked);
    part.show("cage", $("show-cage").checked);
    for (const surface of part.layers.get("surface") ?? []) surface.material.wireframe = false;
  }
  document.body.classList.toggle("glass", !solid);
  view.draw();
}

function partCard(side) {
  const part = state.parts[state.pair[side]];
  const card = $(side === 0 ? "part-a" : "part-b");
  card.replaceChildren();
  if (!part?.info) {
    card.textContent = `${"AB"[side]}: no part yet; drop a file here`;
    if (state.parts.length > 1 || side === 0) return;
  }
  const title = document.createElement("strong");
  title.textContent = `${"AB"[side]}: ${part?.name.split("/").pop() ?? ""}`;
  title.title = part?.name ?? "";
  const lines = part ? [`${part.info.vertices} vertices, ${part.info.faces} faces, ${part.info.scheme}`, ...part.info.notes] : [];
  const facts = lines.map((line) => {
    const fact = document.createElement("p");
    fact.className = "fine";
    fact.textContent = line;
    return fact;
  });
  const row = document.createElement("p");
  row.className = "row";
  const label = document.createElement("label");
  label.textContent = "Scheme ";
  const select = document.createElement("select");
  select.id = `scheme-${"ab"[side]}`;
  for (const name of schemes) select.append(new Option(name, name, false, name === part?.scheme));
  select.disabled = !part;
  select.onchange = () => change(state.pair[side], { ...part, scheme: select.value });
  label.append(select);
  const file = document.createElement("label");
  file.className = "file";
  file.textContent = "Open a file\u2026";
  const input = document.createElement("input");
  input.type = "file";
  input.accept = ".obj,.off,.ply,.stl,.usda,.glb,.gltf,.3mf";
  input.id = `file-${"ab"[side]}`;
  input.onchange = () => input.files[0] && openFile(input.files[0], side);
  file.append(input);
  row.append(label, file);
  card.replaceChildren(title, ...facts, row);
}

function cards() {
  partCard(0);
  partCard(1);
  $("pair-row").hidden = state.parts.length < 3;
  for (const [side, id] of ["pair-a", "pair-b"].entries()) {
    $(id).replaceChildren(...state.parts.map((part, i) => new Option(part.name, i, false, i === state.pair[side])));
  }
}

// Another file or scheme for a part; on a fault what was there stays.
async function change(index, wanted) {
  silence();
  try {
    await read(index, wanted);
    state.parts[index].shapeKey = undefined;
  } catch (error) {
    tell(error.message);
  }
  cards();
  await showLayers();
  await ask();
}

let opening = 0;
async function openFile(file, side) {
  ++opening;
  try {
    await openFileAs(file, side);
  } finally {
    --opening;
  }
}

async function openFileAs(file, side) {
  const bytes = new Uint8Array(await file.arrayBuffer());
  const fresh = state.parts.length < 2 && side === 1;
  if (fresh) state.parts.push({ name: file.name, pose: identity.slice(), home: identity.slice(), size: 0, info: null });
  const index = fresh ? 1 : state.pair[side];
  const before = state.parts[index].name;
  await change(index, { name: file.name, bytes, scheme: "auto" });
  if (fresh && !state.parts[1].info) state.parts.pop();
  else if (state.parts[index].name !== before || fresh) view?.fit();
  cards();
}

function listenToDrops() {
  let depth = 0;
  addEventListener("dragenter", (event) => {
    event.preventDefault();
    ++depth;
    $("drop-hint").hidden = false;
  });
  addEventListener("dragleave", () => {
    if (--depth <= 0) $("drop-hint").hidden = true;
  });
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("drop", (event) => {
    event.preventDefault();
    depth = 0;
    $("drop-hint").hidden = true;
    const file = event.dataTransfer.files[0];
    if (!file) return;
    // On a part or its card: in its place; elsewhere: for the part that moves.
    const card = event.target.closest?.("#part-a, #part-b");
    const hit = view?.hit(event.clientX, event.clientY);
    const side = card ? Number(card.id === "part-b") : hit && state.pair.includes(hit.part) ? state.pair.indexOf(hit.part) : state.moves;
    openFile(file, side);
  });
}

// A scene: parts with their poses, all new.
// Until somebody does: the finest that is quickly drawn, so that outlines of coarse cages look as smooth as they are.
let level_is_chosen = false;
function chooseLevel() {
  if (level_is_chosen || state.parts.length > many_parts) return;
  const drawn = state.parts.reduce((sum, { info }) => sum + (info ? info.shape.triangles.length / 3 : 0), 0);
  if (drawn * 4 > 40_000) return;
  $("level").value = 1 + Number($("level").value);
  $("level-text").textContent = $("level").value;
}

async function open(parts, direction) {
  silence();
  view?.keep(0);
  state.parts = parts.map((part) => ({ scheme: "auto", pose: identity.slice(), size: 0, info: null, ...part }));
  for (const part of state.parts) part.home = part.pose.slice();
  state.pair = [0, Math.min(1, parts.length - 1)];
  state.answer = null;
  setMoves(parts.length > 1 ? 1 : 0);
  if (!level_is_chosen && parts.length <= many_parts) $("level").value = 3;
  for (const [index, part] of state.parts.entries()) {
    try {
      await read(index, part);
    } catch (error) {
      tell(error.message);
    }
  }
  chooseLevel();
  cards();
  visibility();
  view?.fit(direction);
  handleMoving();
  if (state.parts.length === 1) verdictWords("one", "One part", "Drop another file to compare it with this one.");
  await ask();
  await showLayers();
}

async function openExample(example) {
  const poses = [identity.slice(), await engine.ask("pose", { steps: { degrees: example.rotate[0], axis: example.rotate[1], move: example.move } })];
  const bytes = (text) => new TextEncoder().encode(text);
  await open(example.parts.map(([name, text], i) => ({ name, bytes: bytes(text), pose: poses[i] })), example.view);
}

// Controls.

function listenToControls() {
  $("tolerance").value = usual_tolerance;
  const told = () => ($("tolerance-text").textContent = `${percent()} %`);
  const level_told = () => ($("level-text").textContent = $("level").value);
  told();
  level_told();
  $("tolerance").oninput = () => {
    told();
    ask();
    if ($("adaptive").checked || $("show-hulls").checked) showLayers();
  };
  $("level").oninput = () => {
    level_is_chosen = true;
    level_told();
    showLayers();
  };
  $("solid").onchange = () => {
    silence();
    ask();
  };
  $("look").append(...looks.map(({ name }, i) => new Option(name, i)));
  $("look").onchange = () => look(Number($("look").value));
  $("handles").onchange = handleMoving;
  $("story-next").onclick = () => tellStory(step + 1);
  $("story-skip").onclick = () => tellStory(-1);
  for (const id of ["show-surface", "show-cage", "show-mesh"]) $(id).onchange = visibility;
  for (const id of ["show-enclosures", "show-hulls", "adaptive"]) $(id).onchange = showLayers;
  const sharpen = async () => {
    for (const [index, part] of state.parts.entries()) if (part.info) await change(index, part);
  };
  $("sharp").onchange = sharpen;
  $("angle").onchange = () => $("sharp").checked && sharpen();
  $("reset").onclick = putBack;
  for (const radio of document.querySelectorAll('input[name="moves"]')) radio.onchange = () => setMoves(Number(radio.value));
  for (const [side, id] of ["pair-a", "pair-b"].entries()) {
    $(id).onchange = () => {
      state.pair[side] = Number($(id).value);
      cards();
      overlay();
      ask();
    };
  }
  $("depth").onclick = async () => {
    const { a, b, poseA, poseB } = state.answer.question;
    $("depth-text").textContent = "measuring\u2026";
    try {
      const found = await engine.ask("depth", { a, b, poseA, poseB });
      const [least, most] = interval(found.depth);
      $("depth-text").textContent = `A translation of B between ${least} and ${most} long separates them: ${point_text(found.translation)} does.`;
    } catch (error) {
      $("depth-text").textContent = "";
      tell(error.message);
    }
  };
  $("copy").onclick = async () => {
    try {
      await navigator.clipboard.writeText($("commands").textContent);
      $("copy").textContent = "Copied";
      setTimeout(() => ($("copy").textContent = "Copy"), 1500);
    } catch {
      getSelection().selectAllChildren($("commands"));
    }
  };
  $("proof").onclick = downloadProof;
  $("show-keys").onclick = () => $("keys").showModal();
  $("fault").querySelector("button").onclick = silence;
  $("example").append(...examples.map((example, i) => new Option(example.name, i)));
  $("example").onchange = () => openExample(examples[$("example").value]);
}

// What `snug view` put in: {files: [{name, base64}], parts: [{name, file, place, scheme, options}], sharp, answer}. Parts of a
// scene have `options`.
async function openData(data) {
  $("example-row").hidden = true;
  if (data.answer) {
    try {
      const answer = JSON.parse(data.answer);
      if (!Array.isArray(answer.distance)) throw new Error("it has no distance: it is not an answer of collide or distance");
      state.file = answer;
    } catch (error) {
      tell(`the answer cannot be shown: ${error.message}`);
    }
  }
  if (data.sharp !== undefined) {
    $("sharp").checked = true;
    $("angle").value = data.sharp;
  }
  const places = [state.file?.place_a, state.file?.place_b];
  const contents = data.files.map((file) => bytesOf(file.base64));
  // Of many parts not every triangle is drawn at first.
  if (data.parts.length > many_parts) $("level").value = data.parts.length > 100 ? 0 : 1;
  $("level-text").textContent = $("level").value;
  const parts = data.parts.map((part, i) => ({
    name: part.name,
    path: part.options && data.files[part.file].name,
    options: part.options,
    bytes: contents[part.file],
    scheme: (part.scheme ?? "auto") === "auto" && schemes.includes(state.file?.scheme?.[i]) ? state.file.scheme[i] : (part.scheme ?? "auto"),
    pose: part.place ?? places[i] ?? identity.slice(),
  }));
  await open(parts, [0.55, 0.35, 0.85]);
  const asked = state.file?.tolerance ?? state.file?.absolute;
  const same = tolerances.findIndex((text) => (Number(text) / 100) * largest() === asked);
  if (same >= 0 && same !== Number($("tolerance").value)) {
    $("tolerance").value = same;
    $("tolerance").oninput();
  }
}

async function start() {
  const began = performance.now();
  listenToControls();
  try {
    view = new View($("stage"), overlay);
    view.onHandles = byHandles;
    view.onScheme(() => {
      for (const [index, part] of state.parts.entries()) {
        if (!part.info) continue;
        part.shapeKey = undefined;
        view.part(index).cage(part.info.edges, part.info.size);
      }
      showLayers();
    });
    listenToPointers();
  } catch (error) {
    view = null;
    tell(`This browser shows no 3D pictures (WebGL): answers come all the same. ${error.message}`);
  }
  listenToDrops();
  try {
    engine = new Engine($("snug-engine").textContent);
    const zipped = new Blob([bytesOf($("snug-wasm").textContent.trim())]).stream();
    const wasm = await new Response(zipped.pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
    await engine.ask("start", { wasm }, [wasm]);
    const data = JSON.parse($("snug-data").textContent);
    if (data) await openData(data);
    else {
      await openExample(examples[0]);
      tellStory(0);
    }
  } catch (error) {
    verdictWords("undecided", "No answer", "The library could not be started.");
    tell(error.message);
  }
  document.body.dataset.ready = String(Math.round(performance.now() - began));
}

// For tests and for whoever looks under the bonnet: places, answers and times; a drag of many steps without the mouse.
window.snugPage = {
  state: () => ({ ready: document.body.dataset.ready, pair: state.pair, poses: state.parts.map((p) => p.pose), names: state.parts.map((p) => p.name),
    answer: state.answer, busy: asking || redoing || opening > 0 }),
  commands: () => state.answer && commands(state.answer),
  seen: (point) => view.seen(point),
  middle: (index) => view.parts[index].placedSphere().center.toArray(),
  times: () => answered.splice(0),
};

start();
