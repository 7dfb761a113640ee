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
export function arraysOf(geometry) {
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
    delete() {
      this.#part?.delete();
      this.#part = null;
    }
  }

  // Of a surface, or of two and options; what is not given is as usual.
  const ask = (name, ...usual) => function (...given) {
    return checked(module[name](Surface.part(this), ...usual.map((each, i) => given[i] ?? each)));
  };
  const both = (name) => (a, b, options = {}) => checked(module[name](Surface.part(a), Surface.part(b), options));
  const many = (name) => (a, b, posesB, options = {}) => checked(module[name](Surface.part(a), Surface.part(b), posesB, options));
  const given = undefined; // there is no default
  Object.assign(Surface.prototype, {
    cage: ask("cage"),
    samples: ask("sampled", 2),
    tessellate: ask("tessellate", {}),
    enclosures: ask("enclosures", {}),
    enclosureShapes: ask("enclosureShapes", {}),
    hull: ask("hull", {}),
    envelope: ask("envelope", {}),
    evaluate: ask("evaluate", given),
    closestPoint: ask("closest", given, {}),
    contains: ask("contains", given),
    ray: ask("ray", given, given, {}),
    selfContact: ask("selfContact", {}),
    limitToFaces: ask("limitToFaces"),
    measure: ask("measure", {}),
    subdivided: ask("subdivided", 1, false),
    write: ask("write", "part.obj"),
    step: ask("step", {}),
  });

  return {
    Surface,
    read: (name, data, options = {}) => new Surface(checked(module.read(bytesOf(data), name, options)).part),
    fromArrays: (arrays, options = {}) => new Surface(checked(module.fromArrays(arrays, options)).part),
    fromGeometry: (geometry, options = {}) =>
      new Surface(checked(module.fromArrays(arraysOf(geometry), { scheme: "flat", weld: 0, ...options })).part),
    inspect: (arrays, options = {}) => checked(module.inspect(arrays, options)),
    collide: both("collide"),
    distance: both("distance"),
    collideMany: many("collideMany"),
    distanceMany: many("distanceMany"),
    contacts: both("contacts"),
    penetration: both("penetration"),
    timeOfContact: both("timeOfContact"),
    clearance: both("clearance"),
    deviation: (surface, triangles, options = {}) => checked(module.deviation(Surface.part(surface), triangles, options)),
    pose: (steps) => checked(module.pose(steps)),
    textAtMost: (x) => module.textAtMost(x, false),
    textAtLeast: (x) => module.textAtMost(x, true),
  };
}
