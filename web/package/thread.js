// What runs in a worker: worker.js.

import Snug from "./snug.js";

const port = typeof postMessage === "function" ? globalThis : (await import("node:worker_threads")).parentPort;
const objects = new Map(); // surfaces and robots, by the number of the message that made them
let ready = null;

// What stands for an object on the other side, and back, in lists of parts, too.
function keep(made, number) {
  objects.set(number, made);
  const { size, scheme, boundary, notes, name, links, joints, outward } = made;
  return { number, facts: links === undefined ? { size, scheme, boundary, notes } : { name, links, joints, outward } };
}
function kept(each) {
  if (Array.isArray(each)) return each.map((part) => (part?.surface === undefined ? part : { ...part, surface: kept(part.surface) }));
  return each?.number === undefined ? each : objects.get(each.number);
}
function keepParts(parts, id) {
  const own = [...new Set(parts.map(({ surface }) => surface))].map((surface, i) => [surface, keep(surface, `${id}/${i}`)]), by = new Map(own);
  return parts.map((part) => ({ ...part, surface: by.get(part.surface) }));
}

const buffers = (value) =>
  value !== null && typeof value === "object" ? (ArrayBuffer.isView(value) ? [value.buffer] : Object.values(value).flatMap(buffers)) : [];

async function answer({ start, id, target, name, args, watch }) {
  if (start !== undefined) {
    ready = Snug(start);
    return ready.catch(() => {}); // who asks is told
  }
  try {
    const snug = await ready;
    const all = args.map(kept);
    if (watch) all.push({ ...all.pop(), progress: (done) => port.postMessage({ id, done }) });
    if (name === "delete") {
      objects.get(target)?.delete();
      objects.delete(target);
      return port.postMessage({ id });
    }
    if (target !== null && !objects.has(target)) throw new TypeError("this object has been deleted");
    const result = target === null ? snug[name](...all) : objects.get(target)[name](...all);
    if (result instanceof snug.Surface || result instanceof snug.Robot) return port.postMessage({ id, result: keep(result, id) });
    if (name === "readAssembly") return port.postMessage({ id, result: keepParts(result, id) });
    port.postMessage({ id, result }, [...new Set(buffers(result))]);
  } catch ({ name: kind, message, problem }) {
    port.postMessage({ id, fault: { name: kind, message, problem } });
  }
}
// One after the other, as they come.
let before = Promise.resolve();
const hear = (data) => (before = before.then(() => answer(data)));
if (port === globalThis) onmessage = ({ data }) => hear(data);
else port.on("message", hear);
