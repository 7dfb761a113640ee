// The package: the module with a face for people. Its types and what they mean are in snug.d.ts.

import load from "snug-module";

/** What the library refuses. */
export class SnugError extends Error {
  constructor(problem, message) {
    super(message);
    this.name = "SnugError";
    this.problem = problem;
  }
}

function checked(answer) {
  if (answer !== null && typeof answer === "object" && answer.problem !== undefined) {
    throw new SnugError(answer.problem, answer.message);
  }
  return answer;
}

function bytesOf(data) {
  if (typeof data === "string") return new TextEncoder().encode(data);
  if (data instanceof ArrayBuffer) return new Uint8Array(data);
  if (ArrayBuffer.isView(data)) return new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
  throw new TypeError("read: give a string, an ArrayBuffer or a Uint8Array");
}

// Of a BufferGeometry of three.js; its accessors know of strides and integers that stand for fractions.
function arraysOf(geometry) {
  const position = geometry?.attributes?.position;
  if (position === undefined) throw new TypeError("fromGeometry: give a BufferGeometry with positions");
  const points = new Float64Array(3 * position.count);
  for (let i = 0; i < position.count; ++i) points.set([position.getX(i), position.getY(i), position.getZ(i)], 3 * i);
  return { points, triangles: geometry.index?.array ?? Uint32Array.from({ length: position.count }, (_, i) => i) };
}

async function wasmBeside(url) {
  const place = new URL("./snug.wasm", url);
  if (place.protocol === "file:" && typeof process !== "undefined") {
    const { readFile } = await import("node:fs/promises");
    return readFile(place);
  }
  const answer = await fetch(place);
  if (!answer.ok) throw new Error(`${place}: ${answer.status} ${answer.statusText}`);
  return answer.arrayBuffer();
}

/** Loads the module. */
export default async function Snug({ wasm } = {}) {
  const module = await load({ wasmBinary: wasm ?? (await wasmBeside(import.meta.url)) });

  class Surface {
    #part;
    constructor(part) {
      this.#part = part;
    }
    static part(surface) {
      if (!(surface instanceof Surface)) throw new TypeError("give a Surface that read() has made");
      if (surface.#part === null) throw new TypeError("this Surface has been deleted");
      return surface.#part;
    }
    get size() {
      return Surface.part(this).size;
    }
    get scheme() {
      return Surface.part(this).scheme;
    }
    get boundary() {
      return Surface.part(this).boundary;
    }
    get notes() {
      return Surface.part(this).notes;
    }
    cage() {
      return checked(module.cage(Surface.part(this)));
    }
    samples(level = 2) {
      return checked(module.sampled(Surface.part(this), level));
    }
    tessellate(options = {}) {
      return checked(module.tessellate(Surface.part(this), options));
    }
    enclosures(options = {}) {
      return checked(module.enclosures(Surface.part(this), options));
    }
    enclosureShapes(options = {}) {
      return checked(module.enclosureShapes(Surface.part(this), options));
    }
    hull(options = {}) {
      return checked(module.hull(Surface.part(this), options));
    }
    envelope(options = {}) {
      return checked(module.envelope(Surface.part(this), options));
    }
    evaluate(at) {
      return checked(module.evaluate(Surface.part(this), at));
    }
    closestPoint(point, options = {}) {
      return checked(module.closest(Surface.part(this), point, options));
    }
    contains(point) {
      return checked(module.contains(Surface.part(this), point));
    }
    ray(origin, direction, options = {}) {
      return checked(module.ray(Surface.part(this), origin, direction, options));
    }
    selfContact(options = {}) {
      return checked(module.selfContact(Surface.part(this), options));
    }
    limitToFaces() {
      return checked(module.limitToFaces(Surface.part(this)));
    }
    measure(options = {}) {
      return checked(module.measure(Surface.part(this), options));
    }
    subdivided(level = 1, limit = false) {
      return checked(module.subdivided(Surface.part(this), level, limit));
    }
    delete() {
      this.#part?.delete();
      this.#part = null;
    }
  }

  return {
    Surface,
    read: (name, data, options = {}) => new Surface(checked(module.read(bytesOf(data), name, options)).part),
    fromArrays: (arrays, options = {}) => new Surface(checked(module.fromArrays(arrays, options)).part),
    fromGeometry: (geometry, options = {}) =>
      new Surface(checked(module.fromArrays(arraysOf(geometry), { scheme: "flat", weld: 0, ...options })).part),
    collide: (a, b, options = {}) => checked(module.collide(Surface.part(a), Surface.part(b), options)),
    distance: (a, b, options = {}) => checked(module.distance(Surface.part(a), Surface.part(b), options)),
    contacts: (a, b, options = {}) => checked(module.contacts(Surface.part(a), Surface.part(b), options)),
    penetration: (a, b, options = {}) => checked(module.penetration(Surface.part(a), Surface.part(b), options)),
    timeOfContact: (a, b, options = {}) => checked(module.timeOfContact(Surface.part(a), Surface.part(b), options)),
    deviation: (surface, triangles, options = {}) => checked(module.deviation(Surface.part(surface), triangles, options)),
    pose: (steps) => checked(module.pose(steps)),
    textAtMost: (x) => module.textAtMost(x, false),
    textAtLeast: (x) => module.textAtMost(x, true),
  };
}
