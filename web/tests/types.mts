// Compiles if snug.d.ts has the types that people use; package.mjs calls what is declared.

import SnugWorker, { type Robot as RobotInWorker, type Surface as SurfaceInWorker } from "../package/worker.js";
import Snug, { SnugError, type Collision, type Interval, type LinkContact, type Robot, type Surface } from "../package/snug.js";

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
const room: Interval = snug.clearance(a, b, { motionB: [snug.pose({ move: [0, 0, 1] }), snug.pose({})], progress: (done) => done < 1 }).spans[0].distance;
const verdicts: Uint8Array = snug.collideMany(a, b, new Float64Array(12), { tolerance: 0.1 }).verdicts;
const bytes: Uint8Array = a.write("a.ply");
const later = SnugWorker();
const remote: SurfaceInWorker = await later.read("a.obj", "v 0 0 0");
const drawn: Float64Array = (await remote.tessellate({ error: 0.1, signal: AbortSignal.timeout(1), progress: () => {} })).positions;
const verdict: string = (await later.collide(remote, remote, { signal: new AbortController().signal })).verdict;
const parts = snug.readAssembly("a.gltf", "", { files: { "a.bin": new Uint8Array(3) } });
const together: number = snug.collideScene(parts, { tolerance: 0.1, pairs: [0, 1] }).results[0].a;
const apart: Interval = snug.distanceScene([{ surface: a }], 1).results[0].distance;
const arm: Robot = snug.urdf("arm.urdf", "", { files: (path) => path });
const meeting: LinkContact = arm.firstContacts([{ elbow: 1 }, {}], { joined: true })[0];
const there = await later.readAssembly("a.3mf", new Uint8Array(3));
const counted: number = (await later.collideScene(there, { signal: AbortSignal.timeout(1) })).within;
const arm_there: RobotInWorker = await later.urdf("arm.urdf", "");
const frame: string = (await arm_there.firstContacts([{}], { progress: () => {} }))[0].frame;
// @ts-expect-error: a surface of a worker is another one
snug.collide(remote, b);
// @ts-expect-error: there is no such verdict
const wrong: boolean = hit.verdict === "touching";
// @ts-expect-error: nor such a scheme
snug.read("c.obj", "", { scheme: "butterfly" });
export { together, apart, meeting, counted, frame, bytes, drawn, room, verdict, verdicts, centroid, faces, first, inside, when, gap, normal, positions, wrong, SnugError };
