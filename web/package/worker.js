// The same functions in a worker, each with a promise: worker.d.ts.

import { SnugError, arraysOf } from "./snug.js";

const isNode = typeof process !== "undefined" && process.versions?.node !== undefined;

/** Starts workers. Their functions are those of Snug() and of its surfaces. */
export default function SnugWorker({ threads: count = 1, ...options } = {}) {
  if (!(Number.isInteger(count) && count >= 1)) throw new TypeError("threads: give a whole number, at least 1");
  const threads = Array(count).fill(null); // promises of workers; null until there is something to do
  let next = 0, closed = false;
  const waiting = new Map(); // by number: what is asked, and its promise
  const kept = new Map(); // likewise: how each surface was made, for workers that begin later

  const broken = (error) => {
    for (const asked of waiting.values()) asked.reject(error);
    waiting.clear();
  };
  async function start(own) {
    const { Worker: NodeWorker } = isNode ? await import("node:worker_threads") : {};
    // In the form that bundlers know.
    const made = isNode ? new NodeWorker(new URL("./thread.js", import.meta.url)) : new Worker(new URL("./thread.js", import.meta.url), { type: "module" });
    const hear = (data) => {
      const asked = waiting.get(data.id);
      if (data.done !== undefined) return asked?.progress?.(data.done);
      waiting.delete(data.id);
      if (asked === undefined) return;
      if (data.fault === undefined) return asked.resolve(data.result);
      const { name, message, problem } = data.fault;
      asked.reject(name === "SnugError" ? new SnugError(problem, message) : name === "TypeError" ? new TypeError(message) : new Error(message));
    };
    if (isNode) made.on("message", hear).on("error", broken);
    else Object.assign(made, { onmessage: ({ data }) => hear(data), onerror: ({ message }) => broken(new Error(message)) });
    made.postMessage({ start: options });
    for (const asked of kept.values()) send(asked, made);
    for (const asked of waiting.values()) if (asked.by === own) send(asked, made);
    return made;
  }
  // Once to each worker.
  function send(asked, made) {
    if (!asked.to.has(made)) made.postMessage(asked.message);
    asked.to.add(made);
  }
  // To one worker, or to all that have begun: what is kept.
  const places = (by) => (by !== null ? [by] : threads.some((made) => made !== null) ? threads.flatMap((made, i) => (made === null ? [] : [i])) : [0]);
  function post(asked) {
    for (const i of places(asked.by)) {
      threads[i] ??= start(i);
      threads[i].then((made) => (waiting.has(asked.message.id) || kept.has(asked.message.id)) && send(asked, made));
    }
  }
  // The one with the least to do; one that has not begun comes last among those.
  function idlest() {
    const load = threads.map((made) => (made === null ? 0.5 : 0));
    for (const { by } of waiting.values()) ++load[by ?? 0];
    return load.indexOf(Math.min(...load));
  }
  // A call that is under way cannot be stopped from outside: its worker ends, and another one does what else was asked.
  function restart(i) {
    const before = threads[i];
    threads[i] = start(i);
    before.then((made) => made.terminate());
  }

  async function ask(message, { signal, progress, keep = false, by = keep ? null : idlest() } = {}) {
    if (closed) throw new Error("this worker was closed");
    signal?.throwIfAborted();
    message.id = ++next;
    message.watch = progress !== undefined;
    const asked = { message, progress, by, to: new WeakSet() };
    const answer = new Promise((resolve, reject) => Object.assign(asked, { resolve, reject }));
    waiting.set(message.id, asked);
    if (keep) kept.set(message.id, asked);
    post(asked);
    const abort = () => {
      if (!waiting.has(message.id)) return;
      asked.reject(signal.reason);
      waiting.delete(message.id);
      kept.delete(message.id);
      for (const i of places(by)) restart(i);
    };
    signal?.addEventListener("abort", abort);
    try {
      return await answer;
    } catch (error) {
      kept.delete(message.id);
      throw error;
    } finally {
      signal?.removeEventListener("abort", abort);
    }
  }
  // What only this side knows leaves the options; surfaces become their numbers.
  async function sent(target, name, args, how) {
    const last = args.at(-1);
    const own = last !== null && typeof last === "object" && Object.getPrototypeOf(last) === Object.prototype;
    const { signal, progress, ...rest } = own ? last : {};
    const all = own ? [...args.slice(0, -1), rest] : args;
    if (typeof rest.files === "function") throw new TypeError("files: give an object; a worker cannot call functions of yours");
    const by = (each) => (each instanceof Kept ? { number: each.number } : each);
    const packed = (each) => (Array.isArray(each) && each.some((part) => part?.surface) ? each.map((part) => ({ ...part, surface: by(part.surface) })) : by(each));
    return ask({ target, name, args: all.map(packed) }, { signal, progress, ...how });
  }
  // Many poses, a share of them to each worker.
  const shared = (name) => async (a, b, posesB, { progress, ...options } = {}) => {
    const share = 12 * Math.ceil(posesB.length / 12 / count);
    if (count === 1 || posesB.length % 12 !== 0 || share === 0) return sent(null, name, [a, b, posesB, { progress, ...options }]);
    const done = Array(Math.ceil(posesB.length / share)).fill(0);
    const told = (i) => progress && ((fraction) => progress((done[i] = fraction, done.reduce((x, y) => x + y) / done.length)));
    const answers = await Promise.all(done.map((_, i) =>
      sent(null, name, [a, b, posesB.slice(share * i, share * (i + 1)), { progress: told(i), ...options }], { by: i })));
    const joined = (member) => {
      const all = new answers[0][member].constructor(posesB.length / 12);
      answers.forEach((each, i) => all.set(each[member], (share / 12) * i));
      return all;
    };
    return Object.fromEntries(Object.keys(answers[0]).map((member) => [member, joined(member)]));
  };
  // What lives in the worker.
  class Kept {
    constructor({ number, facts }) {
      this.number = number;
      Object.assign(this, facts);
    }
    delete() {
      kept.delete(this.number);
      return sent(this.number, "delete", [], { by: null });
    }
  }
  const having = (methods) => {
    class Own extends Kept {}
    for (const name of methods) Own.prototype[name] = function (...args) { return sent(this.number, name, args); };
    return Own;
  };
  const Surface = having(["cage", "samples", "tessellate", "enclosures", "enclosureShapes", "hull", "envelope", "evaluate", "closestPoint", "contains",
    "ray", "selfContact", "limitToFaces", "measure", "subdivided", "write", "step"]);
  const Robot = having(["poses", "firstContacts"]);
  const makes = (name, Made) => async (...args) => new Made(await sent(null, name, args, { keep: true }));
  const asks = (name) => (...args) => sent(null, name, args);
  const names = ["inspect", "collide", "distance", "collideScene", "distanceScene", "contacts", "penetration",
    "timeOfContact", "clearance", "deviation", "pose", "textAtMost", "textAtLeast"];
  return {
    Surface,
    Robot,
    read: makes("read", Surface),
    readAssembly: async (...args) => {
      const parts = await sent(null, "readAssembly", args, { keep: true }), made = new Map();
      for (const { surface } of parts) if (!made.has(surface.number)) made.set(surface.number, new Surface(surface));
      return parts.map((part) => ({ ...part, surface: made.get(part.surface.number) }));
    },
    urdf: makes("urdf", Robot),
    fromArrays: makes("fromArrays", Surface),
    fromGeometry: (geometry, how = {}) => makes("fromArrays", Surface)(arraysOf(geometry), { scheme: "flat", weld: 0, ...how }),
    ...Object.fromEntries(names.map((name) => [name, asks(name)])),
    collideMany: shared("collideMany"),
    distanceMany: shared("distanceMany"),
    async close() {
      closed = true;
      await Promise.all(threads.map(async (made) => (await made)?.terminate()));
      broken(new Error("this worker was closed"));
    },
  };
}
