// Questions that tests/doors/ask.py has left, asked of the JavaScript package, in Node and in Chromium: members of one name have the same digits.

const camel = (name) => name.replace(/_([a-z])/g, (_, letter) => letter.toUpperCase());
// Of one shape at both doors: points stand in flat arrays, what is infinite or not there is null, places come after the rest.
const numbers = (list) => (list.flat().every((x) => x === null || typeof x === "number") ? list.flat() : list);
const elsewhere = /(_at|At)$|^(contacts|patches|a|b|part_[ab]|at)$/;
function plain(x, spelled = (name) => name) {
  if (x === undefined || x === Infinity) return null;
  if (ArrayBuffer.isView(x)) return [...x];
  if (Array.isArray(x)) return numbers(x.map((each) => plain(each, spelled)));
  if (x === null || typeof x !== "object") return x;
  return Object.fromEntries(Object.entries(x).filter(([name]) => !elsewhere.test(name)).map(([name, each]) => [spelled(name), plain(each, spelled)]));
}
// -0 is not 0.
const text = (x) => JSON.stringify(x, (_, each) => (Object.is(each, -0) ? "-0" : each));
/** Members that both have are the same; how many? */
export function compare(own, document, where) {
  let compared = 0;
  const check = (a, b, name) => {
    if (text(a) !== text(b)) throw new Error(`${where} ${name}: ${text(a)}, the command ${text(b)}`);
    ++compared;
  };
  const place = (at) => at && [at.owner ?? at.face ?? at.vertex, at.corner ?? 0, at.u, at.v];
  if (document.witness_at && own.witnessAt) check(own.witnessAt.map(place), document.witness_at.map(place), "witness_at");
  if (own.at && document.u !== undefined) check(place(own.at), place(document), "at");
  for (const [name, value] of Object.entries(document)) {
    if (!(camel(name) in own) || elsewhere.test(name)) continue;
    const ought = name === "contained" ? (value === null ? null : "ab".indexOf(value)) : plain(value, camel);
    const here = plain(own[camel(name)]);
    // Only what the command tells of an object.
    const isObject = (x) => x !== null && typeof x === "object" && !Array.isArray(x);
    if (isObject(ought)) {
      compared += compare(here, ought, `${where} ${name}`);
    } else if (Array.isArray(ought) && ought.some(isObject)) {
      check(here.length, ought.length, `number of ${name}`);
      ought.forEach((each, i) => (compared += compare(here[i], each, `${where} ${name} ${i}`)));
    } else {
      check(here, ought, name);
    }
  }
  return compared;
}

/** Asks in this door what a line says, and throws where its document says otherwise; `read` makes a surface of the name of a file and a scheme. */
export function hold(snug, read, { ask, files, scheme, pose, path, args = [], options, document, candidate }) {
  const where = `${ask} ${files.join(" ")} ${scheme}`, given = Object.fromEntries(Object.entries(options).map(([name, value]) => [camel(name), value]));
  const [a, b] = files.map((file) => read(file, scheme)), name = files[0].replace(/.*\//, "").replace(/\.obj$/, "");
  const place = () => ({ owner: args[0], u: args[1], v: args[2], corner: args[3] });
  const answer = {
    time_of_contact: () => snug.timeOfContact(a, b, { motionB: path, ...given }),
    clearance: () => snug.clearance(a, b, { motionB: path, ...given }),
    collide: () => snug.collide(a, b, { poseB: pose, measure: true, proveContact: true, ...given }),
    contains: () => ({ inside: a.contains(...args) }),
    ray: () => a.ray(...args, { query: "all" }),
    evaluate: () => a.evaluate(place()),
    closest_point: () => a.closestPoint(...args),
    signed_distance: () => a.closestPoint(...args, { signed: true }),
    limit_to_faces: () => ({ limitToFaces: a.limitToFaces() }),
    bound: () => a.enclosures(given),
    subdivided: () => ({ positions: a.subdivided(options.level).points }),
    deviation: () => snug.deviation(a, candidate, given),
    step: () => {
      const made = a.step({ ...given, name });
      return { ...made, text: made.text.slice(made.text.indexOf("DATA;")) };
    },
  }[ask] ?? (b ? () => snug[ask](a, b, { poseB: pose, ...given }) : () => a[camel(ask)](given));
  if (ask === "bound") {
    document = { ...document, ...Object.fromEntries(["base", "radius", "lower", "upper"].map((member) => [member, document.enclosures.map((each) => each[member]).flat(2)])),
      pieces: document.enclosures.map(({ piece }) => piece) };
  }
  const least = ["contains", "limit_to_faces", "subdivided"].includes(ask) ? 1 : 2;
  const compared = compare(answer(), document, where);
  if (compared < least) throw new Error(`${where}: ${compared} members compared`);
}

/** Holds all lines, in turn, and counts those of each kind; the bytes of a file by its name. */
export function holdAll(snug, lines, bytes_of) {
  const counts = {}, read = new Map();
  const forget = () => {
    for (const each of read.values()) each.delete();
    read.clear();
  };
  const surface = (file, scheme) => {
    const key = `${file} ${scheme}`;
    if (!read.has(key)) {
      if (read.size > 16) forget();
      read.set(key, snug.read(file, bytes_of(file), { scheme }));
    }
    return read.get(key);
  };
  for (const line of lines) {
    const asked = JSON.parse(line);
    hold(snug, surface, asked);
    counts[asked.ask] = (counts[asked.ask] ?? 0) + 1;
  }
  forget();
  return counts;
}
