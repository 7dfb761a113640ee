// The package: node --test web/tests/package.mjs, with SNUG (the native command) and SNUG_PACKAGE (its folder).
// What it answers is held against the native command, bit by bit.

import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, extname, join, resolve } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { compare, holdAll } from "../../tests/doors/answers.mjs";
import { linesOf } from "../../tests/doors/ask.mjs";

const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
const command = resolve(process.env.SNUG ?? join(root, "build/release/bin/snug"));
const folder = resolve(process.env.SNUG_PACKAGE ?? join(root, "build/web/package"));
const models = join(root, "examples/models");
const { default: Snug, SnugError } = await import(pathToFileURL(join(folder, "snug.js")));

// By SNUG_SIMD, 1 or 0, the module with vectors or the plain one.
const simd = process.env.SNUG_SIMD === undefined ? undefined : process.env.SNUG_SIMD === "1";
const snug = await Snug({ simd });
const scratch = mkdtempSync(join(tmpdir(), "snug-"));
after(() => rmSync(scratch, { recursive: true }));

const model = (name, options) => snug.read(name, readFileSync(join(models, name)), options);

// The same numbers in every run.
let seed = 12345n;
const random = () => {
  seed = (seed * 6364136223846793005n + 1442695040888963407n) & 0xffffffffffffffffn;
  return Number(seed >> 11n) / 2 ** 53;
};
const centred = (size) => (random() - 0.5) * size;

// A JSON document of the command, whatever it ends with.
const ask = (...words) => JSON.parse(spawnSync(command, [...words, "--json", "--quiet"], { maxBuffer: 1 << 30, encoding: "utf8" }).stdout);

test("says that the pin is clear of the bracket, and by how much", () => {
  const [bracket, pin] = [model("bracket.obj"), model("pin.obj")];
  const poseB = snug.pose({ axis: [0, 0, 1], degrees: 135, move: [0.05, 0.05, 0.5] });
  assert.equal(snug.collide(bracket, pin, { poseB }).verdict, "separated");
  const { distance, outcome } = snug.distance(bracket, pin, { poseB, relative: 1e-3 });
  assert.equal(outcome, "complete");
  assert.ok(0.205 < distance[0] && distance[1] < 0.2054 && distance[1] - distance[0] <= 1e-3 * distance[1], `${distance}`);
  assert.equal(snug.textAtMost(1 / 3), "0.333333");
  assert.equal(snug.textAtLeast(2 / 3), "0.666667");
  const inner = snug.pose({ degrees: -45, move: [1.06, 1.06, 0.5] });
  assert.equal(snug.collide(bracket, pin, { poseB: inner, proveContact: true }).verdict, "intersecting");
});

// Poses far and near, turned by any angle and by right ones, in steps where parts of one lattice have many equal distances.
function poses(size, count) {
  return Array.from({ length: count }, (_, i) => {
    if (i % 7 === 0) return snug.pose({ move: [[size, 0, 0], [0, 0, 0], [0, 0, size / 2], [0, size, 0]][i % 4] });
    const degrees = i % 3 === 0 ? 90 * Math.floor(4 * random()) : 360 * random();
    const move = [0, 1, 2].map(() => (i % 5 === 0 ? (Math.round(centred(8)) / 4) * size : centred(2 * size)));
    return snug.pose({ axis: [centred(1), centred(1), centred(1)], degrees, move });
  });
}

const places = (list) => list && list.map((at) => at && [at.face ?? at.vertex ?? at.owner, at.corner ?? 0, at.u, at.v, at.normal, at.normal_error ?? at.normalError ?? null]);
const finite = (distance) => distance.map((x) => (x === Infinity ? null : x));
const native_bits = (r) => [r.verdict ?? r.outcome, r.distance, r.witness, r.witness_error, places(r.witness_at), Object.values(r.stats)];
const own_bits = (r) => [r.verdict ?? r.outcome, finite(r.distance), r.witness, r.witnessError, places(r.witnessAt), Object.values(r.stats)];

test("proves what the native library proves, letter by letter", () => {
  const [bracket, pin] = [model("bracket.obj"), model("pin.obj")];
  const proof = join(scratch, "proof.txt");
  // As the command asks.
  const of_command = { distance: {}, collide: { measure: true, proveContact: true } };
  for (const [question, move] of [["distance", [0.05, 0.05, 0.5]], ["collide", [0, 0, 0.5]], ["collide", [9, 0, 0]]]) {
    const poseB = snug.pose({ move });
    const { certificate } = snug[question](bracket, pin, { poseB, certificate: true, ...of_command[question] });
    ask(question, join(models, "bracket.obj"), join(models, "pin.obj"), "--place-b", poseB.join(" "), "--certificate", proof);
    assert.equal(certificate.missing, "");
    assert.equal(certificate.text, readFileSync(proof, "utf8"));
    execFileSync(join(dirname(command), "snug-check"), [proof]);
  }
  assert.equal(snug.distance(bracket, pin).certificate, undefined);
});

test("gives the bits of the native library to 1120 questions", () => {
  const pairs = [["bracket.obj", "pin.obj"], ["pawn.obj", "bust.obj"], ["star.obj", "ring.obj"], ["ring.obj", "ring.obj"], ["bracket.obj", "bracket.obj"],
    ["head.obj", "figure.obj"], ["bracket.obj", "pin.obj", "doo-sabin"], ["star.obj", "ring.obj", "flat"]];
  const file = join(scratch, "poses.txt");
  const verdicts = new Set();
  let asked = 0;
  for (const [name_a, name_b, scheme] of pairs) {
    const [a, b] = [model(name_a, { scheme: scheme ?? "auto" }), model(name_b, { scheme: scheme ?? "auto" })];
    const list = poses(Math.max(a.size, b.size), 70);
    writeFileSync(file, list.map((pose) => pose.join(" ")).join("\n") + "\n");
    for (const question of ["collide", "distance"]) {
      const document = ask(question, join(models, name_a), join(models, name_b), "--poses", file, ...(scheme ? ["--scheme", scheme] : []));
      assert.equal(document.results.length, list.length);
      document.results.forEach((native, i) => {
        const own = question === "collide" ? snug.collide(a, b, { poseB: list[i], tolerance: document.tolerance, measure: true, proveContact: true })
          : snug.distance(a, b, { poseB: list[i], absolute: document.absolute });
        // Strict equality tells 0 from -0, and any two doubles.
        assert.deepStrictEqual(own_bits(own), native_bits(native), `${question} ${name_a} ${name_b} ${scheme ?? ""}, pose ${i}`);
        verdicts.add(own.verdict);
        ++asked;
      });
    }
  }
  assert.equal(asked, 1120);
  for (const verdict of ["separated", "within", "intersecting"]) assert.ok(verdicts.has(verdict), verdict);
});

test("makes the motions of the native library", () => {
  const [a, b] = [join(models, "star.obj"), join(models, "ring.obj")];
  for (let i = 0; i < 60; ++i) {
    const axis = [centred(1), centred(1), centred(1)];
    const degrees = i < 12 ? 15 * i : centred(2000);
    const document = ask("collide", a, b, "--rotate-b", [...axis, degrees].join(" "), "--move-b", "0.1 0.2 9");
    assert.deepStrictEqual(snug.pose({ axis, degrees, move: [0.1, 0.2, 9] }), document.place_b);
  }
});

test("reads numbers exactly", () => {
  const numbers = ["0.1", "1e-320", "4.9e-324", "2.4703282292062327e-324", "2.4703282292062328e-324", "1.7976931348623157e308", "-0", "123456789012345678901234567890",
    "9007199254740993", "0.500000000000000166533453693773481063544750213623046875", "1.00000000000000011102230246251565404236316680908203125", "1e-400", ".5", "5.", "1E3"];
  for (let i = 0; i < 5000; ++i) numbers.push(`${Math.floor(random() * 1e15)}${Math.floor(random() * 1e9)}e${Math.floor(centred(600))}`.replace(/e(\d+)/, (all, e) => (Number(e) > 280 ? "" : all)));
  const text = numbers.map((n) => `v ${n} 0 0\n`).join("") + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n";
  const read = snug.read("numbers.obj", text).cage().points;
  numbers.forEach((n, i) => assert.ok(Object.is(read[3 * i], Number(n)), `${n}: ${read[3 * i]}`));
});

test("writes numbers as the native library does", () => {
  const star = model("star.obj");
  for (const [x, written] of [[-1, "-1"], [-0.0001, "-1e-04"], [-0.001, "-0.001"], [-0.00001, "-1e-05"], [-1e22, "-1e+22"], [-100000, "-1e+05"], [-123456, "-123456"], [-1.5e300, "-1.5e+300"],
    [-12345678901234567890, "-12345678901234567168"], [-0.1, "-0.1"], [NaN, "nan"], [Infinity, "inf"], [-4.9e-324, "-5e-324"], [-0.30000000000000004, "-0.30000000000000004"]]) {
    assert.throws(() => snug.collide(star, star, { tolerance: x }), (error) => {
      assert.ok(error instanceof SnugError);
      assert.equal(error.problem, "value");
      assert.equal(error.message, `collide: the tolerance is ${written}: give a finite number that is not negative`);
      return true;
    });
  }
});

function* filesOf(place) {
  for (const name of readdirSync(place)) {
    const path = join(place, name);
    if (statSync(path).isDirectory()) yield* filesOf(path);
    else yield path;
  }
}

test("refuses what the command refuses, in the same words", () => {
  let refused = 0, read = 0;
  for (const path of filesOf(join(root, "tests/corpus"))) {
    if (![".obj", ".off", ".ply", ".stl", ".txt", ""].includes(extname(path))) continue;
    const native = spawnSync(command, ["bound", path, "--quiet", "-o", join(scratch, "bound.json")], { encoding: "utf8" });
    let message = "";
    try {
      snug.read(path, readFileSync(path)).delete();
      ++read;
    } catch (error) {
      assert.ok(error instanceof SnugError, `${path}: ${error.stack}`);
      message = error.message;
      ++refused;
    }
    if (native.status === 0 || native.status === 5) assert.equal(message, "", path);
    else assert.equal(message, native.stderr.trim().replace(/^snug: /, ""), path);
  }
  assert.ok(refused > 20 && read > 5, `${refused} refused, ${read} read`);
});

test("has no sums that 32 bits cut off", () => {
  // 50 bytes for each of these facets are the same as for none, modulo 2^32.
  const bytes = new Uint8Array(84);
  new DataView(bytes.buffer).setUint32(80, 2 ** 31, true);
  assert.throws(() => snug.read("a.stl", bytes), { message: "a.stl: the file declares 2147483648 facets, which take 107374182484 bytes, but has 84" });
});

test("draws, bounds and measures", () => {
  const pawn = model("pawn.obj");
  const samples = pawn.samples(2);
  assert.equal(samples.positions.length, samples.normals.length);
  assert.ok(samples.triangles.every((i) => i < samples.positions.length / 3));
  for (const name of ["bracket.obj", "star.obj", "pin.obj"]) {
    // Points of the lattice are on the surface, for quads and triangles alike.
    const surface = model(name);
    const { positions } = surface.samples(1);
    for (let i = 0; i < positions.length; i += 30) {
      const { distance } = surface.closestPoint([...positions.subarray(i, i + 3)], { absolute: 1e-6 });
      assert.ok(distance[0] < 1e-6, `${name}: ${distance}`);
    }
  }
  const triangles = pawn.tessellate({ error: 0.01 * pawn.size });
  assert.ok(triangles.outcome === "complete" && triangles.errorBound <= 0.01 * pawn.size);
  const shapes = pawn.enclosureShapes({ level: 1 });
  assert.equal(shapes.positions.length % 9, 0);
  assert.ok(shapes.count > 100);
  const ring = model("ring.obj");
  assert.equal(ring.scheme, "loop");
  const hulls = ring.hull({ error: 0.03 * ring.size });
  assert.ok(hulls.outcome === "complete" && hulls.outer.gap <= 0.03 * ring.size);
  const { area, volume } = ring.measure({ relative: 0.01 });
  const native = ask("measure", join(models, "ring.obj"), "--relative", "0.01");
  assert.deepStrictEqual([area, volume], [native.area, native.volume]);
  assert.ok(ring.limitToFaces() > 0);
  const inside = snug.penetration(ring, ring, { poseB: snug.pose({ move: [0.05, 0, 0] }) });
  assert.ok(inside.depth[0] <= inside.depth[1]);
});

test("makes surfaces of arrays", () => {
  for (const [name, scheme] of [["star.obj", "auto"], ["bracket.obj", "auto"], ["pawn.obj", "doo-sabin"]]) {
    const read = model(name, { scheme }), { points, offsets, corners } = read.cage();
    const made = snug.fromArrays({ points, offsets, corners }, { scheme });
    assert.equal(made.scheme, read.scheme);
    assert.deepStrictEqual(made.measure(), read.measure());
    made.delete();
  }
  const box = { points: [0, 1, 2, 3, 4, 5, 6, 7].flatMap((k) => [4 * (k & 1), k & 2, (k & 4) / 4]),
    triangles: [0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5] };
  const volume = (surface) => surface.measure().volume;
  const smooth = snug.fromArrays(box), facets = snug.fromArrays(box, { scheme: "flat" });
  assert.equal(smooth.scheme, "loop");
  assert.match(smooth.notes[0], /^arrays: triangles taken as the control mesh of a Loop surface/);
  assert.ok(volume(facets)[0] <= 8 && 8 <= volume(facets)[1] && facets.notes.length === 0);
  const edges = new Set(box.triangles.flatMap((v, i) => [[v, box.triangles[i - (i % 3) + ((i + 1) % 3)]].sort().join(" ")]));
  const creases = [...edges].flatMap((edge) => [...edge.split(" ").map(Number), 10]);
  assert.ok(Math.abs(volume(snug.fromArrays({ ...box, creases }))[0] - 8) < 1e-3);
  assert.ok(volume(snug.fromArrays({ ...box, creases: creases.map((x, i) => (i % 3 === 2 ? 1 : x)) }))[1] < 7.9);
  const { throws } = assert;
  throws(() => snug.fromArrays({ points: box.points }), { problem: "value", message: "give either triangles, or offsets and corners" });
  throws(() => snug.fromArrays({ ...box, points: [1, 2] }), { problem: "value", message: /^points: give 3 numbers each; 2 are not a multiple/ });
  throws(() => snug.fromArrays({ ...box, triangles: [0, 1, -1] }), { problem: "value", message: /^triangles: give whole numbers/ });
  throws(() => snug.fromArrays({ ...box, triangles: [0, 1, 0.5] }), { problem: "value" });
  throws(() => snug.fromArrays({ ...box, triangles: [0, 1, 99] }), { problem: "refused", message: /^arrays: / });
  throws(() => snug.fromArrays({ points: box.points, offsets: [0, 4, 2], corners: [0, 1, 2, 3] }), { problem: "value", message: /^offsets: / });
  throws(() => snug.fromArrays({ points: box.points, offsets: [0, 4], corners: [0, 1, 2] }), { problem: "value" });
});

test("takes the geometries of three.js", async () => {
  const { BoxGeometry, SphereGeometry } = await import(pathToFileURL(join(root, "web/node_modules/three/build/three.module.js")));
  const box = snug.fromGeometry(new BoxGeometry(4, 2, 1));
  assert.equal(box.scheme, "flat");
  const [lower, upper] = box.measure().volume;
  assert.ok(lower <= 8 && 8 <= upper);
  assert.equal(box.contains([1.9, 0.9, 0.4]), true);
  assert.equal(box.contains([2.1, 0, 0]), false);
  const [least, most] = snug.fromGeometry(new BoxGeometry(4, 2, 1).toNonIndexed()).measure().volume;
  assert.ok(least <= 8 && 8 <= most);
  assert.equal(snug.fromGeometry(new SphereGeometry(1, 8, 6), { weld: 1e-9 }).contains([0.1, 0.2, 0.3]), true);
  assert.ok(snug.fromGeometry(new BoxGeometry(1, 1, 1), { scheme: "loop" }).measure().volume[1] < 0.9);
  assert.throws(() => snug.fromGeometry({}), TypeError);
});

test("makes envelopes, deviations and points that fit each other", () => {
  const pin = model("pin.obj"), around = pin.envelope({ error: 0.05 * pin.size });
  assert.ok(around.outcome === "complete" && around.positions.length % 3 === 0 && around.triangles.length > 30 && around.clearance === around.error / 4);
  const triangles = pin.tessellate({ error: 0.01 * pin.size });
  const apart = snug.deviation(pin, triangles, { absolute: 1e-3 * pin.size });
  assert.ok(apart.outcome === "complete" && apart.fromSurface.distance[1] <= triangles.errorBound * 1.001 + 1e-3 * pin.size);
  assert.deepStrictEqual([apart.verdict, snug.deviation(pin, triangles, { threshold: 0 }).verdict], [null, "exceeds"]);
  assert.throws(() => snug.deviation(pin, { positions: [0, 0, 0], triangles: [0, 1, 2] }), { problem: "value" });
  assert.throws(() => snug.deviation(pin), { problem: "value", message: /give a Surface, or positions and triangles/ });
  for (const ask of [() => pin.closestPoint(), () => pin.contains(), () => pin.ray([0, 0, 0])]) assert.throws(ask, { problem: "value", message: /: give three numbers$/ });
  const other = snug.deviation(pin, model("pin.obj"), { threshold: 1e-3 * pin.size });
  assert.ok(other.verdict === "within" && other.fromSurface.distance[0] === 0);
  assert.ok(pin.envelope({ error: 0.05 * pin.size, gap: 0.2 * pin.size }).outcome === "complete");
  const far = pin.tessellate({ view: { eye: [0, 0, 50 * pin.size], angle: 0.05 } }), near = pin.tessellate({ view: { eye: [0, 0, 5 * pin.size], angle: 0.05 } });
  assert.ok(far.triangles.length < near.triangles.length && pin.tessellate({ maxThickness: 0.05 * pin.size }).triangles.length > 30);
  assert.throws(() => pin.selfContact({ levels: -1 }), { problem: "value" });
  assert.throws(() => snug.timeOfContact(pin, pin, { motionB: [] }), { problem: "value", message: "motionB: give a list of poses" });
  const there = pin.evaluate({ owner: 3, corner: 0, u: 0.25, v: 0.5 });
  assert.ok(pin.closestPoint(there.point, { absolute: 1e-9 }).distance[0] <= 1e-9 && there.normal.length === 3);
  const { axes, angles, count } = pin.enclosures({ normals: true });
  assert.ok(axes.length === 3 * count && angles.some((angle) => angle > 0) && pin.enclosures().axes === undefined);
});

test("gives the digits of the native library to questions of every kind", () => {
  const counts = holdAll(snug, linesOf(command, scratch), (path) => readFileSync(path));
  assert.ok(Object.keys(counts).length === 21 && Object.values(counts).every((n) => n >= 10), JSON.stringify(counts));
});

test("answers about many poses at once as one by one, and in time", () => {
  const [bracket, pin] = [model("bracket.obj"), model("pin.obj")], list = poses(Math.max(bracket.size, pin.size), 1000), posesB = Float64Array.from(list.flat());
  const words = ["separated", "within", "intersecting", "undecided"];
  const found = snug.collideMany(bracket, pin, posesB);
  // Of this process, whoever else uses the machine: the median of five.
  const milliseconds = (poses) => Array.from({ length: 5 }, () => {
    const before = process.cpuUsage();
    snug.collideMany(bracket, pin, poses);
    const { user, system } = process.cpuUsage(before);
    return (user + system) / 1000;
  }).sort((a, b) => a - b)[2];
  const far = milliseconds(posesB);
  const apart = snug.distanceMany(bracket, pin, posesB);
  list.slice(0, 100).forEach((poseB, i) => {
    const one = snug.collide(bracket, pin, { poseB });
    assert.deepStrictEqual([words[found.verdicts[i]], [found.lower[i], found.upper[i]]], [one.verdict, one.distance]);
    assert.deepStrictEqual([apart.lower[i], apart.upper[i]], snug.distance(bracket, pin, { poseB }).distance);
  });
  assert.ok(far < 500);
  // Near ones: moved along the shortest way until a thousandth to a hundredth of the size is left, or as much overlap.
  const near = list.map((poseB, i) => {
    const { distance, witness: [a, b] } = snug.distance(bracket, pin, { poseB });
    const left = (((i % 20) - 10) / 1000) * bracket.size, share = distance[1] > 0 ? 1 - left / distance[1] : 0;
    return snug.pose({ after: poseB, move: a.map((x, k) => share * (x - b[k])) });
  });
  const nearB = Float64Array.from(near.flat());
  const close = milliseconds(nearB);
  console.log(`1,000 collide queries in ${far.toFixed(1)} ms, near ones in ${close.toFixed(1)}`);
  assert.ok(close < 1000);
  const verdicts = snug.collideMany(bracket, pin, nearB).verdicts;
  assert.ok(verdicts.filter((verdict) => verdict === 0).length > 200 && verdicts.filter((verdict) => verdict === 1 || verdict === 2).length > 400);
  assert.throws(() => snug.collideMany(bracket, pin, [1, 2, 3]), { problem: "pose" });
});

test("inspects and writes meshes", () => {
  const bow = { points: [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0], triangles: [0, 1, 2, 1, 0, 3, 0, 1, 4] };
  const seen = snug.inspect(bow, { scheme: "flat" });
  assert.ok(seen.manySidedEdges === 1 && seen.scheme === "flat" && seen.defects.some(({ kind }) => kind === "edge-of-many-faces") && seen.coincidences.vertices > 0);
  for (const name of ["a.obj", "a.ply", "a.usda"]) {
    const bracket = model("bracket.obj"), again = snug.read(name, bracket.write(name));
    assert.deepStrictEqual(again.cage(), bracket.cage());
    assert.equal(again.scheme, bracket.scheme);
  }
  assert.throws(() => model("bracket.obj").write("a.fbx"), { problem: "unreadable" });
});

test("writes STEP files as the native library does", () => {
  const file = join(scratch, "part.step"), bracket = model("bracket.obj");
  const native = ask("convert", join(models, "bracket.obj"), "-o", file, "--error", String(1e-3 * bracket.size));
  const own = bracket.step({ error: 1e-3 * bracket.size, name: "bracket" });
  assert.deepStrictEqual([own.errorBound, own.gapBound, own.faces, own.spans], [native.error_bound, native.gap_bound, native.faces, native.spans]);
  const data = (text) => text.slice(text.indexOf("DATA;"));
  assert.equal(data(own.text).length, data(readFileSync(file, "utf8")).length);
  assert.throws(() => bracket.step({ units: "ell" }), { problem: "value" });
});

test("tells progress, and ends where that says so", () => {
  const bust = model("bust.obj"), done = [];
  bust.tessellate({ error: 0.001 * bust.size, progress: (share) => void done.push(share) });
  assert.ok(done.length > 0 && done.every((share) => share >= 0 && share <= 1));
  assert.throws(() => bust.tessellate({ error: 0.0001 * bust.size, progress: () => false }), { name: "SnugError", problem: "interrupted" });
});

// Three links of a box each in a row along x; joints turn about z.
const arm_text = (() => {
  const link = (name) => `<link name="${name}"><collision><origin xyz="0.5 0 0"/><geometry><mesh filename="package://arm/box.obj"/></geometry></collision></link>`;
  const joint = (name, a, b) => `<joint name="${name}" type="revolute"><parent link="${a}"/><child link="${b}"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/><limit lower="-3.2" upper="3.2"/></joint>`;
  return `<robot name="arm">${["base", "upper", "lower"].map(link).join("")}${joint("shoulder", "base", "upper")}${joint("elbow", "upper", "lower")}</robot>`;
})();
const box_text = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => `v ${k & 1 ? 0.45 : -0.45} ${k & 2 ? 0.1 : -0.1} ${k & 4 ? 0.1 : -0.1}\n`).join("") + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

test("moves robots as the native library does", () => {
  const files = { "arm/box.obj": box_text }, arm = snug.urdf("arm.urdf", arm_text, { files });
  mkdirSync(join(scratch, "arm"));
  writeFileSync(join(scratch, "arm/box.obj"), box_text);
  writeFileSync(join(scratch, "arm.urdf"), arm_text);
  writeFileSync(join(scratch, "moves.txt"), "shoulder elbow\n0 0\n1.25 1.25\n2.5 2.5\n");
  const native = ask("scene", join(scratch, "arm.urdf"), "--package", scratch, "--path", join(scratch, "moves.txt"), "--joined").results;
  const path = [0, 1.25, 2.5].map((x) => ({ shoulder: x, elbow: x })), own = arm.firstContacts(path, { joined: true });
  assert.deepStrictEqual([arm.name, arm.links, arm.joints, arm.outward], ["arm", ["base", "upper", "lower"], { shoulder: [-3.2, 3.2], elbow: [-3.2, 3.2] }, 0]);
  assert.equal(own.length, 3);
  own.forEach((each, i) => assert.ok(compare(each, native[i], `pair ${i}`) >= 10));
  assert.ok(own.some(({ verdict, time }) => verdict === "intersecting" && time[0] > 1));
  assert.equal(arm.firstContacts(path).length, 1);
  const near = ask("scene", join(scratch, "arm.urdf"), "--package", scratch, "--path", join(scratch, "moves.txt"), "--margin", "0.05").results;
  assert.ok(compare(arm.firstContacts(path, { tolerance: 1e-3 * 0.9, margin: 0.05 })[0], near[0], "margin") >= 10 && near[0].verdict === "within");
  const [r0, , , x] = arm.poses({ shoulder: Math.PI / 2 }).lower;
  assert.ok(Math.abs(r0) < 1e-12 && Math.abs(x - 1) < 1e-12);
  const { throws } = assert;
  throws(() => arm.poses({ knee: 1 }), { problem: "value", message: /no joint is called 'knee'/ });
  throws(() => arm.firstContacts([]), { problem: "value" });
  throws(() => snug.urdf("arm.urdf", arm_text), { problem: "unreadable", message: /arm\/box.obj: this file is not among/ });
  throws(() => snug.urdf("arm.urdf", arm_text.replace("package://arm", "..").replace("/box", "/../box"), { files: () => box_text }), { problem: "unreadable", message: /leads out/ });
  const apart = snug.urdf("arm.urdf", arm_text, { files: () => Buffer.from(box_text), srdf: '<robot name="arm"><disable_collisions link1="base" link2="lower"/></robot>' });
  assert.equal(apart.firstContacts(path).length, 0);
  arm.delete();
  throws(() => arm.poses(), TypeError);
});

// Two squares, one of them twice, as text of USD.
const mesh_text = (name, x) => `def Mesh "${name}" { int[] faceVertexCounts = [4]\n int[] faceVertexIndices = [0, 1, 2, 3]\n point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
  double3 xformOp:translate = (${x}, 0, 0)\n uniform token[] xformOpOrder = ["xformOp:translate"] }\n`;
const parts_text = `#usda 1.0\n${mesh_text("left", 0)}${mesh_text("middle", 1.5)}${mesh_text("right", 4)}`;

test("asks all pairs of the parts of a file", () => {
  const parts = snug.readAssembly("parts.usda", parts_text, { scheme: "bilinear" });
  assert.deepStrictEqual(parts.map(({ name, pose }) => [name, pose[3]]), [["left", 0], ["middle", 1.5], ["right", 4]]);
  const near = snug.collideScene(parts, { margin: 1, measure: true });
  assert.deepStrictEqual([near.pairs, near.separatedByBoxes, near.intersecting, near.results.map(({ a, b }) => [a, b])], [3, 2, 0, [[0, 1]]]);
  const [{ a, b, ...answer }] = near.results, [left, middle] = parts;
  assert.deepStrictEqual(answer, snug.collide(left.surface, middle.surface, { poseB: middle.pose, margin: 1, measure: true }));
  const apart = snug.distanceScene(parts, 2, { absolute: 1e-6 });
  assert.deepStrictEqual(apart.results.map(({ a, b, distance }) => [a, b, Math.round(1000 * distance[1])]), [[0, 1, 500], [1, 2, 1500]]);
  assert.deepStrictEqual(snug.distanceScene(parts, 9, { pairs: [0, 2] }).results.length, 1);
  assert.equal(snug.collideScene(parts, { margins: [0, 2, 4] }).within, 1);
  assert.throws(() => snug.collideScene(parts, { pairs: [0, 9] }), { problem: "value" });
  assert.throws(() => snug.collideScene(parts, { pairs: [0, 1, 2] }), { problem: "value" });
  const buffer = new Uint8Array(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]).buffer);
  const gltf = JSON.stringify({ asset: { version: "2.0" }, buffers: [{ uri: "a.bin", byteLength: 36 }], bufferViews: [{ buffer: 0, byteLength: 36 }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 3, type: "VEC3", min: [0, 0, 0], max: [1, 1, 0] }], meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
    nodes: [{ mesh: 0, name: "one" }, { mesh: 0, name: "two", translation: [0, 0, 3] }], scenes: [{ nodes: [0, 1] }], scene: 0 });
  const twice = snug.readAssembly("a.gltf", gltf, { files: { "a.bin": buffer } });
  assert.ok(twice.length === 2 && twice[0].surface === twice[1].surface && twice[1].pose[11] === 3);
  assert.throws(() => snug.read("a.gltf", gltf), { problem: "unreadable", message: /a.bin: this file is not among/ });
});

test("works in a worker, with promises, progress and an end on request", async () => {
  const { default: SnugWorker } = await import(pathToFileURL(join(folder, "worker.js")));
  const later = SnugWorker(), file = readFileSync(join(models, "bust.obj"));
  const bust = await later.read("bust.obj", file), pin = await later.read("pin.obj", readFileSync(join(models, "pin.obj")));
  const own = snug.read("bust.obj", file);
  assert.deepEqual([bust.size, bust.scheme, bust.boundary, bust.notes], [own.size, own.scheme, own.boundary, own.notes]);
  const done = [];
  const [drawn, hit] = await Promise.all([bust.tessellate({ error: 0.01 * bust.size, progress: (share) => done.push(share) }), later.collide(bust, pin, { measure: true })]);
  assert.deepStrictEqual(drawn, own.tessellate({ error: 0.01 * own.size }));
  assert.deepStrictEqual(hit, snug.collide(own, model("pin.obj"), { measure: true }));
  assert.ok(done.length > 0);
  await assert.rejects(bust.tessellate({ error: -1 }), (error) => error instanceof SnugError && error.problem === "value");
  await assert.rejects(later.read("a.obj", "v 0"), (error) => error instanceof SnugError && error.problem === "unreadable");
  // What is long is ended at once; surfaces and what else was asked live on.
  const start = performance.now(), signal = AbortSignal.timeout(300);
  const ended = assert.rejects(later.deviation(bust, drawn, { absolute: 1e-9 * bust.size, signal }), { name: "TimeoutError" });
  const measured = bust.measure();
  await ended;
  assert.ok(performance.now() - start < 3000);
  assert.deepStrictEqual(await measured, own.measure());
  assert.deepStrictEqual(await later.distance(bust, pin), snug.distance(own, model("pin.obj")));
  await assert.rejects(later.distance(bust, pin, { signal: AbortSignal.abort() }), { name: "AbortError" });
  const parts = await later.readAssembly("parts.usda", parts_text, { scheme: "bilinear" }), here = snug.readAssembly("parts.usda", parts_text, { scheme: "bilinear" });
  assert.deepStrictEqual(await later.collideScene(parts, { margin: 1 }), snug.collideScene(here, { margin: 1 }));
  const arm = await later.urdf("arm.urdf", arm_text, { files: { "arm/box.obj": box_text } });
  assert.deepEqual([arm.name, arm.links], ["arm", ["base", "upper", "lower"]]);
  assert.equal((await arm.firstContacts([{}, { shoulder: 1 }]))[0].verdict, "separated");
  await assert.rejects(later.urdf("arm.urdf", arm_text, { files: () => box_text }), TypeError);
  await bust.delete();
  await assert.rejects(bust.measure());
  await later.close();
  await assert.rejects(later.pose({}), /closed/);
});

test("shares poses out to several workers, with the bits of one", async () => {
  const { default: SnugWorker } = await import(pathToFileURL(join(folder, "worker.js")));
  const several = SnugWorker({ threads: 3, simd }), names = ["bracket.obj", "pin.obj"];
  const own = names.map((name) => model(name)), there = [];
  for (const name of names) there.push(await several.read(name, readFileSync(join(models, name))));
  const posesB = Float64Array.from(poses(own[0].size, 100).flat()), done = [];
  const asked = [several.collideMany(...there, posesB, { progress: (share) => done.push(share) }), several.distanceMany(...there, [...posesB], { relative: 0.1 })];
  const answers = [snug.collideMany(...own, posesB), snug.distanceMany(...own, posesB, { relative: 0.1 })];
  assert.deepStrictEqual(await Promise.all(asked), answers);
  assert.ok(done.every((share) => share >= 0 && share <= 1));
  assert.equal((await several.collideMany(...there, [])).verdicts.length, 0);
  assert.equal((await several.collideMany(...there, posesB.slice(0, 12))).verdicts[0], answers[0].verdicts[0]);
  await assert.rejects(several.collideMany(...there, posesB.slice(5)), { name: "SnugError", problem: "pose" });
  // Surfaces that are made meanwhile are in all of them, and in those that take the place of ended ones.
  const third = await several.read("star.obj", readFileSync(join(models, "star.obj")));
  const ended = assert.rejects(several.distanceMany(...there, posesB, { relative: 0, absolute: 0, signal: AbortSignal.timeout(1) }), { name: "TimeoutError" });
  const others = Array.from({ length: 7 }, () => several.distance(third, there[1]));
  await ended;
  for (const each of await Promise.all(others)) assert.deepStrictEqual(each, snug.distance(model("star.obj"), own[1]));
  assert.deepStrictEqual(await several.collideMany(...there, posesB), answers[0]);
  await third.delete();
  await assert.rejects(Promise.all(Array.from({ length: 4 }, () => several.distance(third, there[1]))), TypeError);
  assert.throws(() => SnugWorker({ threads: 0 }), TypeError);
  await several.close();
});

test("lists contacts as the native library does, member by member", () => {
  const [bracket, pin] = [model("bracket.obj"), model("pin.obj")], poseB = snug.pose({ move: [0, 0, 0.5] });
  const native = ask("collide", join(models, "bracket.obj"), join(models, "pin.obj"), "--place-b", poseB.join(" "), "--all");
  const own = snug.contacts(bracket, pin, { poseB });
  const names = (object) => Object.keys(object).map((name) => name.replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`));
  assert.ok(own.regions.length > 0 && own.curves.length > 0);
  for (const list of ["regions", "curves"]) assert.deepStrictEqual(names(own[list][0]), Object.keys(native[list][0]));
  assert.deepStrictEqual(own.regions.map((r) => [r.verdict, r.distance, r.box, r.witness, r.witnessError, places(r.witnessAt), r.owners.map((list) => [...list]), r.contacts.length]),
    native.regions.map((r) => [r.verdict, r.distance, r.box, r.witness, r.witness_error, places(r.witness_at), r.owners, r.contacts.length]));
  assert.deepStrictEqual(own.curves.map((c) => [c.region, c.closed, c.proved, c.error, c.atBorder, [...c.points], c.boxes.map((b) => [b.box, b.oneArc])]),
    native.curves.map((c) => [c.region, c.closed, c.proved, c.error, c.at_border, c.points.flat(), c.boxes.map((b) => [b.box, b.one_arc])]));
  assert.deepStrictEqual([own.exhaustive, own.open.length], [native.exhaustive, native.open.length]);
  assert.deepStrictEqual(names(snug.penetration(bracket, pin, { poseB })), ["depth", "translation", "outcome"]);
  assert.deepStrictEqual(names(bracket.measure()), Object.keys(ask("measure", join(models, "bracket.obj"))).filter((name) => names(bracket.measure()).includes(name)));
});

test("subdivides as the native library does", () => {
  const file = join(scratch, "finer.obj");
  spawnSync(command, ["subdivide", join(models, "pawn.obj"), "--level", "2", "-o", file]);
  const own = model("pawn.obj").subdivided(2), native = snug.read("finer.obj", readFileSync(file)).cage();
  assert.deepStrictEqual(own, native);
  assert.equal(model("pawn.obj").subdivided(1, true).offsets.length, model("pawn.obj").subdivided(1).offsets.length);
});

test("says what triangles are taken to be", () => {
  const points = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => [4 * (k & 1), k & 2, (k & 4) / 4].join(" "));
  const faces = ["0 2 3", "0 3 1", "4 5 7", "4 7 6", "0 1 5", "0 5 4", "2 6 7", "2 7 3", "0 4 6", "0 6 2", "1 3 7", "1 7 5"];
  const off = ["OFF", "8 12 0", ...points, ...faces.map((face) => `3 ${face}`)].join("\n");
  const facet = (face) => `facet normal 0 0 0 outer loop ${face.split(" ").map((v) => `vertex ${points[v]}`).join(" ")} endloop endfacet`;
  const stl = ["solid box", ...faces.map(facet), "endsolid box"].join("\n");
  const read = (name, text, options) => {
    const surface = snug.read(name, text, options);
    const { scheme, notes } = surface;
    const [lower, upper] = surface.measure().volume;
    surface.delete();
    return { scheme, notes, holds: lower <= 8 && 8 <= upper };
  };
  assert.deepEqual(read("box.stl", stl), { scheme: "flat", notes: [], holds: true });
  assert.deepEqual(read("box.stl", stl, { scheme: "auto" }), { scheme: "flat", notes: [], holds: true });
  assert.deepEqual(read("box.stl", stl, { sharp: 30 }), { scheme: "loop", notes: [], holds: true });
  assert.deepEqual(read("box.stl", stl, { scheme: "loop" }), { scheme: "loop", notes: [], holds: false });
  assert.deepEqual(read("box.off", off, { scheme: "flat" }), { scheme: "flat", notes: [], holds: true });
  assert.deepEqual(read("box.off", off, { scheme: "loop" }), { scheme: "loop", notes: [], holds: false });
  const { scheme, notes } = read("box.off", off);
  assert.equal(scheme, "loop");
  assert.equal(notes.length, 1);
  assert.match(notes[0], /^box\.off: triangles taken as the control mesh of a Loop surface, up to [\d.]+ \(.*\) away from them; scheme flat takes the facets, scheme loop says that this is meant$/);
});

test("tells mistakes of its callers", () => {
  const star = model("star.obj");
  const { deepEqual, throws } = assert;
  deepEqual(star.notes, []);
  throws(() => snug.collide(star, star, { poseB: [1, 2, 3] }), { name: "SnugError", problem: "pose" });
  throws(() => snug.collide(star, star, { poseB: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0] }), { problem: "pose", message: /scales lengths by 2/ });
  throws(() => snug.read("a.xyz", "x"), { problem: "unreadable", message: "a.xyz: meshes are read from .obj, .off, .ply, .stl, .usda, .glb, .gltf and .3mf files only" });
  throws(() => model("star.obj", { scheme: "butterfly" }), { problem: "value", message: /'butterfly' is not loop/ });
  throws(() => model("bracket.obj", { scheme: "doo-sabin", sharp: 30 }), { problem: "value", message: /has no creases/ });
  throws(() => snug.collide(star, {}), TypeError);
  star.delete();
  throws(() => snug.collide(star, star), TypeError);
});

test("has types that fit", () => {
  execFileSync(process.execPath, [join(root, "web/node_modules/typescript/bin/tsc"), "--noEmit", "--strict", "--target", "es2022", "--module", "nodenext",
    "--moduleResolution", "nodenext", join(root, "web/tests/types.mts")], { stdio: "inherit" });
});
