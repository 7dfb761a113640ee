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
    closestPoint(point, options = {}) {
      return checked(module.closest(Surface.part(this), point, options));
    }
    limitToFaces() {
      return checked(module.limitToFaces(Surface.part(this)));
    }
    measure(options = {}) {
      return checked(module.measure(Surface.part(this), options));
    }
    delete() {
      this.#part?.delete();
      this.#part = null;
    }
  }

  return {
    Surface,
    read: (name, data, options = {}) => new Surface(checked(module.read(bytesOf(data), name, options)).part),
    collide: (a, b, options = {}) => checked(module.collide(Surface.part(a), Surface.part(b), options)),
    distance: (a, b, options = {}) => checked(module.distance(Surface.part(a), Surface.part(b), options)),
    penetration: (a, b, options = {}) => checked(module.penetration(Surface.part(a), Surface.part(b), options)),
    pose: (steps) => checked(module.pose(steps)),
    textAtMost: (x) => module.textAtMost(x, false),
    textAtLeast: (x) => module.textAtMost(x, true),
  };
}
