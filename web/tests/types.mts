// Compiles if snug.d.ts has the types that people use; package.mjs calls what is declared.

import Snug, { SnugError, type Collision, type Interval, type Surface } from "../package/snug.js";

const snug = await Snug();
const a: Surface = snug.read("a.obj", "v 0 0 0");
const b: Surface = snug.read("b.ply", new Uint8Array(3), { scheme: "catmark", sharp: 30 });
const hit: Collision = snug.collide(a, b, { poseB: snug.pose({ degrees: 30 }), solid: true });
const gap: Interval = snug.distance(a, b, { relative: 1e-3 }).distance;
const normal: readonly number[] | null | undefined = hit.witnessAt?.[0]?.normal;
const box: Surface = snug.fromArrays({ points: new Float64Array(12), triangles: [0, 1, 2, 0, 2, 3], creases: [0, 1, 10] }, { scheme: "loop" });
const first: number | undefined = box.ray([0, 0, 9], [0, 0, -1], { query: "all" }).hits[0]?.t[0];
const when: Interval = snug.timeOfContact(a, box, { motionB: [snug.pose({ move: [0, 0, 1] }), snug.pose({})] }).time;
const faces: Uint32Array | undefined = snug.contacts(a, b, { within: 0.1 }).regions[0]?.owners[1];
const centroid: Interval | undefined = a.measure().centroid?.[2];
const inside: boolean | null = a.contains([0, 0, 0]);
const positions: Float32Array = a.samples(2).positions;
// @ts-expect-error: there is no such verdict
const wrong: boolean = hit.verdict === "touching";
// @ts-expect-error: nor such a scheme
snug.read("c.obj", "", { scheme: "butterfly" });
export { centroid, faces, first, inside, when, gap, normal, positions, wrong, SnugError };
