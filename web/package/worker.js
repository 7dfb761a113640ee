// The same functions in a worker, each with a promise: worker.d.ts.

import { SnugError, arraysOf } from "./snug.js";

const isNode = typeof process !== "undefined" && process.versions?.node !== undefined;

/** Starts a worker. Its functions are those of Snug() and of its surfaces. */
export default function SnugWorker(options = {}) {
  let thread = null, next = 0, closed = false;
  const waiting = new Map(); // by number: what is asked, and its promise
  const kept = new Map(); // by number: how each surface was made, for a worker that takes the place of another

  const broken = (error) => {
    for (const asked of waiting.values()) asked.reject(error);
    waiting.clear();
  };
  async function start() {
    const url = new URL("./thread.js", import.meta.url);
    const made = isNode ? new (await import("node:worker_threads")).Worker(url) : new Worker(url, { type: "module" });
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
    for (const [id, message] of kept) if (!waiting.has(id)) made.postMessage(message);
    for (const asked of waiting.values()) post(asked, made);
    return made;
  }
  // Once to each worker.
  function post(asked, made) {
    if (asked.by !== made) made.postMessage(asked.message);
    asked.by = made;
  }
  // A call that is under way cannot be stopped from outside: its worker ends, and another one does what else was asked.
  function restart() {
    const before = thread;
    thread = start();
    before.then((made) => made.terminate());
  }

  async function ask(message, { signal, progress, keep = false } = {}) {
    if (closed) throw new Error("this worker was closed");
    signal?.throwIfAborted();
    message.id = ++next;
    message.watch = progress !== undefined;
    const answer = new Promise((resolve, reject) => waiting.set(message.id, { message, resolve, reject, progress }));
    if (keep) kept.set(message.id, message);
    thread ??= start();
    thread.then((made) => waiting.has(message.id) && post(waiting.get(message.id), made));
    const abort = () => {
      if (!waiting.has(message.id)) return;
      waiting.get(message.id).reject(signal.reason);
      waiting.delete(message.id);
      kept.delete(message.id);
      restart();
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
  async function sent(target, name, args, keep) {
    const last = args.at(-1);
    const own = last !== null && typeof last === "object" && Object.getPrototypeOf(last) === Object.prototype;
    const { signal, progress, ...rest } = own ? last : {};
    const all = own ? [...args.slice(0, -1), rest] : args;
    if (typeof rest.files === "function") throw new TypeError("files: give an object; a worker cannot call functions of yours");
    const by = (each) => (each instanceof Kept ? { number: each.number } : each);
    const packed = (each) => (Array.isArray(each) && each.some((part) => part?.surface) ? each.map((part) => ({ ...part, surface: by(part.surface) })) : by(each));
    return ask({ target, name, args: all.map(packed) }, { signal, progress, keep });
  }
  // What lives in the worker.
  class Kept {
    constructor({ number, facts }) {
      this.number = number;
      Object.assign(this, facts);
    }
    delete() {
      kept.delete(this.number);
      return sent(this.number, "delete", []);
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
  const makes = (name, Made) => async (...args) => new Made(await sent(null, name, args, true));
  const asks = (name) => (...args) => sent(null, name, args);
  const names = ["inspect", "collide", "distance", "collideMany", "distanceMany", "collideScene", "distanceScene", "contacts", "penetration",
    "timeOfContact", "clearance", "deviation", "pose", "textAtMost", "textAtLeast"];
  return {
    Surface,
    Robot,
    read: makes("read", Surface),
    readAssembly: async (...args) => {
      const parts = await sent(null, "readAssembly", args, true), made = new Map();
      for (const { surface } of parts) if (!made.has(surface.number)) made.set(surface.number, new Surface(surface));
      return parts.map((part) => ({ ...part, surface: made.get(part.surface.number) }));
    },
    urdf: makes("urdf", Robot),
    fromArrays: makes("fromArrays", Surface),
    fromGeometry: (geometry, how = {}) => makes("fromArrays", Surface)(arraysOf(geometry), { scheme: "flat", weld: 0, ...how }),
    ...Object.fromEntries(names.map((name) => [name, asks(name)])),
    async close() {
      closed = true;
      await (await thread)?.terminate();
      broken(new Error("this worker was closed"));
    },
  };
}
