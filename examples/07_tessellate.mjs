// Triangles within a proved distance of the limit surface, for three.js: made in a worker, which may be stopped.
//
//   node 07_tessellate.mjs MESH

import { readFile } from "node:fs/promises";
import SnugWorker from "snug-surfaces/worker";

const snug = SnugWorker();
const file = process.argv[2];
const surface = await snug.read(file, await readFile(file));
const stop = AbortSignal.timeout(60_000);
for (const share of [0.02, 0.005, 0.001]) {
  const { positions, normals, triangles, errorBound } = await surface.tessellate({ error: share * surface.size, signal: stop });
  // In a page: geometry.setAttribute("position", new BufferAttribute(Float32Array.from(positions), 3)), the same with
  // "normal" and normals, and geometry.setIndex(new BufferAttribute(triangles, 1)).
  console.log(`${triangles.length / 3} triangles of ${positions.length / 3} points with normals (${normals.length / 3}), error at most ${errorBound.toPrecision(3)}`);
}
await surface.delete();
await snug.close();
