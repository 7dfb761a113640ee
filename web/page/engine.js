// The worker: the library, and the parts of the page. Messages in: {id, op, ...}; out: {id, result} or {id, fault}.

import Snug from "../package/snug.js";

let snug = null;
const parts = new Map();

const shapeOf = (surface, { level, adaptive, tolerance }) => {
  if (!adaptive) return surface.samples(level);
  const { positions, normals, triangles, errorBound } = surface.tessellate({ error: tolerance });
  return { positions: Float32Array.from(positions), normals: Float32Array.from(normals), triangles, errorBound };
};

// Edges of the control mesh, each once, as pairs of points.
const edgesOf = ({ points, offsets, corners }) => {
  const seen = new Set();
  const lines = [];
  for (let f = 0; f + 1 < offsets.length; ++f) {
    for (let i = offsets[f]; i < offsets[f + 1]; ++i) {
      const a = corners[i];
      const b = corners[i + 1 < offsets[f + 1] ? i + 1 : offsets[f]];
      const key = Math.min(a, b) * 4294967296 + Math.max(a, b);
      if (seen.has(key)) continue;
      seen.add(key);
      lines.push(...points.subarray(3 * a, 3 * a + 3), ...points.subarray(3 * b, 3 * b + 3));
    }
  }
  return Float32Array.from(lines);
};

// Parts may share a surface.
function keep(part, surface) {
  const before = parts.get(part);
  parts.set(part, surface);
  if (before && ![...parts.values()].includes(before)) before.delete();
}

const operations = {
  async start({ wasm }) {
    snug = await Snug({ wasm });
    return {};
  },
  // Reads a part and keeps it in the place of the one of this number; on a fault that one stays.
  read({ part, name, bytes, options, level }) {
    const surface = snug.read(name, bytes, options);
    let cage, shape;
    try {
      cage = surface.cage();
      shape = surface.samples(level);
    } catch (error) {
      surface.delete();
      throw error;
    }
    keep(part, surface);
    return {
      size: surface.size,
      scheme: surface.scheme,
      notes: surface.notes,
      vertices: cage.points.length / 3,
      faces: cage.offsets.length - 1,
      edges: edgesOf(cage),
      shape,
    };
  },
  // The part has the surface of another one.
  share({ part, from }) {
    keep(part, parts.get(from));
  },
  ask({ a, b, poseA, poseB, tolerance, solid }) {
    const start = performance.now();
    const collision = snug.collide(parts.get(a), parts.get(b), { poseA, poseB, tolerance, solid, measure: true, proveContact: true });
    const distance = snug.distance(parts.get(a), parts.get(b), { poseA, poseB, absolute: tolerance, solid });
    const milliseconds = performance.now() - start;
    return {
      collision,
      distance,
      milliseconds,
    };
  },
  // Of the distance where there is one, else of what collide says.
  proof({ a, b, poseA, poseB, tolerance, solid, apart }) {
    const [one, other] = [parts.get(a), parts.get(b)];
    const how = { poseA, poseB, solid, certificate: true };
    return apart ? snug.distance(one, other, { ...how, absolute: tolerance }).certificate
                 : snug.collide(one, other, { ...how, tolerance, measure: true, proveContact: true }).certificate;
  },
  shape: ({ part, ...how }) => shapeOf(parts.get(part), how),
  enclosures: ({ part, level }) => parts.get(part).enclosureShapes({ level }),
  hulls({ part, tolerance }) {
    const hulls = parts.get(part).hull({ error: tolerance });
    const drawn = (hull) =>
      hull && { positions: Float32Array.from(hull.positions), triangles: hull.triangles, gap: hull.gap };
    return { ...hulls, inner: drawn(hulls.inner), outer: drawn(hulls.outer) };
  },
  depth: ({ a, b, poseA, poseB }) => snug.penetration(parts.get(a), parts.get(b), { poseA, poseB }),
  pose: ({ steps }) => snug.pose(steps),
};

self.onmessage = async ({ data }) => {
  const { id, op, ...rest } = data;
  try {
    self.postMessage({ id, result: await operations[op](rest) });
  } catch (error) {
    const broken = error.name !== "SnugError";
    self.postMessage({ id, fault: broken ? `snug stopped: ${error.message}` : error.message, broken });
  }
};
