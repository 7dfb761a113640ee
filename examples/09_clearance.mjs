// A part flies past another one: how near does it come, and when? Bounds for every time, not at samples.
//
//   node 09_clearance.mjs A B

import { readFile } from "node:fs/promises";
import Snug from "snug-surfaces";

const snug = await Snug();
const [a, b] = await Promise.all(process.argv.slice(2, 4).map(async (file) => snug.read(file, await readFile(file))));
const size = Math.max(a.size, b.size);
const path = [-2, 0, 2].map((x, i) => snug.pose({ degrees: 120 * i, move: [x * size, 1.35 * size, 0] }));
const room = snug.clearance(a, b, { motionB: path, absolute: 0.01 * size });
console.log(`never closer than ${snug.textAtMost(room.distance[0])}, at time ${room.time.toFixed(3)} at most ${snug.textAtLeast(room.distance[1])} apart`);
for (const { time, distance } of room.spans) console.log(`  from ${time[0].toFixed(3)} to ${time[1].toFixed(3)}: at least ${snug.textAtMost(distance[0])}`);
const { verdict, time } = snug.timeOfContact(a, b, { motionB: path, margin: 2 * room.distance[1] });
console.log(`${verdict}: not within twice that before time ${snug.textAtMost(time[0])}`);
