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
  if (typeof answer?.problem === "string" && "message" in answer) {
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
// Of reading: `files`, by a function of their paths or an object, becomes a function to bytes.
function reading({ files, srdf, ...rest }) {
  if (srdf !== undefined) rest.srdf = bytesOf(srdf);
  if (files === undefined) return rest;
  const known = typeof files === "function" ? null : new Map(Object.entries(files)), find = (path) => (known === null ? files(path) : known.get(path));
  return { ...rest, files: (path) => { const data = find(path); return data === undefined ? data : bytesOf(data); } };
}

// Of a BufferGeometry of three.js; its accessors know of strides and integers that stand for fractions.
export function arraysOf(geometry) {
  const position = geometry?.attributes?.position;
  if (position === undefined) throw new TypeError("fromGeometry: give a BufferGeometry with positions");
  const points = new Float64Array(3 * position.count);
  for (let i = 0; i < position.count; ++i) points.set([position.getX(i), position.getY(i), position.getZ(i)], 3 * i);
  return { points, triangles: geometry.index?.array ?? Uint32Array.from({ length: position.count }, (_, i) => i) };
}

// A function with a vector of 128 bits: does this engine know them?
const hasVectors = () => WebAssembly.validate(Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11));

async function bytesAt(place) {
  if (place.protocol === "file:" && typeof process !== "undefined") {
    const { readFile } = await import("node:fs/promises");
    return readFile(place);
  }
  const answer = await fetch(place);
  if (!answer.ok) throw new Error(`${place}: ${answer.status} ${answer.statusText}`);
  return answer.arrayBuffer();
}
// The module for vectors, where it is known and there. Names stand in `new URL` themselves, where bundlers look for files to take along.
async function wasmFor(simd) {
  if (simd ?? hasVectors()) {
    try {
      return await bytesAt(new URL("./snug.simd.wasm", import.meta.url));
    } catch (error) {
      if (simd) throw error;
    }
  }
  return bytesAt(new URL("./snug.wasm", import.meta.url));
}

/** Loads the module. */
export default async function Snug({ wasm, simd } = {}) {
  const module = await load({ wasmBinary: wasm ?? (await wasmFor(simd)) });

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

  class Robot {
    #robot;
    constructor(robot) {
      this.#robot = robot;
      for (const name of ["name", "links", "joints", "outward"]) this[name] = robot[name];
    }
    #made() {
      if (this.#robot === null) throw new TypeError("this Robot has been deleted");
      return this.#robot;
    }
    poses(positions = {}) {
      return checked(this.#made().poses(positions));
    }
    firstContacts(path, options = {}) {
      return checked(this.#made().firstContacts(path, options));
    }
    delete() {
      this.#robot?.delete();
      this.#robot = null;
    }
  }
  const parts = (list) => list.map(({ surface, pose }) => ({ part: Surface.part(surface), pose }));

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
    Robot,
    read: (name, data, options = {}) => new Surface(checked(module.read(bytesOf(data), name, reading(options))).part),
    readAssembly: (name, data, options = {}) => {
      const made = checked(module.readAssembly(bytesOf(data), name, reading(options))), surfaces = made.surfaces.map((part) => new Surface(part));
      return made.parts.map((part) => ({ ...part, surface: surfaces[part.surface] }));
    },
    urdf: (name, data, options = {}) => new Robot(checked(module.urdf(bytesOf(data), name, reading(options))).robot),
    fromArrays: (arrays, options = {}) => new Surface(checked(module.fromArrays(arrays, options)).part),
    fromGeometry: (geometry, options = {}) =>
      new Surface(checked(module.fromArrays(arraysOf(geometry), { scheme: "flat", weld: 0, ...options })).part),
    inspect: (arrays, options = {}) => checked(module.inspect(arrays, options)),
    collide: both("collide"),
    distance: both("distance"),
    collideScene: (list, options = {}) => checked(module.collideScene(parts(list), options)),
    distanceScene: (list, limit, options = {}) => checked(module.distanceScene(parts(list), limit, options)),
    collideMany: many("collideMany"),
    distanceMany: many("distanceMany"),
    contacts: both("contacts"),
    penetration: both("penetration"),
    timeOfContact: both("timeOfContact"),
    clearance: both("clearance"),
    deviation: (surface, candidate, options = {}) =>
      checked(module.deviation(Surface.part(surface), candidate instanceof Surface ? Surface.part(candidate) : candidate, options)),
    pose: (steps) => checked(module.pose(steps)),
    textAtMost: (x) => module.textAtMost(x, false),
    textAtLeast: (x) => module.textAtMost(x, true),
  };
}
