// What runs in a worker: worker.js.

import Snug from "./snug.js";

const port = typeof postMessage === "function" ? globalThis : (await import("node:worker_threads")).parentPort;
const surfaces = new Map();
let ready = null;

const buffers = (value) =>
  value !== null && typeof value === "object" ? (ArrayBuffer.isView(value) ? [value.buffer] : Object.values(value).flatMap(buffers)) : [];

async function answer({ start, id, target, name, args, watch }) {
  if (start !== undefined) {
    ready = Snug(start);
    return ready.catch(() => {}); // who asks is told
  }
  try {
    const snug = await ready;
    const all = args.map((each) => (each?.surface === undefined ? each : surfaces.get(each.surface)));
    if (watch) all.push({ ...all.pop(), progress: (done) => port.postMessage({ id, done }) });
    if (target !== null && !surfaces.has(target)) throw new TypeError("this Surface has been deleted");
    const result = target === null ? snug[name](...all) : surfaces.get(target)[name](...all);
    if (name === "delete") surfaces.delete(target);
    if (!(result instanceof snug.Surface)) return port.postMessage({ id, result }, [...new Set(buffers(result))]);
    surfaces.set(id, result);
    const { size, scheme, boundary, notes } = result;
    port.postMessage({ id, result: { surface: id, facts: { size, scheme, boundary, notes } } });
  } catch ({ name: kind, message, problem }) {
    port.postMessage({ id, fault: { name: kind, message, problem } });
  }
}
// One after the other, as they come.
let before = Promise.resolve();
const hear = (data) => (before = before.then(() => answer(data)));
if (port === globalThis) onmessage = ({ data }) => hear(data);
else port.on("message", hear);
